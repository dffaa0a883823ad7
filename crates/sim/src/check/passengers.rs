//! Passengers (Eq. 11): a flight takes as many as want to fly and have a seat, which reduces the
//! demand at once. Where passengers wait, those who are left of the period before can board first,
//! until they have waited long enough.

use vertifleet_core::Scenario;

use super::Rule;
use super::event::{Event, period_of};
use super::report::Findings;

/// Follows who is left of each period's demand from take-off to take-off.
pub(super) fn check(scenario: &Scenario, events: &[Event<'_>], findings: &mut Findings) {
    let mut demand_left = scenario.demand.clone();
    for event in events.iter().filter(|event| !event.is_hold()) {
        let decided_s = u64::from(event.row.time.seconds());
        let period = period_of(scenario, decided_s);
        let (before, from_now) = demand_left.split_at_mut(period);
        let own = &mut from_now[0][event.pair()];
        let mut none = 0;
        let patient = match before.last_mut() {
            Some(table) if decided_s < patience_ends_s(scenario, period) => {
                &mut table[event.pair()]
            }
            _ => &mut none,
        };
        boards(event, *patient + *own, findings);
        let boarded = u32::from(event.row.passengers);
        let patient_boarded = boarded.min(*patient);
        *patient -= patient_boarded;
        *own = own.saturating_sub(boarded - patient_boarded);
    }
}

/// The first second of a period at which all passengers of the period before have left.
fn patience_ends_s(scenario: &Scenario, period: usize) -> u64 {
    let wait_s = u64::from(scenario.operations.passenger_wait_s);
    u64::from(scenario.periods[period].seconds()) + wait_s
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
