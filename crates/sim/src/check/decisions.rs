//! When and where each aircraft decides (Eq. 6, 9, 10). A complete schedule misses no decision.

use vertifleet_core::Scenario;

use super::Rule;
use super::event::Event;
use super::report::Findings;

/// Follows each aircraft from decision to decision.
pub(super) fn check(scenario: &Scenario, events: &[Event<'_>], findings: &mut Findings) {
    let mut latest: Vec<Option<&Event<'_>>> = vec![None; scenario.aircraft.len()];
    for event in events {
        let before = latest[event.row.aircraft.at()].replace(event);
        within_operations(scenario, event, findings);
        on_time(scenario, event, before, findings);
        in_place(scenario, event, before, findings);
    }
    none_missing(scenario, &latest, findings);
}

fn within_operations(scenario: &Scenario, event: &Event<'_>, findings: &mut Findings) {
    let operations = &scenario.operations;
    if !(operations.start..=operations.end).contains(&event.row.time) {
        findings.add_event(Rule::OperatingHours, event, || {
            format!("decisions are taken from {} to {}", operations.start, operations.end)
        });
    }
}

fn on_time(
    scenario: &Scenario,
    event: &Event<'_>,
    before: Option<&Event<'_>>,
    findings: &mut Findings,
) {
    let (rule, due) = match before {
        None => (Rule::FirstDecision, scenario.operations.start),
        Some(before) => (Rule::DecisionTime, before.row.ready),
    };
    if event.row.time != due {
        findings.add_event(rule, event, || match before {
            None => format!("operations start at {due}, when every aircraft decides first"),
            Some(before) => format!("the aircraft is ready at {due} (row {})", before.number),
        });
    }
}

fn in_place(
    scenario: &Scenario,
    event: &Event<'_>,
    before: Option<&Event<'_>>,
    findings: &mut Findings,
) {
    let place = before.map_or(event.aircraft.at, |before| before.row.to);
    if event.row.from != place {
        findings.add_event(Rule::Place, event, || {
            let (from, place) = (&event.from.id, &scenario.vertiports[place.at()].id);
            match before {
                None => format!("from {from}, but the aircraft starts the day at {place}"),
                Some(before) => {
                    format!("from {from}, but the aircraft is at {place} (row {})", before.number)
                }
            }
        });
    }
}

fn none_missing(scenario: &Scenario, latest: &[Option<&Event<'_>>], findings: &mut Findings) {
    let operations = &scenario.operations;
    for (aircraft, latest) in scenario.aircraft.iter().zip(latest) {
        let due = latest.map_or(operations.start, |latest| latest.row.ready);
        if due <= operations.end {
            findings.add(Rule::MissingDecision, None, due, Some(&aircraft.id), || match latest {
                None => "the aircraft never decides".to_owned(),
                Some(latest) => format!(
                    "ready no later than {}, the end of operations, but row {} is its last",
                    operations.end, latest.number
                ),
            });
        }
    }
}
