//! Prices of what is scarce, for the rest of a day: what a stand costs when, what the right to carry a passenger costs, and
//! what it is worth, at these prices, to be ready somewhere.
//!
//! If every aircraft pays for the stands that it takes and the passengers that it carries, each can look after itself, and
//! at the right prices the fleet shares what there is (Lagrangian relaxation of Eq. 16 and of the demand; revenue management
//! calls them bid prices). Prices are found by search (`prices/volume.rs`) over what the fleet would do at given prices
//! (`prices/relaxation.rs`). They come from what a [`View`] shows, so the future enters as its forecast. They guide and bound
//! nothing: the certified bound is another crate's.

mod clock;
mod hops;
mod relaxation;
mod units;
mod volume;
mod ways_on;

use vertifleet_core::{Time, TypeIx, VertiportIx};
use vertifleet_sim::{Decision, View};

use relaxation::Relaxation;
use units::units_usd;
use volume::{Effort, Volume};

/// Passes over the day where there are no prices yet, and length of the first step. Days of up to about 60 vertiports have
/// all the passes, here and below up to 30; on larger ones more would take longer than a dispatcher can wait.
const FIRST: Effort = Effort { passes: 500, hops: 480_000_000, step: 1.0 };
/// The same where there are some. Longer steps leave good prices behind: days earned 0.8 % less with 1.0.
const AGAIN: Effort = Effort { passes: 150, hops: 37_000_000, step: 0.1 };
/// Seconds after which prices are found anew. On days of `paper` 5 minutes earned no more.
const RENEWAL_S: u32 = 900;

/// Prices for the rest of a day, and what they say about every choice.
#[derive(Debug, Clone)]
pub struct DayPrices {
    relaxation: Relaxation,
    volume: Volume,
    units_usd: Vec<f64>,
    made_at: Time,
    /// Openings and closings of routes that the prices know.
    route_changes: usize,
}

impl DayPrices {
    /// Prices from `now`, the view's moment, to the end of its day.
    pub fn of(view: View<'_>, now: Time) -> Self {
        let mut relaxation = Relaxation::of(view);
        let mut volume = Volume::new(&relaxation);
        relaxation.take_up(view);
        volume.search(&mut relaxation, FIRST);
        let route_changes = view.route_changes();
        Self { relaxation, volume, units_usd: units_usd(view), made_at: now, route_changes }
    }

    /// Keeps up with the day: after a quarter of an hour, and at once when a route closes or opens, prices are found anew from
    /// these ones, with the fleet and the demand as they are by then. `now` is the view's moment, later on the same day.
    pub fn keep_up(&mut self, view: View<'_>, now: Time) {
        let changes = view.route_changes();
        if now >= self.made_at + RENEWAL_S || changes != self.route_changes {
            self.route_changes = changes;
            self.relaxation.take_up(view);
            self.volume.search(&mut self.relaxation, AGAIN);
            self.made_at = now;
        }
    }

    /// What an aircraft of a type that is ready at a vertiport at a time may still earn, less what it pays for stands and
    /// passengers, dollars; 0 past the end of operations. `time` is not before the view's moment.
    pub fn worth_usd(&self, kind: TypeIx, vertiport: VertiportIx, time: Time) -> f64 {
        self.relaxation.ways_on().worth_usd(kind, vertiport, time.seconds())
    }

    /// What a stand costs from one time to another, dollars.
    pub fn rent_usd(&self, vertiport: VertiportIx, from: Time, until: Time) -> f64 {
        self.relaxation.ways_on().rent_usd(vertiport, from.seconds(), until.seconds())
    }

    /// What the right to carry one more passenger of a demand period costs, dollars.
    pub fn passenger_usd(&self, period: usize, from: VertiportIx, to: VertiportIx) -> f64 {
        self.relaxation.passenger_usd(period, from, to)
    }

    /// Profit of a typical full flight of a type, dollars: the unit in which differences in worth are small or large.
    pub fn unit_usd(&self, kind: TypeIx) -> f64 {
        self.units_usd[kind.at()]
    }

    /// What a feasible choice is worth: what its flight earns, what follows from being ready at its end, less what the
    /// passengers and the stand until then cost; dollars.
    #[inline]
    pub fn choice_usd(&self, view: View<'_>, decision: &Decision, to: VertiportIx) -> f64 {
        let Decision { time, aircraft, at: from, .. } = *decision;
        let kind = view.kind(aircraft);
        let way_on_usd = |ready_s| self.relaxation.ways_on().usd(kind, to, time.seconds(), ready_s);
        if to == from {
            return way_on_usd((time + view.hold_s()).seconds());
        }
        let period = view.period();
        let waiting = view.demand_left(period, from, to);
        let ready = time + view.leg(kind, from, to).block_s();
        view.flight_profit_usd(time, kind, (from, to), waiting) + way_on_usd(ready.seconds())
    }

    /// The feasible choice that is worth most; the vertiport listed first among equals.
    #[inline]
    pub fn best_choice(&self, view: View<'_>, decision: &Decision) -> VertiportIx {
        let mut best = (f64::NEG_INFINITY, decision.at);
        for to in view.feasible(decision).iter() {
            let worth_usd = self.choice_usd(view, decision, to);
            if worth_usd > best.0 {
                best = (worth_usd, to);
            }
        }
        best.1
    }
}
