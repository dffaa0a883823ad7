//! `gcaps-x` as a policy.

use std::sync::Arc;

use vertifleet_core::VertiportIx;
use vertifleet_policy::{DayMemory, DayPrices, Policy, PolicyError, Shortlist};
use vertifleet_sim::{Decision, View};

use crate::gcaps_x::features::Scene;
use crate::gcaps_x::rollouts::RolloutPlayer;
use crate::gcaps_x::scorer::Scorer;
use crate::model::Model;
use crate::nn::{Architecture, Weights};

/// Decides by the day's prices and a network that scores what is worth nearly as much as the best.
pub struct GcapsX {
    architecture: Architecture,
    weights: Arc<Weights>,
    /// Made for the number of vertiports that is met, and kept until another one is.
    scorer: Option<Scorer>,
    day: DayMemory<DayPrices>,
    shortlist: Shortlist,
    /// Choices with what they are worth by prices and network, dollars.
    scored: Vec<(f64, VertiportIx)>,
    /// How many choices are rolled out, where any are.
    rollouts: Option<(usize, RolloutPlayer)>,
}

impl GcapsX {
    /// No more choices than this are scored, so no more can be rolled out.
    pub const MOST_ROLLED_OUT: usize = Shortlist::MOST;

    /// The policy of a model of this kind, which rolls its `most_rolled_out` best choices out before it decides, up to
    /// [`MOST_ROLLED_OUT`](Self::MOST_ROLLED_OUT); with 1 or 0 it decides at once.
    pub fn new(model: &Model, most_rolled_out: usize) -> Self {
        Self::of(model.header().policy.clone(), Arc::new(model.weights()), most_rolled_out)
    }

    pub(crate) fn of(
        architecture: Architecture,
        weights: Arc<Weights>,
        most_rolled_out: usize,
    ) -> Self {
        let most = most_rolled_out.min(Self::MOST_ROLLED_OUT);
        Self {
            architecture,
            weights,
            scorer: None,
            day: DayMemory::default(),
            shortlist: Shortlist::default(),
            scored: Vec::new(),
            rollouts: (most > 1).then(|| (most, RolloutPlayer::default())),
        }
    }
}

impl Policy for GcapsX {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let prices = self.day.of_day(*view, decision, || DayPrices::of(*view, decision.time));
        prices.refresh(*view, decision.time);
        let listed = self.shortlist.rank(prices, *view, decision);
        if let [(_, only)] = *listed {
            return Ok(only);
        }
        let vertiports = view.vertiports();
        let scorer = match &mut self.scorer {
            Some(scorer) if scorer.vertiports() == vertiports => scorer,
            other => {
                other.insert(Scorer::new(&self.architecture, Arc::clone(&self.weights), vertiports))
            }
        };
        let scene = Scene::of(*view, decision, prices);
        scorer.score(scene, listed);
        let Some((most_rolled_out, rollouts)) = &mut self.rollouts else {
            return Ok(scorer.best_of_row(0, scene.addition_usd(), listed));
        };
        let addition_usd = scene.addition_usd();
        let worths =
            listed.iter().map(|&choice| (scorer.worth_usd(0, addition_usd, choice), choice.1));
        self.scored.clear();
        self.scored.extend(worths);
        self.scored.sort_by(|one, other| other.0.total_cmp(&one.0));
        self.scored.truncate(*most_rolled_out);
        Ok(rollouts.best(scorer, prices, (*view, decision), &self.scored))
    }
}
