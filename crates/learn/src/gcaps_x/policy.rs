//! `gcaps-x` as a policy.

use std::sync::Arc;

use vertifleet_core::VertiportIx;
use vertifleet_policy::{DayPrices, Policy, PolicyError, PriceMemory, PricedChoice, Shortlist};
use vertifleet_sim::{Decision, View};

use crate::gcaps_x::features::Scene;
use crate::gcaps_x::scorer::Scorer;
use crate::model::Model;
use crate::nn::{Architecture, Weights};
use crate::rollouts::RolloutPlayer;

/// Decides by the day's prices and by a network that scores the choices that are worth nearly as
/// much as the best.
pub struct GcapsX {
    architecture: Architecture,
    weights: Arc<Weights>,
    /// The scorer for the number of vertiports of the day, kept until a day has another number.
    scorer: Option<Scorer>,
    prices: PriceMemory,
    shortlist: Shortlist,
    /// The choices with their worth by prices and network, dollars.
    scored: Vec<PricedChoice>,
    /// How many choices are rolled out, and what plays the roll-outs; `None` if the policy decides
    /// at once.
    rollouts: Option<(usize, RolloutPlayer)>,
}

impl GcapsX {
    /// At most this many choices are scored, so no more can be rolled out.
    pub const MOST_ROLLED_OUT: usize = Shortlist::MOST;

    /// The policy of a `gcaps-x` model. It rolls its `most_rolled_out` best choices out before it
    /// decides, at most [`MOST_ROLLED_OUT`](Self::MOST_ROLLED_OUT); with 1 or 0 it decides at once.
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
            prices: PriceMemory::default(),
            shortlist: Shortlist::default(),
            scored: Vec::new(),
            rollouts: (most > 1).then(|| (most, RolloutPlayer::default())),
        }
    }

    /// Writes the worth of each choice of the shortlist by prices and network, and returns the
    /// list, ranked by the prices.
    fn score_shortlist(
        &mut self,
        decision: &Decision,
        view: View<'_>,
        values: &mut [f64],
    ) -> &[PricedChoice] {
        let prices = self.prices.at(view, decision);
        let listed = self.shortlist.rank(prices, view, decision);
        let scorer = sized(&mut self.scorer, &self.architecture, &self.weights, view.vertiports());
        let scene = Scene::of(view, decision, prices);
        scorer.score(scene, listed);
        values.fill(f64::NAN);
        for &choice in listed {
            values[choice.to.at()] = scorer.scored(0, scene.addition_usd(), choice).worth_usd;
        }
        listed
    }
}

impl Policy for GcapsX {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let prices = self.prices.at(*view, decision);
        let listed = self.shortlist.rank(prices, *view, decision);
        if let [only] = listed {
            return Ok(only.to);
        }
        let scorer = sized(&mut self.scorer, &self.architecture, &self.weights, view.vertiports());
        let scene = Scene::of(*view, decision, prices);
        let Some((most_rolled_out, rollouts)) = &mut self.rollouts else {
            return Ok(scorer.best(scene, listed));
        };
        scorer.score(scene, listed);
        let addition_usd = scene.addition_usd();
        self.scored.clear();
        self.scored.extend(listed.iter().map(|&choice| scorer.scored(0, addition_usd, choice)));
        self.scored.sort_by(|one, other| other.worth_usd.total_cmp(&one.worth_usd));
        self.scored.truncate(*most_rolled_out);
        Ok(rollouts.best(scorer, scene, &self.scored))
    }

    fn choose_with_values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<VertiportIx, PolicyError> {
        let rolls_out = self.rollouts.is_some();
        let listed = self.score_shortlist(decision, *view, values);
        if rolls_out {
            return self.choose(decision, view);
        }
        let better = |best: VertiportIx, choice: &PricedChoice| {
            if values[choice.to.at()] > values[best.at()] { choice.to } else { best }
        };
        Ok(listed.iter().fold(listed[0].to, better))
    }

    /// Worth of each choice of the shortlist by prices and network, dollars, before any roll-outs.
    fn values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<(), PolicyError> {
        self.score_shortlist(decision, *view, values);
        Ok(())
    }

    fn prices(&mut self, decision: &Decision, view: &View<'_>) -> Option<&DayPrices> {
        Some(self.prices.at(*view, decision))
    }

    fn price_memory(&mut self) -> Option<&mut PriceMemory> {
        Some(&mut self.prices)
    }
}

/// The scorer for this number of vertiports.
fn sized<'a>(
    scorer: &'a mut Option<Scorer>,
    architecture: &Architecture,
    weights: &Arc<Weights>,
    vertiports: usize,
) -> &'a mut Scorer {
    if scorer.as_ref().is_none_or(|scorer| scorer.vertiports() != vertiports) {
        *scorer = Some(Scorer::new(architecture, Arc::clone(weights), vertiports));
    }
    scorer.as_mut().expect("there is one by now")
}
