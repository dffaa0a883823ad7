//! `gcaps-x` as a policy.

use std::sync::Arc;

use vertifleet_core::VertiportIx;
use vertifleet_policy::{DayMemory, DayPrices, Policy, PolicyError, Shortlist};
use vertifleet_sim::{Decision, View};

use crate::nn::Prepared;
use crate::relative::features::Scene;
use crate::relative::judge::Judge;
use crate::relative::rollouts::Rollouts;
use crate::relative::weights::AnyModel;

/// Decides by the day's prices and a network that judges what is worth nearly as much as the best.
pub struct GcapsX {
    model: Arc<AnyModel>,
    params: Arc<[f32]>,
    prepared: Arc<Prepared>,
    /// Made for the number of vertiports that is met, and kept until another one is.
    judge: Option<Judge>,
    day: DayMemory<DayPrices>,
    shortlist: Shortlist,
    /// Choices with what they are judged to be worth, dollars.
    judged: Vec<(f64, VertiportIx)>,
    /// How many choices are tried out, where any are.
    rollouts: Option<(usize, Rollouts)>,
}

impl GcapsX {
    /// The policy of a model.
    pub fn new(model: Arc<AnyModel>) -> Self {
        Self::with(model, None)
    }

    /// The policy of a model, which tries its `most_tried` best choices out before it decides; 2 to
    /// [`MOST_TRIED`](Self::MOST_TRIED).
    pub fn with_rollouts(model: Arc<AnyModel>, most_tried: usize) -> Self {
        Self::with(model, Some((most_tried.clamp(2, Self::MOST_TRIED), Rollouts::default())))
    }

    /// No more choices than this are judged, so no more can be tried out.
    pub const MOST_TRIED: usize = Shortlist::MOST;

    fn with(model: Arc<AnyModel>, rollouts: Option<(usize, Rollouts)>) -> Self {
        let params: Arc<[f32]> = model.params().into();
        let prepared = Arc::new(model.prepared());
        Self {
            model,
            params,
            prepared,
            judge: None,
            day: DayMemory::default(),
            shortlist: Shortlist::default(),
            judged: Vec::new(),
            rollouts,
        }
    }
}

impl Policy for GcapsX {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let prices = self.day.of_day(*view, decision, || DayPrices::of(*view, decision.time));
        prices.keep_up(*view, decision.time);
        let listed = self.shortlist.rank(prices, *view, decision);
        if let [(_, only)] = *listed {
            return Ok(only);
        }
        let vertiports = view.vertiports();
        let judge = match &mut self.judge {
            Some(judge) if judge.vertiports() == vertiports => judge,
            other => other.insert(Judge::new(
                self.model.architecture(),
                Arc::clone(&self.params),
                Arc::clone(&self.prepared),
                vertiports,
            )),
        };
        let scene = Scene::of(*view, decision, prices);
        judge.judge(scene, listed);
        let Some((most_tried, rollouts)) = &mut self.rollouts else {
            return Ok(judge.best_of_row(0, scene.addition_usd(), listed));
        };
        let addition_usd = scene.addition_usd();
        let judged =
            listed.iter().map(|&choice| (judge.worth_usd(0, addition_usd, choice), choice.1));
        self.judged.clear();
        self.judged.extend(judged);
        self.judged.sort_by(|one, other| other.0.total_cmp(&one.0));
        self.judged.truncate(*most_tried);
        Ok(rollouts.best(judge, prices, (*view, decision), &self.judged))
    }
}
