//! Aircraft that stay on the ground after a landing, and when it is known how long.

use vertifleet_core::{AircraftIx, Scenario, Time};

use crate::first_decision;
use crate::room::clone_into_room;

/// The landing time of an aircraft that has held since it landed, or has not landed yet. No outage
/// lasts that long.
const NONE: Time = Time::from_seconds(u32::MAX);

/// The outages of a day by aircraft, and the landings that they may affect.
#[derive(Debug)]
pub(crate) struct Outages {
    /// Aircraft, first instant and end of each outage, in order of aircraft.
    all: Vec<(AircraftIx, Time, Time)>,
    /// Each aircraft's latest landing, whether decided or done, with the time at which it is
    /// charged. Empty on a day without outages.
    landings: Vec<(Time, Time)>,
}

clone_into_room!(Outages { all, landings });

impl Outages {
    /// The outages of a day before it begins.
    pub(crate) fn of(scenario: &Scenario) -> Self {
        let outages = scenario.disturbances.outages.iter();
        let mut all: Vec<_> =
            outages.map(|outage| (outage.aircraft, outage.start, outage.end)).collect();
        all.sort_by_key(|&(aircraft, ..)| aircraft);
        let fleet = if all.is_empty() { 0 } else { scenario.aircraft.len() };
        let first = |aircraft| (NONE, first_decision(scenario, aircraft));
        Self { all, landings: AircraftIx::all(fleet).map(first).collect() }
    }

    /// Whether the day has no outages.
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    fn of_aircraft(&self, aircraft: AircraftIx) -> impl Iterator<Item = (Time, Time)> {
        let first = self.all.partition_point(|&(other, ..)| other < aircraft);
        let own = self.all[first..].iter().take_while(move |&&(other, ..)| other == aircraft);
        own.map(|&(_, start, end)| (start, end))
    }

    /// Enters a landing after which the aircraft is charged at `charged`, and returns the time at
    /// which it is ready.
    pub(crate) fn land(&mut self, aircraft: AircraftIx, arrival: Time, charged: Time) -> Time {
        self.landings[aircraft.at()] = (arrival, charged);
        self.ready(aircraft, NONE)
    }

    /// Enters a hold that is over at `ready`. No outage affects it.
    #[cold]
    pub(crate) fn hold(&mut self, aircraft: AircraftIx, ready: Time) {
        if let Some(landing) = self.landings.get_mut(aircraft.at()) {
            *landing = (NONE, ready);
        }
    }

    /// The time at which an aircraft will be ready, considering the outages that have begun by
    /// `now`.
    pub(crate) fn ready(&self, aircraft: AircraftIx, now: Time) -> Time {
        let (arrival, charged) = self.landings[aircraft.at()];
        let known = self
            .of_aircraft(aircraft)
            .filter(|&(start, end)| start <= now && (start..end).contains(&arrival));
        known.map(|(_, end)| end).fold(charged, Time::max)
    }
}
