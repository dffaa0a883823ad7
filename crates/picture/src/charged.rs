//! When an aircraft that has landed is charged. On a day with outages this may be long before it is
//! ready, because an aircraft that lands within an outage stays on the ground until it is over.

use vertifleet_core::{Scenario, Time};
use vertifleet_sim::{Legs, TraceRow};

/// The times at which the aircraft of a day are charged.
#[derive(Debug)]
pub struct Charged<'a> {
    day: &'a Scenario,
    /// Only on a day with outages; on other days aircraft are ready when they are charged.
    legs: Option<Legs>,
}

impl<'a> Charged<'a> {
    /// Those of a day.
    pub fn of(day: &'a Scenario) -> Self {
        let has_outages = !day.disturbances.outages.is_empty();
        Self { day, legs: has_outages.then(|| Legs::of(day)) }
    }

    /// The time at which the aircraft of a flight is charged. From then until it is ready, it is
    /// out of service.
    pub fn at(&self, row: &TraceRow) -> Time {
        let Some(legs) = &self.legs else { return row.ready };
        let mut outages = self.day.disturbances.outages.iter();
        let lands_within_one = outages.any(|outage| {
            outage.aircraft == row.aircraft && (outage.start..outage.end).contains(&row.arrival)
        });
        if !lands_within_one || row.from == row.to {
            return row.ready;
        }
        let kind = self.day.aircraft[row.aircraft.at()].kind;
        let charged = row.arrival + legs.leg(kind, row.from, row.to).ground_s;
        charged.min(row.ready)
    }
}
