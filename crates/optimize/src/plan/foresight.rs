//! What of a day is known when all of it is: how late flights take off, when routes are closed, which aircraft will fail.
//!
//! A plan of a whole known day reckons with it exactly. Who plans while the day goes on does not have it.

use vertifleet_core::{AircraftIx, ClosedTimes, Disturbances, Scenario, Time, VertiportIx};

use super::day::{Hop, Landing};

/// The disturbances of a day, all of them known.
#[derive(Debug)]
pub(super) struct Foresight {
    start: Time,
    disturbances: Disturbances,
    closed: ClosedTimes,
}

impl Foresight {
    /// `None` for a day without disturbances.
    pub(super) fn of(scenario: &Scenario) -> Option<Self> {
        let disturbances = scenario.disturbances.clone();
        let start = scenario.operations.start;
        let closed = ClosedTimes::of(&disturbances.closures, scenario.vertiports.len());
        (!disturbances.is_none()).then_some(Self { start, disturbances, closed })
    }

    /// When a flight of an aircraft from a vertiport lands, and when the aircraft is ready again.
    pub(super) fn landing(
        &self,
        aircraft: AircraftIx,
        from: VertiportIx,
        hop: &Hop,
        take_off_s: u32,
    ) -> Landing {
        let delays = self.disturbances.takeoff_delays.as_ref();
        let take_off = Time::from_seconds(take_off_s);
        let late_s = delays.map_or(0, |delays| delays.at(self.start, take_off, from));
        let arrival_s = take_off_s + late_s + hop.flight_s;
        let charged_s = take_off_s + late_s + hop.block_s;
        let own = self.disturbances.outages.iter().filter(|outage| {
            outage.aircraft == aircraft
                && (outage.start.seconds()..outage.end.seconds()).contains(&arrival_s)
        });
        let ready_s = own.map(|outage| outage.end.seconds()).fold(charged_s, u32::max);
        Landing { arrival_s, ready_s }
    }

    /// Whether a route is closed at a time.
    pub(super) fn is_closed(&self, from: VertiportIx, to: VertiportIx, time_s: u32) -> bool {
        self.closed.is_closed(from, to, Time::from_seconds(time_s))
    }
}
