//! Knowledge of the disturbances of a whole day: delays of take-offs, closures of routes, and
//! outages of aircraft.
//!
//! A plan of a known day takes them into account exactly. Policies that decide while the day goes
//! on do not know them.

use vertifleet_core::{AircraftIx, ClosedTimes, Disturbances, Scenario, Time, VertiportIx};

use super::hop::Hop;

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

    /// The landing of a flight of an aircraft from a vertiport that is decided at a second and may
    /// take off at another, and the second at which the aircraft is ready again.
    pub(super) fn landing_s(
        &self,
        aircraft: AircraftIx,
        from: VertiportIx,
        hop: &Hop,
        (decided_s, takeoff_s): (u32, u32),
    ) -> (u32, u32) {
        let delays = self.disturbances.takeoff_delays.as_ref();
        let decided = Time::from_seconds(decided_s);
        let late_s = delays.map_or(0, |delays| delays.at(self.start, decided, from));
        let arrival_s = takeoff_s + late_s + hop.flight_s;
        let charged_s = takeoff_s + late_s + hop.block_s;
        let own = self.disturbances.outages.iter().filter(|outage| {
            outage.aircraft == aircraft
                && (outage.start.seconds()..outage.end.seconds()).contains(&arrival_s)
        });
        let ready_s = own.map(|outage| outage.end.seconds()).fold(charged_s, u32::max);
        (arrival_s, ready_s)
    }

    /// Whether a route is closed at a time.
    pub(super) fn is_closed(&self, from: VertiportIx, to: VertiportIx, time_s: u32) -> bool {
        self.closed.is_closed(from, to, Time::from_seconds(time_s))
    }
}
