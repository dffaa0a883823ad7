//! Holds (Eq. 8): the aircraft stays, and decides again after the hold time.

use vertifleet_core::{Charging, Scenario};

use super::Rule;
use super::event::{Event, clock};
use super::report::Findings;

/// Judges one hold.
pub(super) fn check(scenario: &Scenario, event: &Event<'_>, findings: &mut Findings) {
    let row = event.row;
    let amounts = [
        row.revenue_usd,
        row.passenger_cost_usd,
        row.energy_kwh,
        row.energy_cost_usd,
        row.flight_cost_usd,
    ];
    if row.passengers != 0 || amounts.iter().any(|&amount| amount != 0.0) {
        findings.add_event(Rule::HoldEmpty, event, || {
            format!(
                "{} passengers, revenue {}, passenger cost {}, energy {}, energy cost {}, flight cost {}: a hold has none of them",
                row.passengers, amounts[0], amounts[1], amounts[2], amounts[3], amounts[4]
            )
        });
    }
    let over = u64::from(row.time.seconds()) + u64::from(scenario.operations.hold_s);
    if row.arrival != row.time || u64::from(row.ready.seconds()) != over {
        findings.add_event(Rule::HoldTime, event, || {
            let (arrival, ready, over) = (row.arrival, row.ready, clock(over));
            format!("arrives {arrival}, ready {ready}, but a hold from now on is over at {over}")
        });
    }
    if scenario.operations.charging == Charging::AsNeeded && row.takeoff != row.time {
        findings.add_event(Rule::TakeoffTime, event, || {
            format!("takes off {}, but a hold states the time of its decision", row.takeoff)
        });
    }
}
