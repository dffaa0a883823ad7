//! The teacher: what a policy that learns by imitation sees of a decision, between which choices it
//! decides, and what roll-outs say of them.
//!
//! Roll-outs take most of a run's time, so only the [`Shortlist`](vertifleet_policy::Shortlist) is
//! rolled out. `gcaps-x` decides between its choices alone. Policies that see no prices decide
//! between all feasible choices. Those that are not on the shortlist are judged to be below the
//! worst that is, by what they are worth less at the prices.

use std::sync::Arc;

use vertifleet_core::VertiportIx;
use vertifleet_policy::{DayPrices, Policy as _, PricedChoice, RolloutEvaluator, RolloutSettings};
use vertifleet_sim::{Decision, View};

use crate::features::Scales;
use crate::full::FullPolicy;
use crate::full::features as full;
use crate::gcaps_x::features::{self as priced, Scene};
use crate::gcaps_x::scorer::Scorer;
use crate::header::{network, shape_of};
use crate::imitation::dataset::{LabelledChoice, Samples};
use crate::learned::Learned;
use crate::nn::{Architecture, Weights};
use crate::rollouts::RolloutPlayer;
use crate::rows::{Rows, has_edges};

/// Why a learned policy has an answer.
const CHOOSES: &str = "every decision has a choice";

/// Judges decisions of days with one number of vertiports.
pub(super) struct Teacher {
    /// The settings of roll-outs, and what plays them: one by the prices, and one by the policy
    /// itself.
    settings: RolloutSettings,
    evaluator: RolloutEvaluator,
    player: RolloutPlayer,
    writer: Writer,
    judged: Vec<LabelledChoice>,
}

/// Writes what the policy sees.
enum Writer {
    Paper(Scales),
    Priced(priced::Writer),
    Full(full::Writer),
}

/// The policy that plays the days, with what it has learned so far.
pub(super) enum Student {
    Paper(Box<Learned>),
    Priced(Box<Scorer>),
    Full(Box<FullPolicy>),
}

/// A policy without weights: its kind and sizes, and what its features are divided by if they are
/// those of the paper.
#[derive(Clone, Copy)]
pub(super) struct Sees<'a> {
    pub(super) policy: &'a Architecture,
    pub(super) scales: Option<Scales>,
}

impl Teacher {
    /// A teacher of this policy, and a place for its samples.
    pub(super) fn of(
        Sees { policy, scales }: Sees<'_>,
        vertiports: usize,
        settings: RolloutSettings,
    ) -> (Self, Samples) {
        let rows = Rows::new(shape_of(policy, vertiports), has_edges(policy));
        let writer = match scales {
            Some(scales) => Writer::Paper(scales),
            None if policy.sees_prices() => Writer::Priced(priced::Writer::default()),
            None => Writer::Full(full::Writer::of(policy)),
        };
        let evaluator = RolloutEvaluator::new(settings.clone());
        let (player, judged) = (RolloutPlayer::default(), Vec::new());
        (Self { settings, evaluator, player, writer, judged }, Samples::new(rows))
    }

    /// Adds a decision, with what roll-outs say of its choices, in which `student` decides for
    /// every aircraft, or the prices do if there is none. `listed` is its shortlist. A decision
    /// with nothing at stake teaches nothing and is left out.
    pub(super) fn judge(
        &mut self,
        scene: Scene<'_>,
        listed: &[PricedChoice],
        student: Option<&mut Student>,
        samples: &mut Samples,
    ) {
        let Scene { view, decision, prices, .. } = scene;
        let unit_usd = match &mut self.writer {
            Writer::Priced(_) => scene.addition_usd(),
            Writer::Paper(_) | Writer::Full(_) => scene.unit_usd,
        };
        if unit_usd <= 0.0 {
            return;
        }
        let (player, settings) = (&mut self.player, &self.settings);
        let values_usd = match student {
            None => self.evaluator.values_usd(prices, view, decision, listed),
            Some(student) => student.values_usd(player, settings, scene, listed),
        };
        self.judged.clear();
        let rolled_out = listed.iter().zip(values_usd);
        self.judged.extend(rolled_out.map(|(&PricedChoice { worth_usd, to }, &value_usd)| {
            LabelledChoice { to, worth_usd, value_usd }
        }));
        match &mut self.writer {
            Writer::Priced(writer) => writer.push(scene, listed, &mut samples.rows),
            Writer::Paper(scales) => {
                judge_the_others(prices, view, decision, &mut self.judged);
                samples.rows.push_between(view.feasible(decision), |row| {
                    *row.clock = scales.write(row.nodes, row.aircraft, decision, view);
                });
            }
            Writer::Full(writer) => {
                judge_the_others(prices, view, decision, &mut self.judged);
                writer.push(view, decision, &mut samples.rows);
            }
        }
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

impl Student {
    /// The policy with these weights.
    pub(super) fn of(
        Sees { policy, scales }: Sees<'_>,
        weights: &Arc<Weights>,
        vertiports: usize,
    ) -> Self {
        let shared = || Arc::clone(weights);
        match scales {
            Some(scales) => {
                let (net, weights) = (network(policy, vertiports), Weights::clone(weights));
                Self::Paper(Box::new(Learned::of(net, weights, scales)))
            }
            None if policy.sees_prices() => {
                Self::Priced(Box::new(Scorer::new(policy, shared(), vertiports)))
            }
            None => Self::Full(Box::new(FullPolicy::of(policy.clone(), shared()))),
        }
    }

    /// The value of each choice of a list if the policy decides for every aircraft afterwards,
    /// dollars.
    fn values_usd<'player>(
        &mut self,
        player: &'player mut RolloutPlayer,
        settings: &RolloutSettings,
        scene: Scene<'_>,
        listed: &[PricedChoice],
    ) -> &'player [f64] {
        match self {
            Self::Paper(_) => unreachable!("the settings of a run are checked"),
            Self::Priced(scorer) => player.values_usd(scorer.as_mut(), settings, scene, listed),
            Self::Full(policy) => player.values_usd(policy.as_mut(), settings, scene, listed),
        }
    }

    /// Its choice; `listed` is the shortlist of the decision.
    pub(super) fn choose(&mut self, scene: Scene<'_>, listed: &[PricedChoice]) -> VertiportIx {
        match self {
            Self::Priced(scorer) => scorer.best(scene, listed),
            Self::Paper(policy) => policy.choose(scene.decision, &scene.view).expect(CHOOSES),
            Self::Full(policy) => policy.choose(scene.decision, &scene.view).expect(CHOOSES),
        }
    }
}
