//! Knowledge of the disturbances of a whole day: delays of take-offs, closures of routes, and
//! outages of aircraft.
//!
//! A plan of a known day takes them into account exactly. Policies that decide while the day goes
//! on do not know them.

use vertifleet_core::{AircraftIx, ClosedTimes, Disturbances, Scenario, Time, VertiportIx};

/// The disturbances of a day, all of them known.
#[derive(Debug)]
pub(super) struct Foresight {
    start: Time,
    disturbances: Disturbances,
    closed: ClosedTimes,
}

impl Foresight {
    /// The foresight of a day, or `None` for a day without disturbances.
    pub(super) fn of(scenario: &Scenario) -> Option<Self> {
        let disturbances = scenario.disturbances.clone();
        let start = scenario.operations.start;
        let closed = ClosedTimes::of(&disturbances.closures, scenario.vertiports.len());
        (!disturbances.is_none()).then_some(Self { start, disturbances, closed })
    }

    /// Seconds by which flights leave a vertiport late that are decided at a second.
    pub(super) fn late_s(&self, from: VertiportIx, decided_s: u32) -> u32 {
        let delays = self.disturbances.takeoff_delays.as_ref();
        let decided = Time::from_seconds(decided_s);
        delays.map_or(0, |delays| delays.at(self.start, decided, from))
    }

    /// The second at which an aircraft is ready that lands at `arrival_s` and would be ready at
    /// `charged_s` without outages.
    pub(super) fn ready_s(&self, aircraft: AircraftIx, arrival_s: u32, charged_s: u32) -> u32 {
        let own = self.disturbances.outages.iter().filter(|outage| {
            outage.aircraft == aircraft
                && (outage.start.seconds()..outage.end.seconds()).contains(&arrival_s)
        });
        own.map(|outage| outage.end.seconds()).fold(charged_s, u32::max)
    }

    /// Whether a route is closed at a time.
    pub(super) fn is_closed(&self, from: VertiportIx, to: VertiportIx, time_s: u32) -> bool {
        self.closed.is_closed(from, to, Time::from_seconds(time_s))
    }
}
