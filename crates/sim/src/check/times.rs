//! A flight's times, with its delay and its aircraft's outages, and whether its battery lasts (Eq.
//! 7, 9, 12, 14, 15).

use vertifleet_core::Scenario;

use super::Rule;
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
    let (row, kind) = (event.row, event.kind);
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
                kind.speed_mph,
                scenario.operations.takeoff_s + scenario.operations.landing_s,
                clock(expected.arrival_s)
            )
        });
    }
    let ready_s = u64::from(row.ready.seconds());
    if expected.out_of_service && ready_s < expected.ready_s {
        findings.add_event(Rule::OutOfService, event, || {
            format!("ready {}, but out of service until {}", row.ready, clock(expected.ready_s))
        });
    } else if ready_s != expected.ready_s {
        findings.add_event(Rule::ReadyTime, event, || {
            format!(
                "ready {}, but charging {} kWh at {} kW from {} on ends at {}",
                row.ready,
                expected.energy_kwh,
                kind.charge_kw,
                clock(expected.arrival_s),
                clock(expected.ready_s)
            )
        });
    }
    if !expected.fits(kind.battery_kwh) {
        findings.add_event(Rule::Range, event, || {
            format!(
                "the flight takes {} kWh, but the battery holds {}",
                expected.energy_kwh, kind.battery_kwh
            )
        });
    }
}
