//! When and where each aircraft decides (Eq. 6, 9, 10). A complete schedule misses no decision.

use vertifleet_core::Scenario;

use super::Rule;
use super::event::{Event, clock};
use super::expected::first_decision_s;
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
    let stated_s = u64::from(event.row.time.seconds());
    let (rule, due_s) = match before {
        None => (Rule::FirstDecision, first_decision_s(scenario, event.aircraft, stated_s)),
        Some(before) => (Rule::DecisionTime, before.row.ready.seconds().into()),
    };
    if stated_s != due_s {
        let start = scenario.operations.start;
        let due = clock(due_s);
        findings.add_event(rule, event, || match before {
            None if due == start => {
                format!("operations start at {due}, when every aircraft decides first")
            }
            None => format!("the battery is full at {due}, when the aircraft decides first"),
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
    let end_s = u64::from(operations.end.seconds());
    for (aircraft, latest) in scenario.aircraft.iter().zip(latest) {
        // Without a decision, an aircraft states that it is full only after the end of operations.
        let due_s = latest.map_or_else(
            || first_decision_s(scenario, aircraft, end_s + 1),
            |latest| latest.row.ready.seconds().into(),
        );
        if due_s <= end_s {
            let due = clock(due_s);
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
