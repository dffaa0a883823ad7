//! The worth of the choices of one decision at given prices: what is the same for all of them is
//! looked up once.

use vertifleet_core::VertiportIx;
use vertifleet_sim::{Decision, Departures, View};

use super::PricedChoice;
use super::values::WorthsFrom;

/// The choices of a decision.
#[derive(Debug, Clone, Copy)]
pub struct Choices<'a> {
    own: VertiportIx,
    time_s: u32,
    hold_s: u32,
    departures: Departures<'a>,
    /// Passengers who want to fly now, by destination.
    waiting: &'a [u32],
    worths: WorthsFrom<'a>,
}

impl<'a> Choices<'a> {
    #[inline]
    pub(super) fn of(view: View<'a>, decision: &Decision, worths: WorthsFrom<'a>) -> Self {
        let Decision { time, aircraft, at: own, .. } = *decision;
        Self {
            own,
            time_s: time.seconds(),
            hold_s: view.hold_s(),
            departures: view.departures(time, view.kind(aircraft), own),
            waiting: &view.demand_left_in(view.period())[own.at() * view.vertiports()..]
                [..view.vertiports()],
            worths,
        }
    }

    /// Worth of a choice within range, dollars: the profit of its flight and the worth of being
    /// ready at its end, less the price of the stand until then. Later flights pay for their
    /// passengers; this one does not.
    #[inline]
    pub fn worth_usd(&self, to: VertiportIx) -> f64 {
        if to == self.own {
            return self.worths.usd(to, self.time_s + self.hold_s);
        }
        self.departures.profit_usd(to, self.waiting[to.at()])
            + self.worths.usd(to, self.time_s + self.departures.block_s(to))
    }

    /// A choice within range with its worth.
    #[inline]
    pub(super) fn priced(&self, to: VertiportIx) -> PricedChoice {
        PricedChoice { worth_usd: self.worth_usd(to), to }
    }

    /// The number of seats that stay empty on a flight.
    #[inline]
    pub(super) fn empty_seats(&self, to: VertiportIx) -> f64 {
        f64::from(self.departures.seats().saturating_sub(self.waiting[to.at()]))
    }

    /// Whether a choice is a flight without passengers.
    #[inline]
    pub(crate) fn is_repositioning(&self, to: VertiportIx) -> bool {
        to != self.own && self.waiting[to.at()] == 0
    }
}
