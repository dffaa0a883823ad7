//! What the bounds of a day and of its changes prove together.
//!
//! Each bound is searched for separately, and each search stops a little above the lowest bound, so
//! the plain difference of two bounds may be more than a change can be worth, or less than nothing
//! where the change cannot harm. But the prices of one bound prove bounds of the other days too
//! (docs/src/concepts/bound.md, "What the prices say"), since these days differ in one number of
//! the sum
//!
//! ```text
//! sum of V(a) over aircraft a + sum of U_max(j) p(j, s) + sum of Q(i, j, t) q(i, j, t) - what the day costs anyway
//! ```
//!
//! - *One more stand or charger* at j adds the sum of p(j, s), its shadow price, and takes off its
//!   cost. So the prices of the changed day prove its bound less this shadow price, plus the cost,
//!   for the day as it is.
//! - *One more aircraft* adds its V, which is no less than what it earns if it stays where it
//!   starts: nothing, less the price of its stand. So the prices of the changed day prove its
//!   bound, plus the price of that stand and the cost, for the day as it is. The other way round, V
//!   is at most what an aircraft of its type earns from the best start
//!   ([`DesignBound`](vertifleet_optimize::DesignBound)).
//! - *One more seat* can only raise V. So the changed day's bound is also one of the day as it is.
//! - *A minute less for a take-off*, *more energy* and *more power* prove nothing for the day as it
//!   is: aircraft are ready at other seconds, and what was decided at the old ones need not be
//!   possible.
//!
//! The least of what is proven for the day as it is, is its bound here. A day with one more stand
//! has the least of what all these prices prove for it. Every difference is then at least less the
//! cost, because no price is below 0, and at most the shadow price less the cost, because the
//! prices of the day's own bound are among them.
//!
//! A day with more seats, energy or power, or with shorter take-offs, is compared by the prices of
//! its own search and by those of the day's, both evaluated on both days: where the change has no
//! effect, the two bounds are then the same. Prices of further searches count on neither day,
//! because they would make the change look worth as much as they gain on one of them. The prices of
//! another search may lower a bound. That amount is the known error of the bound's own search, and
//! a difference that is no larger has no meaning.

use vertifleet_core::{Scenario, Stop, VertiportIx};
use vertifleet_optimize::{Bound, DesignBound};

use super::worth::{Change, Effect};
use crate::error::Error;

/// More than the errors of the few sums below, dollars.
const ROUNDING_USD: f64 = 1e-6;

/// A search ends when it expects to lower the bound by less than about this share.
const SEARCH_ERROR: f64 = 1e-5;

/// By how much the bound of a changed day is higher.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rise {
    /// After what the change costs, dollars.
    pub(super) usd: f64,
    /// Whether that is no more than the known error of a search.
    pub(super) is_within_error: bool,
}

/// What the prices of two searches prove of the other's day, dollars; infinite if nothing.
pub(super) struct Across {
    /// Of the day as it is, by the prices of the changed day.
    day_usd: f64,
    /// Of the changed day, by those of the day as it is.
    changed_usd: f64,
}

impl Across {
    /// Evaluates the prices of a day and of its change on each other's day, where nothing else
    /// makes the two comparable.
    pub(super) fn of(
        (day, bound): (&Scenario, &Bound),
        change: &Change,
        changed: &Bound,
        stop: &Stop,
    ) -> Self {
        let proven = |bound: &Bound, day| match change.effect {
            Effect::Stand(_) | Effect::Aircraft(..) => None,
            _ => bound.of_other_usd(day, stop),
        };
        Self {
            day_usd: proven(changed, day).unwrap_or(f64::INFINITY),
            changed_usd: proven(bound, &change.day).unwrap_or(f64::INFINITY),
        }
    }
}

/// Prices, and the bound that they prove for the day as it is.
struct Prices<'a> {
    bound: &'a Bound,
    upper_bound_usd: f64,
}

impl Prices<'_> {
    /// What these prices prove for the day with one more stand or charger.
    fn with_stand_usd(&self, at: VertiportIx, cost_usd: f64) -> f64 {
        self.upper_bound_usd + self.bound.stand_shadow_price_usd(at) - cost_usd
    }
}

/// The bounds of a day and of its changes, each as low as any of their prices prove.
pub(super) struct Proven<'a> {
    all: Vec<Prices<'a>>,
    /// Which of them prove the lowest bound of the day as it is.
    best: usize,
    designs: DesignBound,
}

impl<'a> Proven<'a> {
    /// What follows from the bound of a day and those of its changes.
    ///
    /// # Errors
    /// Returns an error if the day with aircraft of every type is too large for a bound.
    pub(super) fn of(
        day: &Scenario,
        bound: &'a Bound,
        changes: impl Iterator<Item = (&'a Change, &'a Bound)>,
    ) -> Result<Self, Error> {
        let own = Prices { bound, upper_bound_usd: bound.upper_bound_usd() };
        let of_changes = changes.filter_map(|(change, bound)| {
            let upper_bound_usd = of_the_day_usd(change, bound)?;
            Some(Prices { bound, upper_bound_usd })
        });
        let all: Vec<Prices<'_>> = std::iter::once(own).chain(of_changes).collect();
        let lower = |one: &usize, other: &usize| {
            all[*one].upper_bound_usd.total_cmp(&all[*other].upper_bound_usd)
        };
        let best = (0..all.len()).min_by(lower).expect("the day has a bound");
        // One more aircraft has no outage.
        let designs = all[best].bound.of_designs(day, false)?;
        Ok(Self { all, best, designs })
    }

    /// The bound of the day as it is, dollars.
    pub(super) fn upper_bound_usd(&self) -> f64 {
        self.all[self.best].upper_bound_usd
    }

    /// The bound whose prices prove it.
    pub(super) fn best(&self) -> &'a Bound {
        self.all[self.best].bound
    }

    /// By how much the bound of a changed day is higher. `bound` was searched for on the changed
    /// day.
    pub(super) fn rise(&self, change: &Change, bound: &Bound, across: &Across) -> Rise {
        let changed_usd = match change.effect {
            Effect::Stand(at) => {
                let proven =
                    self.all.iter().map(|prices| prices.with_stand_usd(at, change.cost_usd));
                proven.fold(f64::INFINITY, f64::min)
            }
            Effect::Aircraft(kind, _) => {
                let most_usd = self.designs.aircraft_shadow_price_usd(kind);
                let proven = self.upper_bound_usd() + most_usd - change.cost_usd + ROUNDING_USD;
                bound.upper_bound_usd().min(proven)
            }
            Effect::Seat => return self.rise_of_searches(bound, across, 0.0),
            Effect::TakeOff | Effect::Battery | Effect::Power => {
                return self.rise_of_searches(bound, across, f64::NEG_INFINITY);
            }
        };
        Rise { usd: changed_usd - self.upper_bound_usd(), is_within_error: false }
    }

    /// The rise by the prices of two searches, the day's own and that of the changed day. It is
    /// known that it is at least `least_usd`.
    fn rise_of_searches(&self, bound: &Bound, across: &Across, least_usd: f64) -> Rise {
        let searched = [self.all[0].upper_bound_usd, bound.upper_bound_usd()];
        let [own_usd, changed_usd] =
            [searched[0].min(across.day_usd), searched[1].min(across.changed_usd)];
        let usd = (changed_usd - own_usd).max(least_usd);
        let gained = [
            searched[0] - self.upper_bound_usd(),
            searched[0] - own_usd,
            searched[1] - changed_usd,
        ];
        let error_usd = gained.into_iter().fold(SEARCH_ERROR * own_usd.abs(), f64::max);
        Rise { usd, is_within_error: usd.abs() <= error_usd }
    }
}

/// What the bound of a changed day proves for the day as it is, if anything.
fn of_the_day_usd(change: &Change, bound: &Bound) -> Option<f64> {
    let before_cost_usd = bound.upper_bound_usd() + change.cost_usd + ROUNDING_USD;
    match change.effect {
        Effect::Stand(at) => Some(before_cost_usd - bound.stand_shadow_price_usd(at)),
        Effect::Aircraft(_, at) => Some(before_cost_usd + bound.stand_shadow_price_usd(at)),
        Effect::Seat => Some(before_cost_usd),
        Effect::TakeOff | Effect::Battery | Effect::Power => None,
    }
}
