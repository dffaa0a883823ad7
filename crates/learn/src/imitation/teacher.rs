//! The teacher of imitation: it observes a decision as the policy does, lists the choices, and
//! labels each with its value in roll-outs.
//!
//! Roll-outs take most of a run's time, so only the [`Shortlist`](vertifleet_policy::Shortlist) is
//! rolled out. `gcaps-x` decides between its choices alone. Policies that observe no prices decide
//! between all feasible choices. A choice that is not on the shortlist gets the value of the worst
//! that is, less the difference of their worth at the prices.

use vertifleet_core::FeatureScales;
use vertifleet_observe::{Observation, PricedDecision, Writer};
use vertifleet_policy::{DayPrices, PricedChoice, RolloutEvaluator, RolloutSettings};
use vertifleet_sim::{Decision, View};

use crate::imitation::dataset::{LabelledChoice, Samples};
use crate::nn::Architecture;
use crate::rollouts::RolloutPlayer;
use crate::scorer::Scorer;

/// Judges decisions of days with one number of vertiports.
pub(super) struct Teacher {
    /// The settings of roll-outs, and two players of them: one for the prices and one for the
    /// policy.
    settings: RolloutSettings,
    evaluator: RolloutEvaluator,
    player: RolloutPlayer,
    observation: Observation,
    writer: Writer,
    judged: Vec<LabelledChoice>,
}

impl Teacher {
    /// A teacher of this policy, whose features are divided by `scales` if they are the paper's.
    pub(super) fn of(
        policy: &Architecture,
        scales: Option<FeatureScales>,
        settings: RolloutSettings,
    ) -> Self {
        Self {
            evaluator: RolloutEvaluator::new(settings.clone()),
            settings,
            player: RolloutPlayer::default(),
            observation: policy.observation(),
            writer: policy.writer(scales),
            judged: Vec::new(),
        }
    }

    /// Adds a decision with the values of its choices in roll-outs. `student` decides in them for
    /// every aircraft; without it, the prices do. `listed` is the shortlist. A decision with
    /// nothing at stake is left out.
    pub(super) fn judge(
        &mut self,
        scene: PricedDecision<'_>,
        listed: &[PricedChoice],
        student: Option<&mut Scorer>,
        samples: &mut Samples,
    ) {
        let PricedDecision { view, decision, prices, .. } = scene;
        let unit_usd = match self.observation {
            Observation::Priced { .. } => scene.addition_usd(),
            Observation::Paper | Observation::Full { .. } => scene.unit_usd,
        };
        if unit_usd <= 0.0 {
            return;
        }
        let values_usd = match student {
            None => self.evaluator.values_usd(prices, view, decision, listed),
            Some(student) => self.player.values_usd(student, &self.settings, scene, listed),
        };
        self.judged.clear();
        let rolled_out = listed.iter().zip(values_usd);
        self.judged.extend(rolled_out.map(|(&PricedChoice { worth_usd, to }, &value_usd)| {
            LabelledChoice { to, worth_usd, value_usd }
        }));
        if !self.observation.is_priced() {
            judge_the_others(prices, view, decision, &mut self.judged);
        }
        let priced = Some((prices, listed));
        samples.rows.push(|row| self.writer.write(view, decision, priced, row));
        samples.judge(unit_usd, &self.judged);
    }
}

/// Adds the feasible choices that were not rolled out.
fn judge_the_others(
    prices: &DayPrices,
    view: View<'_>,
    decision: &Decision,
    judged: &mut Vec<LabelledChoice>,
) {
    let least =
        |of: fn(&LabelledChoice) -> f64| judged.iter().map(of).fold(f64::INFINITY, f64::min);
    let least_worth_usd = least(|one| one.worth_usd);
    let least_value_usd = least(|one| one.value_usd);
    let rolled_out = judged.len();
    for to in view.feasible(decision).iter() {
        if judged[..rolled_out].iter().all(|one| one.to != to) {
            let worth_usd = prices.choice_usd(view, decision, to);
            let value_usd = least_value_usd - (least_worth_usd - worth_usd).max(0.0);
            judged.push(LabelledChoice { to, worth_usd, value_usd });
        }
    }
}
