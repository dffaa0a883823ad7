//! The worth of the choices of one decision at given prices: what is the same for all of them is
//! looked up once.

use vertifleet_core::{Time, VertiportIx};
use vertifleet_sim::{Decision, Departures, View};

use super::PricedChoice;
use super::charged_flights::{ChargedFlight, ChargedFlights};
use super::levels::{Levels, LevelsAt, ReadyAt};
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
    /// Where the charge of the aircraft matters.
    charge: Option<Charge<'a>>,
}

/// The charge of the aircraft of a decision, and what choices do to it.
#[derive(Debug, Clone, Copy)]
struct Charge<'a> {
    /// Seconds to a full battery.
    to_full_s: f32,
    /// By destination.
    flights: &'a [ChargedFlight],
    /// The aircraft after a hold.
    held: ReadyAt,
    /// By vertiport.
    levels: &'a [LevelsAt],
}

impl<'a> Charge<'a> {
    #[expect(clippy::cast_possible_truncation, reason = "seconds to a tenth are enough")]
    fn of(
        view: View<'_>,
        decision: &Decision,
        levels: &'a Levels,
        flights: &'a ChargedFlights,
    ) -> Self {
        let Decision { aircraft, at, time, .. } = *decision;
        let kind = view.kind(aircraft);
        let levels = levels.of_kind(kind);
        let to_full_s = view.to_full_s(aircraft, time);
        let (hold_s, ready_s) = (f64::from(view.hold_s()), time.seconds() + view.hold_s());
        let held = levels[at.at()].nearest(ready_s, (to_full_s - hold_s).max(0.0));
        let held = held.no_sooner_than(time.seconds());
        let flights = flights.from(kind, at);
        Self { to_full_s: to_full_s as f32, flights, held, levels }
    }
}

/// Whole seconds of a wait, at least 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative, and a full charge takes at most 5,000 hours"
)]
pub(super) fn wait_s(seconds: f32) -> u32 {
    // `as` cuts what is below 0, and the fraction.
    let whole = seconds as u32;
    whole + u32::from(seconds > whole as f32)
}

impl<'a> Choices<'a> {
    #[inline]
    pub(super) fn of(
        view: View<'a>,
        decision: &Decision,
        worths: WorthsFrom<'a>,
        (levels, flights): (&'a Levels, &'a ChargedFlights),
    ) -> Self {
        let Decision { time, aircraft, at: own, .. } = *decision;
        Self {
            own,
            time_s: time.seconds(),
            hold_s: view.hold_s(),
            departures: view.departures(time, view.kind(aircraft), own),
            waiting: &view.demand_left_in(view.period())[own.at() * view.vertiports()..]
                [..view.vertiports()],
            worths,
            charge: view.charges_as_needed().then(|| Charge::of(view, decision, levels, flights)),
        }
    }

    /// Worth of a choice within range, dollars: the profit of its flight and the worth of being
    /// ready at its end, less the price of the stand until then. Later flights pay for their
    /// passengers; this one does not.
    #[inline]
    pub fn worth_usd(&self, to: VertiportIx) -> f64 {
        if let Some(charge) = &self.charge {
            return self.worth_by_charge_usd(charge, to);
        }
        if to == self.own {
            return self.worths.usd(to, self.time_s + self.hold_s);
        }
        self.departures.profit_usd(to, self.waiting[to.at()])
            + self.worths.usd(to, self.time_s + self.departures.block_s(to))
    }

    /// The same on a day that charges as needed.
    #[inline(never)]
    fn worth_by_charge_usd(&self, charge: &Charge<'_>, to: VertiportIx) -> f64 {
        if to == self.own {
            return self.worths.at_level_usd(self.own, charge.held);
        }
        let flight = &charge.flights[to.at()];
        let wait_s = wait_s(charge.to_full_s - flight.most_s);
        let ready_s = self.time_s + wait_s + self.departures.block_s(to);
        let to_full_s = flight.when_ready_s(charge.to_full_s.min(flight.most_s));
        let ready = charge.levels[to.at()].nearest(ready_s, to_full_s.into());
        let follows_usd = self.worths.at_level_usd(to, ready.no_sooner_than(self.time_s));
        let takeoff = Time::from_seconds(self.time_s + wait_s);
        self.departures.profit_from_usd(takeoff, to, self.waiting[to.at()]) + follows_usd
    }

    /// A choice within range with its worth.
    #[inline]
    pub(super) fn priced(&self, to: VertiportIx) -> PricedChoice {
        PricedChoice { worth_usd: self.worth_usd(to), to }
    }

    /// The band of the aircraft's charge.
    #[inline]
    pub(super) fn band(&self) -> usize {
        self.charge
            .as_ref()
            .map_or(0, |charge| charge.levels[self.own.at()].band(charge.to_full_s.into()))
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
