//! Passengers (Eq. 11): a flight takes as many as want to fly and have a seat, which reduces the demand at once.

use vertifleet_core::Scenario;

use super::Rule;
use super::event::{Event, period_of};
use super::report::Findings;

/// Follows what is left of the day's demand from take-off to take-off.
pub(super) fn check(scenario: &Scenario, events: &[Event<'_>], findings: &mut Findings) {
    let mut demand_left = scenario.demand.clone();
    for event in events.iter().filter(|event| !event.is_hold()) {
        let period = period_of(scenario, event.row.time.seconds().into());
        let left = &mut demand_left[period][event.pair()];
        boards(event, *left, findings);
        *left = left.saturating_sub(event.row.passengers.into());
    }
}

fn boards(event: &Event<'_>, left: u32, findings: &mut Findings) {
    let on_board = event.row.passengers;
    let seats = event.kind.seats;
    if on_board > seats {
        findings.add_event(Rule::Seats, event, || {
            format!("{on_board} passengers, but the aircraft has {seats} seats")
        });
    }
    if u32::from(on_board) > left {
        findings.add_event(Rule::Demand, event, || {
            format!("{on_board} passengers, but only {left} left who want to fly in this period")
        });
    }
    let could_board = left.min(seats.into());
    if u32::from(on_board) < could_board {
        findings.add_event(Rule::Boarding, event, || {
            format!("{on_board} passengers, but {could_board} want to fly and have a seat")
        });
    }
}
