//! Prices of scarce resources for the rest of a day: the price of a stand at each time, the price
//! of the right to carry a passenger, and the worth, at these prices, of being ready somewhere.
//!
//! If every aircraft pays for the stands that it takes and the passengers that it carries, each can
//! decide alone, and at the right prices the fleet shares the scarce resources (Lagrangian
//! relaxation of Eq. 16 and of the demand; revenue management calls the prices bid prices). Prices
//! are found by search (`prices/volume.rs`) over the decisions of the fleet at given prices
//! (`prices/relaxation.rs`). They are computed from a [`View`], so the future enters as its
//! forecast. They guide decisions and prove no bound: the certified upper bound is in another
//! crate.

mod backward_pass;
mod bands;
mod base_rule;
mod charged_flights;
mod choices;
mod clock;
mod fleet;
mod hops;
mod intervals;
mod levels;
mod quads;
mod ranks;
mod relaxation;
mod seats;
mod units;
mod values;
mod volume;
mod wanted;

use std::sync::OnceLock;

use vertifleet_core::{AircraftIx, Time, TypeIx, VertiportIx};
use vertifleet_sim::{Decision, Imagined, View};

use base_rule::BaseRule;
pub use choices::Choices;
use ranks::Ranks;
use relaxation::Relaxation;
pub use units::units_usd;
use volume::{Effort, Volume};

/// Effort where there are no prices yet. Days of up to about 60 vertiports have all these passes,
/// and those of up to 30 all the passes of `AGAIN`; on larger days more passes would take longer
/// than a dispatcher can wait.
const FIRST: Effort = Effort { passes: 500, hops: 480_000_000, step: 1.0 };
/// Effort where there are prices already. Longer steps leave good prices behind: days earned 0.8 %
/// less with 1.0.
const AGAIN: Effort = Effort { passes: 150, hops: 37_000_000, step: 0.1 };
/// Effort of a service that is busy. Days of `paper` and of `new-york` earn 0.2 % less with it than
/// with `AGAIN`.
const BRIEFLY: Effort = Effort { passes: 50, ..AGAIN };
/// Seconds after which prices are recomputed. On days of `paper`, 5 minutes earned no more.
const RENEWAL_S: u32 = 900;
/// Older prices are not used, not even for a moment.
const OLDEST_S: u32 = 3_600;
/// Seconds after which the base rule is chosen again.
const BASE_RULE_RENEWAL_S: u32 = 3_600;

/// Prices for the rest of a day, and the worth of every choice at them.
#[derive(Debug, Clone)]
pub struct DayPrices {
    relaxation: Relaxation,
    volume: Volume,
    units_usd: Vec<f64>,
    made_at: Time,
    /// The unexpected openings and closings of routes that the prices take into account.
    route_changes: usize,
    stake_usd: f64,
    base_rule: BaseRule,
    base_rule_made_at: Time,
    /// The destinations of decisions in the near future, from the first [`rank`](Self::rank) after
    /// a search on.
    ranks: OnceLock<Ranks>,
    /// Memory to play the rest of the day out in.
    room: Option<Imagined>,
}

/// A feasible choice and its worth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PricedChoice {
    /// Worth of the choice, dollars.
    pub worth_usd: f64,
    /// The vertiport to fly to; to hold, the one where the aircraft is.
    pub to: VertiportIx,
}

impl PricedChoice {
    /// The choice that is worth most, and of equals the first; `None` without choices.
    #[inline]
    pub fn best(choices: impl IntoIterator<Item = Self>) -> Option<VertiportIx> {
        let mut best = (f64::NEG_INFINITY, None);
        for Self { worth_usd, to } in choices {
            if worth_usd > best.0 {
                best = (worth_usd, Some(to));
            }
        }
        best.1
    }
}

impl DayPrices {
    /// Finds prices from `now`, which is the view's time, to the end of its day.
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
            ranks: OnceLock::new(),
            room: None,
        };
        prices.search(view, FIRST);
        prices.choose_base_rule(view, now);
        prices
    }

    /// Updates the prices as the day goes on. After a quarter of an hour, and at once when a route
    /// closes or opens unexpectedly, they are recomputed, starting from the old ones, with the
    /// current fleet and demand. `now` is the view's time, later on the same day.
    pub fn refresh(&mut self, view: View<'_>, now: Time) {
        if self.is_old(now) || view.route_changes() != self.route_changes {
            self.search_again(view, now, AGAIN);
        }
    }

    /// Recomputes the prices at `now`, with a third of the passes of [`refresh`](Self::refresh).
    pub(crate) fn refresh_briefly(&mut self, view: View<'_>, now: Time) {
        self.search_again(view, now, BRIEFLY);
    }

    fn search_again(&mut self, view: View<'_>, now: Time, effort: Effort) {
        self.route_changes = view.route_changes();
        self.search(view, effort);
        self.made_at = now;
        if now >= self.base_rule_made_at + BASE_RULE_RENEWAL_S {
            self.choose_base_rule(view, now);
        }
    }

    /// Whether the prices are a quarter of an hour old.
    fn is_old(&self, now: Time) -> bool {
        now >= self.made_at + RENEWAL_S
    }

    /// Whether age is the only reason for which [`refresh`](Self::refresh) would compute the prices
    /// again, and they are young enough to be used a little longer.
    pub(crate) fn is_merely_old(&self, view: View<'_>, now: Time) -> bool {
        self.is_old(now)
            && now < self.made_at + OLDEST_S
            && view.route_changes() == self.route_changes
    }

    /// The time from which on the prices are valid.
    pub(crate) fn made_at(&self) -> Time {
        self.made_at
    }

    fn search(&mut self, view: View<'_>, effort: Effort) {
        self.ranks = OnceLock::new();
        self.relaxation.load(view);
        let rest_usd = self.volume.search(&mut self.relaxation, effort);
        self.stake_usd = rest_usd.max(0.0) / f64::from(self.relaxation.kept_decisions().max(1));
    }

    fn choose_base_rule(&mut self, view: View<'_>, now: Time) {
        let mut room = self.room.take();
        self.base_rule = BaseRule::best(self, view, &mut room);
        self.room = room;
        self.base_rule_made_at = now;
    }

    /// Dollars that an aircraft of a type that is ready at a vertiport at a time with a full
    /// battery may still earn, less its payments for stands and passengers; 0 past the end of
    /// operations. `time` must not be before the view's time.
    pub fn worth_usd(&self, kind: TypeIx, vertiport: VertiportIx, time: Time) -> f64 {
        self.relaxation.kept_values().worth_usd(kind, vertiport, time.seconds())
    }

    /// What the aircraft that is ready next at a vertiport may still earn, as
    /// [`worth_usd`](Self::worth_usd), with what its battery holds then; dollars.
    pub fn aircraft_worth_usd(&self, view: View<'_>, aircraft: AircraftIx) -> f64 {
        let (kind, at) = (view.kind(aircraft), view.places()[aircraft.at()]);
        let ready = view.ready_at(aircraft);
        if !view.charges_as_needed() {
            return self.worth_usd(kind, at, ready);
        }
        let (levels, _) = self.relaxation.charging();
        let levels = &levels.of_kind(kind)[at.at()];
        let ready = levels.nearest(ready.seconds(), view.to_full_s(aircraft, ready));
        let ready = ready.no_sooner_than(self.made_at.seconds());
        self.relaxation.kept_values().worth_at_level_usd(kind, at, ready)
    }

    /// Price of a stand from one time to another, dollars.
    pub fn rent_usd(&self, vertiport: VertiportIx, from: Time, until: Time) -> f64 {
        self.relaxation.kept_values().rent_usd(vertiport, from.seconds(), until.seconds())
    }

    /// Price of the right to carry one more passenger of a demand period, dollars.
    pub fn passenger_usd(&self, period: usize, from: VertiportIx, to: VertiportIx) -> f64 {
        self.relaxation.passenger_usd(period, from, to)
    }

    /// Profit of a typical full flight of a type, dollars: the unit in which differences in worth
    /// are large or small.
    pub fn unit_usd(&self, kind: TypeIx) -> f64 {
        self.units_usd[kind.at()]
    }

    /// The stake of a decision in the rest of the day, dollars: the profit that the fleet may still
    /// earn, divided by the number of decisions that it takes for that. 0 where nothing can be
    /// earned.
    pub fn stake_usd(&self) -> f64 {
        self.stake_usd
    }

    /// Worth of a feasible choice, dollars: the profit of its flight and the worth of being ready
    /// at its end, less the price of the stand until then.
    #[inline]
    pub fn choice_usd(&self, view: View<'_>, decision: &Decision, to: VertiportIx) -> f64 {
        self.choices(view, decision).worth_usd(to)
    }

    /// The choices of a decision, for the worth of several of them.
    #[inline]
    pub fn choices<'a>(&'a self, view: View<'a>, decision: &Decision) -> Choices<'a> {
        let kind = view.kind(decision.aircraft);
        let worths = self.relaxation.kept_values().worths_from(kind, decision.time.seconds());
        Choices::of(view, decision, worths, self.relaxation.charging())
    }

    /// The choice of the base rule: the feasible choice that is worth most, and of equals the
    /// vertiport listed first, unless another rule is expected to earn more over the rest of the
    /// day.
    #[inline]
    pub fn best_choice(&self, view: View<'_>, decision: &Decision) -> VertiportIx {
        self.base_rule.choice(self, view, decision)
    }

    /// Makes [`best_with`](Self::best_with) fast for decisions up to `ahead_s` after each decision
    /// until the prices are recomputed. `view` is of the day of the prices.
    pub(crate) fn rank(&self, view: View<'_>, ahead_s: u32) {
        self.ranks.get_or_init(|| {
            let until = self.made_at + RENEWAL_S + ahead_s;
            self.relaxation.ranks(view, (self.made_at, until))
        });
    }

    /// The choice of the base rule if something is added to the worth of each choice: `added_usd`,
    /// which is at most `most_added_usd`.
    #[inline]
    pub(crate) fn best_with(
        &self,
        view: View<'_>,
        decision: &Decision,
        most_added_usd: f64,
        added_usd: impl Fn(VertiportIx) -> f64,
    ) -> VertiportIx {
        let &Decision { time, at, aircraft, .. } = decision;
        let ranks = self.ranks.get().filter(|_| self.base_rule != BaseRule::Greedy);
        let choices = self.choices(view, decision);
        let from = (view.kind(aircraft), at);
        if let Some(ranked) = ranks.and_then(|ranks| ranks.from(from, time, choices.band())) {
            let feasible = view.feasible(decision);
            let open = |to| feasible.contains(to) && self.base_rule.allows(&choices, to);
            return ranked.best(&choices, at, open, most_added_usd, added_usd);
        }
        let more = |PricedChoice { worth_usd, to }| {
            let worth_usd = worth_usd + added_usd(to);
            PricedChoice { worth_usd, to }
        };
        PricedChoice::best(self.open_choices(view, decision).map(more)).unwrap_or(at)
    }

    /// The choices that the base rule permits, each with its worth in dollars.
    #[inline]
    pub(crate) fn open_choices<'a>(
        &'a self,
        view: View<'a>,
        decision: &'a Decision,
    ) -> impl Iterator<Item = PricedChoice> + 'a {
        let only = (self.base_rule == BaseRule::Greedy).then(|| self.best_choice(view, decision));
        let choices = self.choices(view, decision);
        let open = move |&to: &VertiportIx| match only {
            Some(only) => to == only,
            None => self.base_rule.allows(&choices, to),
        };
        view.feasible(decision).iter().filter(open).map(move |to| choices.priced(to))
    }
}
