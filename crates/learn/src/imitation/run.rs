//! A training run by imitation. Each round plays days, rolls out the decisions taken there, and
//! learns from all decisions so far.
//!
//! The policy of the earlier rounds plays the days of a round; in the first round, bid prices do. A
//! share of the days come from random networks, a different one each ([`World::Random`]); the other
//! days come from the run's world.

use std::path::Path;
use std::sync::Arc;

use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};
use vertifleet_core::{Scenario, Stop, World};
use vertifleet_observe::PricedDecision;
use vertifleet_policy::{DayPrices, Shortlist, draw};
use vertifleet_sim::Simulation;

use crate::error::Error;
use crate::header::Header;
use crate::imitation::dataset::{Dataset, Samples};
use crate::imitation::teacher::Teacher;
use crate::imitation::update::{Fit, Optimiser, Pace};
use crate::imitation::{ImitationRow, ImitationSettings};
use crate::model::Model;
use crate::nn::Weights;
use crate::rows::Rows;
use crate::run::begin::{Begin, training_days};
use crate::run::{
    Curve, RunIdentity, TrainingRequest, TrainingRun, Work, check_finite, checkpoint,
};
use crate::scorer::Scorer;
use crate::settings::Learner;
use crate::validation::ValidationDays;

/// Approximate number of decisions of an aircraft on a day.
const DECISIONS_AN_AIRCRAFT: f64 = 11.0;

/// A run in progress.
pub(crate) struct ImitationRun {
    identity: RunIdentity,
    settings: ImitationSettings,
    /// The header of the run's models, except for the number of steps.
    header: Header,
    world: World,
    /// The weights that the run began with.
    first: Vec<f32>,
    learner: Optimiser,
    dataset: Dataset,
    curve: Vec<ImitationRow>,
    validation: ValidationDays,
}

/// The progress of a run as its checkpoint stores it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Progress {
    curve: Vec<ImitationRow>,
    /// The numbers of vertiports that there are samples for.
    vertiports: Vec<usize>,
}

impl Learner for ImitationSettings {
    fn curve_opening(&self) -> &'static str {
        "round,decisions,agreement,lift,"
    }

    fn begin(
        &self,
        plan: &TrainingRequest,
        identity: RunIdentity,
        from: Option<&Path>,
    ) -> Result<Box<dyn TrainingRun>, Error> {
        if plan.policy.learns_by_ppo() && self.own_rounds > 0 {
            let rule = format!("must be 0 for {}, whose logits are in no unit", plan.policy.name());
            return Err(Error::BadSetting { name: "own_rounds".to_owned(), rule });
        }
        if self.kept > 0.0 && plan.begin_with.is_none() {
            let rule = "must be 0 for a run that begins with fresh weights".to_owned();
            return Err(Error::BadSetting { name: "kept".to_owned(), rule });
        }
        let Begin { net, vertiports, header, params, adam, checkpoint } =
            Begin::<Progress>::of(plan, &identity, self.random_share, from)?;
        // The days of a round and the order of its samples follow from the seed and the round's
        // number, so the checkpoint needs no generator.
        let (mut dataset, mut curve) = (Dataset::default(), Vec::new());
        if let Some(checkpoint) = checkpoint {
            let vertiports = &checkpoint.progress.vertiports;
            dataset = checkpoint.others(|file| Dataset::read(file, &plan.policy, vertiports))?;
            curve = checkpoint.progress.curve;
        }
        let numbers = curve.iter().map(|row: &ImitationRow| row.round);
        checkpoint::check_steps("rounds", numbers, self.rounds)?;
        let validation =
            ValidationDays::of(&plan.world, self.validation_days, plan.policy.fits_any_size())?;
        Ok(Box::new(ImitationRun {
            header,
            world: plan.world.clone(),
            first: plan.first_params(&net),
            learner: Optimiser::new(plan.policy.clone(), vertiports, params, adam),
            identity,
            settings: self.clone(),
            dataset,
            curve,
            validation,
        }))
    }
}

impl ImitationRun {
    /// Plays days, learns, and measures on the validation days. After [`Error::Stopped`], nothing
    /// is undone.
    fn round(&mut self, stop: &Stop, worked: &(dyn Fn(u64) + Sync)) -> Result<ImitationRow, Error> {
        let days = self.days()?;
        let actor = (self.rounds_done() > 0).then(|| Arc::new(self.learner.weights.clone()));
        let samples: Vec<Samples> = days
            .par_iter()
            .map(|day| {
                stop.check()?;
                let samples = self.samples(day, actor.as_ref());
                worked(1);
                Ok(samples)
            })
            .collect::<Result<_, Error>>()?;
        for samples in samples {
            self.dataset.add(samples);
        }
        let fit = self.fit(stop, worked)?;
        check_finite(self.learner.weights.params(), u64::from(self.rounds_done()) + 1)?;
        let found = self.validation.measure(&self.model());
        Ok(ImitationRow {
            round: self.rounds_done() + 1,
            decisions: self.dataset.len() as u64,
            agreement: fit.agreement,
            lift: fit.lift,
            most_lift: fit.most,
            validation_reward: found.reward,
            gain: found.gain,
            random_gain: found.random_gain,
        })
    }

    /// Makes the round's passes over all samples so far. Returns the fit of the last pass.
    fn fit(&mut self, stop: &Stop, worked: &dyn Fn(u64)) -> Result<Fit, Error> {
        let mut fit = Fit::default();
        let (settings, done) = (&self.settings, self.rounds_done());
        let all = f64::from(settings.rounds * settings.passes);
        for pass in 0..settings.passes {
            stop.check()?;
            let number = done * settings.passes + pass;
            let pace = |share: f64| Pace {
                learning_rate: settings.learning_rate
                    * (1.0 - 0.9 * (f64::from(number) + share) / all) as f32,
                entropy_weight: settings.entropy_weight,
            };
            let seed = u64::from(self.identity.seed) << 32 | u64::from(number);
            fit = self.learner.pass(&self.dataset, seed, pace);
            worked(1);
        }
        stop.check()?;
        Ok(fit)
    }

    /// Whether the policy itself decides in the roll-outs of a round, which are counted from 0.
    fn rolls_itself_out(&self, round: u32) -> bool {
        round > 0 && round + self.settings.own_rounds >= self.settings.rounds
    }

    fn rounds_done(&self) -> u32 {
        u32::try_from(self.curve.len()).expect("a run has saturating_count rounds")
    }

    /// The days of the next round.
    fn days(&self) -> Result<Vec<Arc<Scenario>>, Error> {
        let round = (self.rounds_done(), self.settings.days);
        training_days(&self.world, self.identity.seed, self.settings.random_share, round)
    }

    /// Plays a day and rolls out a share of its decisions.
    fn samples(&self, day: &Arc<Scenario>, actor: Option<&Arc<Weights>>) -> Samples {
        let vertiports = day.vertiports.len();
        let (policy, scales) = (&self.header.policy, self.header.feature_scales);
        let mut student = actor.map(|weights| Scorer::new(policy, scales, Arc::clone(weights)));
        let is_own = self.rolls_itself_out(self.rounds_done());
        let share =
            f64::from(self.settings.samples) / (DECISIONS_AN_AIRCRAFT * day.aircraft.len() as f64);
        let mut teacher = Teacher::of(policy, scales, self.settings.expert.clone());
        let mut samples = Samples::new(Rows::new(policy, vertiports));
        let mut shortlist = Shortlist::default();
        let mut simulation = Simulation::new(Arc::clone(day));
        let mut prices: Option<DayPrices> = None;
        while let Some(decision) = simulation.next_decision() {
            let view = simulation.view();
            let prices = prices.get_or_insert_with(|| DayPrices::of(view, decision.time));
            prices.refresh(view, decision.time);
            let listed = shortlist.rank(prices, view, &decision);
            let scene = PricedDecision::of(view, &decision, prices);
            let bits = |what: u64| draw(what, day.seed, decision.index) >> 11;
            let chance = |what: u64| bits(what) as f64 / (1_u64 << 53) as f64;
            if listed.len() > 1 && chance(1) < share {
                let by = student.as_mut().filter(|_| is_own);
                teacher.judge(scene, listed, by, &mut samples);
            }
            let choice = if chance(2) < self.settings.exploration {
                listed[((u128::from(bits(3)) * listed.len() as u128) >> 53) as usize].to
            } else if let Some(student) = &mut student {
                student.choose(scene, listed)
            } else {
                listed[0].to
            };
            simulation.apply(choice).expect("lists are of feasible choices");
        }
        samples
    }
}

impl TrainingRun for ImitationRun {
    fn is_done(&self) -> bool {
        self.rounds_done() >= self.settings.rounds
    }

    fn work(&self) -> Work {
        // Playing the days takes about as long as making the passes.
        let a_round = u64::from(self.settings.days) + u64::from(self.settings.passes);
        let rounds = u64::from(self.settings.rounds);
        Work { done: a_round * self.curve.len() as u64, total: a_round * rounds, units: "days" }
    }

    fn advance(&mut self, stop: &Stop, worked: &(dyn Fn(u64) + Sync)) -> Result<(), Error> {
        let before = (self.learner.weights.clone(), self.learner.adam.clone());
        let lengths = self.dataset.lengths();
        match self.round(stop, worked) {
            Ok(row) => self.curve.push(row),
            Err(error) => {
                (self.learner.weights, self.learner.adam) = before;
                self.dataset.truncate(&lengths);
                return Err(error);
            }
        }
        Ok(())
    }

    fn curve(&self) -> Curve {
        Curve::of(&self.curve)
    }

    fn model(&self) -> Model {
        let header = self.header.after(self.dataset.len() as u64);
        let mut params = self.learner.weights.params().to_vec();
        if self.settings.kept > 0.0 {
            let kept = self.settings.kept as f32;
            for (param, first) in params.iter_mut().zip(&self.first) {
                *param += kept * (first - *param);
            }
        }
        Model::new(header, params).expect("a run has checked all of this")
    }

    fn write_checkpoint(&self, path: &Path) -> Result<(), Error> {
        let vertiports = self.dataset.lengths().into_keys().collect();
        let progress = Progress { curve: self.curve.clone(), vertiports };
        let Optimiser { weights, adam, .. } = &self.learner;
        let samples: Vec<_> = self.dataset.tensors(&self.identity.policy).collect();
        let samples = samples.iter().map(|(name, numbers)| (name.clone(), &numbers[..]));
        checkpoint::write(path, &self.identity, weights.params(), adam, &progress, samples)
    }
}
