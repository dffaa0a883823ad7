//! `rolling`: at every decision, tries out the best choices at the day's prices, and takes the one after which the fleet
//! stands best.
//!
//! A rolling horizon in two parts. To the end of the day, the fleet's programme is solved anew every quarter of an hour from
//! where it stands, is in the air and on charge, with its stands and passengers priced out ([`DayPrices`]). For the next
//! two hours, each of a few choices is played out in the simulator several times, every other aircraft choosing by prices; what
//! the fleet has earned and is worth by then decides. Nothing looks at a clock, so the same day has the same outcome
//! everywhere.

use vertifleet_core::VertiportIx;
use vertifleet_policy::{
    DayMemory, DayPrices, Policy, PolicyError, RolloutEvaluator, RolloutSettings, Shortlist,
};
use vertifleet_sim::{Decision, View};

/// How choices are tried out, tuned on validation days. To the end of the day chance would decide, and days earn less than
/// without trying.
const ROLLOUTS: RolloutSettings =
    RolloutSettings { horizon_s: 7_200, rollouts: 16, noise: 0.05, price_weight: 1.0 };

/// Prices the rest of the day and tries its choices out. Remembers one day at a time.
#[derive(Debug, Clone)]
pub struct Rolling {
    day: DayMemory<DayPrices>,
    shortlist: Shortlist,
    evaluator: RolloutEvaluator,
}

impl Default for Rolling {
    fn default() -> Self {
        let (day, shortlist) = (DayMemory::default(), Shortlist::default());
        Self { day, shortlist, evaluator: RolloutEvaluator::new(ROLLOUTS) }
    }
}

impl Policy for Rolling {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let prices = self.day.of_day(*view, decision, || DayPrices::of(*view, decision.time));
        prices.refresh(*view, decision.time);
        let listed = self.shortlist.rank_with_empty_flights(prices, *view, decision);
        Ok(self.evaluator.best_choice(prices, *view, decision, listed))
    }
}
