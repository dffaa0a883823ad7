//! The disturbances of a day: demand that differs from the forecast, late take-offs, closed routes,
//! aircraft out of service. Disturbances are hidden from policies in advance, except for closures
//! that are announced.
//!
//! The scenario contains all disturbances, so that every policy meets the same ones. The simulator
//! decides which of them a policy may see, and when. A quiet day has none; all days of `paper` are
//! quiet.

mod closed_times;
mod model;

use crate::{AircraftIx, Matrix, Time, VertiportIx};

pub use closed_times::{ClosedSpan, ClosedTimes};
pub(crate) use model::{DelayModel, DisturbanceModel, RawDisturbanceModel};

/// The disturbances of a day; by default there are none.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Disturbances {
    /// Passengers expected in each period, if the actual [demand](crate::Day::demand) differs from
    /// the forecast. A period's actual demand becomes known when the period begins.
    pub forecast: Option<Vec<Matrix<u32>>>,
    /// How late flights take off.
    pub takeoff_delays: Option<TakeoffDelays>,
    /// Routes that are closed for a while.
    pub closures: Vec<Closure>,
    /// Aircraft that are out of service for a while.
    pub outages: Vec<Outage>,
}

impl Disturbances {
    /// Whether the day has no disturbances.
    pub fn is_none(&self) -> bool {
        self.forecast.is_none()
            && self.takeoff_delays.is_none()
            && self.closures.is_empty()
            && self.outages.is_empty()
    }
}

/// How late flights take off, by the vertiport that they leave and the time of the decision.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TakeoffDelays {
    /// Length of a slot, seconds. The first slot begins when operations start; the last one
    /// contains their end.
    pub slot_s: u32,
    /// Seconds of delay by slot, then by vertiport.
    pub delay_s: Vec<Vec<u32>>,
}

impl TakeoffDelays {
    /// Number of slots from `start`, the first instant of a day's decisions, to `end`, their last.
    pub fn slots(slot_s: u32, start: Time, end: Time) -> usize {
        (end.since(start) / slot_s) as usize + 1
    }

    /// Seconds by which a flight takes off late if it is decided at `time`, on a day that starts at
    /// `start`.
    #[inline]
    pub fn at(&self, start: Time, time: Time, from: VertiportIx) -> u32 {
        let slot = (time.since(start) / self.slot_s) as usize;
        self.delay_s.get(slot).map_or(0, |delays_s| delays_s[from.at()])
    }
}

/// A pair of vertiports as files name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Route {
    /// Vertiport that flights leave.
    pub from: VertiportIx,
    /// Vertiport that flights fly to.
    pub to: VertiportIx,
    /// Whether the route includes the way back.
    pub both_ways: bool,
}

impl Route {
    /// Whether a flight from `from` to `to` goes along this route.
    #[inline]
    pub fn covers(&self, from: VertiportIx, to: VertiportIx) -> bool {
        (self.from, self.to) == (from, to) || (self.both_ways && (self.to, self.from) == (from, to))
    }
}

/// A route, and the time from `start` until before `end` in which no flight along it may be
/// decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Closure {
    /// The route.
    pub route: Route,
    /// First instant at which the route is closed.
    pub start: Time,
    /// First instant at which the route is open again.
    pub end: Time,
    /// Whether policies know of the closure from the start of the day on. If not, they see that the
    /// route is closed only once it is, and do not see until when.
    pub known: bool,
}

/// A time in which an aircraft stays on the ground: if it lands at `start` or later and before
/// `end`, it is not ready before `end`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outage {
    /// The aircraft.
    pub aircraft: AircraftIx,
    /// First instant of the landings that the outage affects.
    pub start: Time,
    /// First instant at which the aircraft is fit to fly again.
    pub end: Time,
}
