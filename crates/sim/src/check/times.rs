//! A flight's times, with its delay and its aircraft's outages, and whether its battery lasts (Eq.
//! 7, 9, 12, 14, 15).

use vertifleet_core::{Charging, Scenario};

use super::Rule;
use super::charger::Charger;
use super::event::{Event, clock};
use super::expected::Expected;
use super::report::Findings;

/// Judges when one flight arrives and is ready again, and whether it can be flown.
pub(super) fn check(
    scenario: &Scenario,
    event: &Event<'_>,
    expected: &Expected,
    findings: &mut Findings,
) {
    arrives(scenario, event, expected, findings);
    is_ready(scenario, event, expected, findings);
    if !expected.within_range(event) {
        let kind = event.kind;
        findings.add_event(Rule::Range, event, || {
            let reserve = match kind.reserve_kwh {
                0.0 => String::new(),
                kwh => format!(" and leaves {kwh} in reserve"),
            };
            format!(
                "the flight takes {} kWh{reserve}, but the battery holds {}",
                expected.energy_kwh, kind.battery_kwh
            )
        });
    }
}

fn arrives(scenario: &Scenario, event: &Event<'_>, expected: &Expected, findings: &mut Findings) {
    let row = event.row;
    let distance_mi = scenario.distance_mi[event.pair()];
    let arrival_s = u64::from(row.arrival.seconds());
    if expected.delay_s > 0 && arrival_s + expected.delay_s == expected.arrival_s {
        findings.add_event(Rule::TakeoffDelay, event, || {
            format!(
                "arrives {} as though it left on time, but it leaves {} s late",
                row.arrival, expected.delay_s
            )
        });
    } else if arrival_s != expected.arrival_s {
        findings.add_event(Rule::ArrivalTime, event, || {
            format!(
                "arrives {}, but {distance_mi} miles at {} mph and {} s of take-off and landing end at {}",
                row.arrival,
                event.kind.speed_mph,
                scenario.operations.takeoff_s + scenario.operations.landing_s,
                clock(expected.arrival_s)
            )
        });
    }
}

fn is_ready(scenario: &Scenario, event: &Event<'_>, expected: &Expected, findings: &mut Findings) {
    let (row, kind) = (event.row, event.kind);
    let ready_s = u64::from(row.ready.seconds());
    if expected.out_of_service && ready_s < expected.ready_s {
        findings.add_event(Rule::OutOfService, event, || {
            format!("ready {}, but out of service until {}", row.ready, clock(expected.ready_s))
        });
    } else if ready_s != expected.ready_s {
        findings.add_event(Rule::ReadyTime, event, || {
            let (from, to) = (clock(expected.arrival_s), clock(expected.ready_s));
            if expected.out_of_service {
                return format!("ready {}, but out of service until {to}", row.ready);
            }
            let as_needed = scenario.operations.charging == Charging::AsNeeded;
            let turnaround_s = kind.turnaround_s;
            if as_needed || (turnaround_s > 0 && expected.ready_s == expected.turned_around_s) {
                return format!(
                    "ready {}, but {turnaround_s} s of turnaround from {from} on end at {to}",
                    row.ready
                );
            }
            let charger = Charger::of(kind, event.to);
            let up_to = if charger.has_curve() { "up to " } else { "" };
            format!(
                "ready {}, but charging {} kWh at {up_to}{} kW from {from} on ends at {to}",
                row.ready, expected.energy_kwh, charger.kw
            )
        });
    }
}
