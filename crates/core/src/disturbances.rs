//! What may disturb a day: demand that is not as forecast, late take-offs, closed routes, aircraft out of service. No policy
//! knows it in advance, but for closures that are announced.
//!
//! All of it stands in the scenario, so that every policy meets the same disturbances; what of it a policy may see, and
//! when, is the simulator's affair. A quiet day, as those of `paper` are, has none.

use crate::{AircraftIx, Matrix, Time, VertiportIx};

/// The disturbances of a day; the default is none.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Disturbances {
    /// Passengers expected, per period, where the actual [demand](crate::Day::demand) differs from it. A period's actual
    /// demand becomes known when the period begins.
    pub forecast: Option<Vec<Matrix<u32>>>,
    /// How late flights take off.
    pub takeoff_delays: Option<TakeoffDelays>,
    /// Routes that are closed for a while.
    pub closures: Vec<Closure>,
    /// Aircraft that are out of service for a while.
    pub outages: Vec<Outage>,
}

impl Disturbances {
    /// Whether the day has none.
    pub fn is_none(&self) -> bool {
        self.forecast.is_none()
            && self.takeoff_delays.is_none()
            && self.closures.is_empty()
            && self.outages.is_empty()
    }
}

/// How late flights take off, by the vertiport they leave and the time at which they are decided.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TakeoffDelays {
    /// Length of a slot, seconds. The first slot begins when operations start; the last one contains their end.
    pub slot_s: u32,
    /// Seconds of delay by slot, then by vertiport.
    pub delay_s: Vec<Vec<u32>>,
}

impl TakeoffDelays {
    /// Slots from the first to the last decision of a day, whose first and last instant these are.
    pub fn slots(slot_s: u32, start: Time, end: Time) -> usize {
        (end.since(start) / slot_s) as usize + 1
    }

    /// How late a flight takes off that is decided at `time`, in a day that starts at `start`; seconds.
    #[inline]
    pub fn at(&self, start: Time, time: Time, from: VertiportIx) -> u32 {
        let slot = (time.since(start) / self.slot_s) as usize;
        self.delay_s.get(slot).map_or(0, |delays_s| delays_s[from.at()])
    }
}

/// A pair of vertiports as files name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Route {
    /// Where flights leave.
    pub from: VertiportIx,
    /// Where they lead.
    pub to: VertiportIx,
    /// Whether the way back is meant too.
    pub both_ways: bool,
}

impl Route {
    /// Whether a flight from `from` to `to` goes along this route.
    #[inline]
    pub fn covers(&self, from: VertiportIx, to: VertiportIx) -> bool {
        (self.from, self.to) == (from, to) || (self.both_ways && (self.to, self.from) == (from, to))
    }
}

/// A route on which no flight may be decided from `start` on until before `end`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Closure {
    /// The route.
    pub route: Route,
    /// First instant at which it is closed.
    pub start: Time,
    /// First instant at which it is open again.
    pub end: Time,
    /// Whether policies know of it from the start of the day on. If not, they see that the route is closed once it is, and not
    /// until when.
    pub known: bool,
}

/// An aircraft that stays on the ground: if it lands at `start` or later and before `end`, it is not ready before `end`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outage {
    /// The aircraft.
    pub aircraft: AircraftIx,
    /// First instant of a landing that the outage concerns.
    pub start: Time,
    /// When the aircraft is fit again.
    pub end: Time,
}
