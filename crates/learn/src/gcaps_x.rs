//! `gcaps-x`: bid prices corrected by one network of layers, which serves networks of every size.
//!
//! The features of `gcaps` and `mlp` grow with the number of vertiports, and so do their weights.
//! Here the features of a node describe what a flight to that vertiport means to the deciding
//! aircraft, in dimensionless numbers, so the graph capsules and the attention of §IV have the same
//! weights for any number of vertiports and aircraft. A choice is worth its value at the day's bid
//! prices plus a correction by the network ([`crate::scorer`]). The policy learns by
//! [imitation](crate::imitation) of roll-outs.

use std::sync::Arc;

use vertifleet_core::VertiportIx;
use vertifleet_observe::PricedDecision;
use vertifleet_policy::{DayPrices, Policy, PolicyError, PriceMemory, PricedChoice, Shortlist};
use vertifleet_sim::{Decision, View};

use crate::model::Model;
use crate::rollouts::{ROLLOUTS, RolloutPlayer};
use crate::scorer::Scorer;

/// Decides by the day's prices and by a network that scores the choices whose worth is close to
/// that of the best.
pub struct GcapsX {
    scorer: Scorer,
    prices: PriceMemory,
    shortlist: Shortlist,
    /// The choices with their worth by prices and network, dollars.
    scored: Vec<PricedChoice>,
    /// The number of choices that are rolled out, and the player of the roll-outs; `None` if the
    /// policy decides at once.
    rollouts: Option<(usize, RolloutPlayer)>,
}

impl GcapsX {
    /// At most this many choices are scored, so no more can be rolled out.
    pub const MOST_ROLLED_OUT: usize = Shortlist::MOST;

    /// The policy of a `gcaps-x` model. It rolls its `most_rolled_out` best choices out before it
    /// decides, at most [`MOST_ROLLED_OUT`](Self::MOST_ROLLED_OUT); with 1 or 0 it decides at once.
    pub fn new(model: &Model, most_rolled_out: usize) -> Self {
        let weights = Arc::new(model.weights());
        Self::of(Scorer::new(&model.header().policy, None, weights), most_rolled_out)
    }

    pub(crate) fn of(scorer: Scorer, most_rolled_out: usize) -> Self {
        let most = most_rolled_out.min(Self::MOST_ROLLED_OUT);
        Self {
            scorer,
            prices: PriceMemory::default(),
            shortlist: Shortlist::default(),
            scored: Vec::new(),
            rollouts: (most > 1).then(|| (most, RolloutPlayer::default())),
        }
    }
}

impl Policy for GcapsX {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let Self { scorer, prices, shortlist, scored, rollouts } = self;
        let prices = prices.at(*view, decision);
        let listed = shortlist.rank(prices, *view, decision);
        let scene = PricedDecision::of(*view, decision, prices);
        let Some((most_rolled_out, rollouts)) = rollouts else {
            return Ok(scorer.choose(scene, listed));
        };
        if let [only] = listed {
            return Ok(only.to);
        }
        scorer.worth(scene, listed, scored);
        scored.sort_by(|one, other| other.worth_usd.total_cmp(&one.worth_usd));
        scored.truncate(*most_rolled_out);
        Ok(rollouts.best(scorer, scene, scored))
    }

    fn choose_with_values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<VertiportIx, PolicyError> {
        let Self { scorer, prices, shortlist, scored, rollouts } = self;
        let prices = prices.at(*view, decision);
        let listed = shortlist.rank(prices, *view, decision);
        let scene = PricedDecision::of(*view, decision, prices);
        scorer.worth(scene, listed, scored);
        // As in `choose`, if no worth is a number.
        let mut otherwise = listed[0].to;
        if let (Some((most_rolled_out, rollouts)), [_, _, ..]) = (rollouts, listed) {
            scored.sort_by(|one, other| other.worth_usd.total_cmp(&one.worth_usd));
            scored.truncate(*most_rolled_out);
            let values_usd = rollouts.values_usd(scorer, &ROLLOUTS, scene, scored);
            for (choice, &value_usd) in scored.iter_mut().zip(values_usd) {
                choice.worth_usd = value_usd;
            }
            otherwise = decision.at;
        }
        values.fill(f64::NAN);
        for choice in &*scored {
            values[choice.to.at()] = choice.worth_usd;
        }
        Ok(PricedChoice::best(scored.iter().copied()).unwrap_or(otherwise))
    }

    /// Worth of each choice of the shortlist by prices and network, dollars; with roll-outs, the
    /// value of each choice that is rolled out.
    fn values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<(), PolicyError> {
        self.choose_with_values(decision, view, values).map(|_| ())
    }

    fn prices(&mut self, decision: &Decision, view: &View<'_>) -> Option<&DayPrices> {
        Some(self.prices.at(*view, decision))
    }

    fn price_memory(&mut self) -> Option<&mut PriceMemory> {
        Some(&mut self.prices)
    }
}
