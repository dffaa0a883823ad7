//! Prices of what is scarce, for the rest of a day: what a stand costs when, what the right to carry a passenger costs, and
//! what it is worth, at these prices, to be ready somewhere.
//!
//! If every aircraft pays for the stands that it takes and the passengers that it carries, each can look after itself, and
//! at the right prices the fleet shares what there is (Lagrangian relaxation of Eq. 16 and of the demand; revenue management
//! calls them bid prices). Prices are found by search (`prices/volume.rs`) over what the fleet would do at given prices
//! (`prices/relaxation.rs`). They come from what a [`View`] shows, so the future enters as its forecast. They guide and bound
//! nothing: the certified bound is another crate's.

mod base_rule;
mod clock;
mod hops;
mod intervals;
mod relaxation;
mod units;
mod values;
mod volume;

use vertifleet_core::{Time, TypeIx, VertiportIx};
use vertifleet_sim::{Decision, Imagined, View};

use base_rule::BaseRule;
pub(crate) use base_rule::is_empty_flight;
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
/// Seconds after which the rule by which the fleet decides is chosen anew.
const BASE_RULE_RENEWAL_S: u32 = 3_600;

/// Prices for the rest of a day, and what they say about every choice.
#[derive(Debug, Clone)]
pub struct DayPrices {
    relaxation: Relaxation,
    volume: Volume,
    units_usd: Vec<f64>,
    made_at: Time,
    /// Openings and closings of routes that the prices know.
    route_changes: usize,
    stake_usd: f64,
    base_rule: BaseRule,
    base_rule_made_at: Time,
    /// Room to play the rest of the day out in.
    room: Option<Imagined>,
}

impl DayPrices {
    /// Prices from `now`, the view's moment, to the end of its day.
    pub fn of(view: View<'_>, now: Time) -> Self {
        let relaxation = Relaxation::of(view);
        let mut prices = Self {
            volume: Volume::new(&relaxation),
            relaxation,
            units_usd: units_usd(view),
            made_at: now,
            route_changes: view.route_changes(),
            stake_usd: 0.0,
            base_rule: BaseRule::Prices,
            base_rule_made_at: now,
            room: None,
        };
        prices.search(view, FIRST);
        prices.choose_base_rule(view, now);
        prices
    }

    /// Keeps up with the day: after a quarter of an hour, and at once when a route closes or opens unexpectedly, prices are found
    /// anew from these ones, with the fleet and the demand as they are by then. `now` is the view's moment, later on the same day.
    pub fn refresh(&mut self, view: View<'_>, now: Time) {
        let changes = view.route_changes();
        if now >= self.made_at + RENEWAL_S || changes != self.route_changes {
            self.route_changes = changes;
            self.search(view, AGAIN);
            self.made_at = now;
            if now >= self.base_rule_made_at + BASE_RULE_RENEWAL_S {
                self.choose_base_rule(view, now);
            }
        }
    }

    fn search(&mut self, view: View<'_>, effort: Effort) {
        self.relaxation.load(view);
        let rest_usd = self.volume.search(&mut self.relaxation, effort);
        self.stake_usd = rest_usd.max(0.0) / f64::from(self.relaxation.decisions().max(1));
    }

    fn choose_base_rule(&mut self, view: View<'_>, now: Time) {
        let mut room = self.room.take();
        self.base_rule = BaseRule::best(self, view, &mut room);
        self.room = room;
        self.base_rule_made_at = now;
    }

    /// What an aircraft of a type that is ready at a vertiport at a time may still earn, less what it pays for stands and
    /// passengers, dollars; 0 past the end of operations. `time` is not before the view's moment.
    pub fn worth_usd(&self, kind: TypeIx, vertiport: VertiportIx, time: Time) -> f64 {
        self.relaxation.values().worth_usd(kind, vertiport, time.seconds())
    }

    /// What a stand costs from one time to another, dollars.
    pub fn rent_usd(&self, vertiport: VertiportIx, from: Time, until: Time) -> f64 {
        self.relaxation.values().rent_usd(vertiport, from.seconds(), until.seconds())
    }

    /// What the right to carry one more passenger of a demand period costs, dollars.
    pub fn passenger_usd(&self, period: usize, from: VertiportIx, to: VertiportIx) -> f64 {
        self.relaxation.passenger_usd(period, from, to)
    }

    /// Profit of a typical full flight of a type, dollars: the unit in which differences in worth are small or large.
    pub fn unit_usd(&self, kind: TypeIx) -> f64 {
        self.units_usd[kind.at()]
    }

    /// What is at stake in a decision of the rest of the day: what the fleet may still earn over the decisions that it takes for
    /// that, dollars. 0 where nothing can be earned.
    pub fn stake_usd(&self) -> f64 {
        self.stake_usd
    }

    /// What a feasible choice is worth: what its flight earns, what follows from being ready at its end, less what the
    /// passengers and the stand until then cost; dollars.
    #[inline]
    pub fn choice_usd(&self, view: View<'_>, decision: &Decision, to: VertiportIx) -> f64 {
        let Decision { time, aircraft, at: from, .. } = *decision;
        let kind = view.kind(aircraft);
        let way_on_usd = |ready_s| self.relaxation.values().usd(kind, to, time.seconds(), ready_s);
        if to == from {
            return way_on_usd((time + view.hold_s()).seconds());
        }
        let period = view.period();
        let waiting = view.demand_left(period, from, to);
        let ready = time + view.leg(kind, from, to).block_s();
        view.flight_profit_usd(time, kind, (from, to), waiting) + way_on_usd(ready.seconds())
    }

    /// The choice of the rule by which the fleet decides at these prices: the feasible choice that is worth most, the
    /// vertiport listed first among equals, unless another rule is expected to earn more over the rest of the day.
    #[inline]
    pub fn best_choice(&self, view: View<'_>, decision: &Decision) -> VertiportIx {
        self.base_rule.choice(self, view, decision)
    }

    /// The choices that the rule by which the fleet decides leaves open, each with what it is worth, dollars.
    #[inline]
    pub(crate) fn open_choices<'a>(
        &'a self,
        view: View<'a>,
        decision: &'a Decision,
    ) -> impl Iterator<Item = (f64, VertiportIx)> + 'a {
        let only = (self.base_rule == BaseRule::Greedy).then(|| self.best_choice(view, decision));
        let feasible = view.feasible(decision);
        let open = move |&to: &VertiportIx| match only {
            Some(only) => to == only,
            None => self.base_rule.allows(view, decision, to),
        };
        feasible.iter().filter(open).map(move |to| (self.choice_usd(view, decision, to), to))
    }
}
