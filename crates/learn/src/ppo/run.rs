//! A training run by PPO: collects decisions, updates the weights, measures on the validation days,
//! and keeps the weights that did best there.

use std::path::Path;
use std::sync::Arc;

use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};
use vertifleet_core::{DaySeed, Purpose, Scenario, Stop};

use crate::adam::Adam;
use crate::error::Error;
use crate::header::Header;
use crate::learned::Learned;
use crate::lockstep::play_together;
use crate::model::Model;
use crate::nn::{self, Weights};
use crate::ppo::buffer::{Buffer, DayInProgress, Source};
use crate::ppo::update::{Ppo, Update};
use crate::ppo::{PpoRow, PpoSettings};
use crate::run::begin::Begin;
use crate::run::checkpoint::{self, BEST_PARAMS};
use crate::run::{Curve, RunIdentity, TrainingRequest, TrainingRun, Work, check_finite};
use crate::settings::Learner;

/// Number of days whose rewards the curve averages, as in stable-baselines3.
const RECENT_DAYS: usize = 100;
/// Number of validation days that share one inference.
const VALIDATION_BLOCK: usize = 16;

/// A run in progress.
pub(crate) struct PpoRun {
    identity: RunIdentity,
    settings: PpoSettings,
    /// The header of the run's models, except for the number of steps.
    header: Header,
    net: nn::NeuralNetwork,
    weights: Weights,
    adam: Adam,
    ppo: Ppo,
    source: Source,
    buffer: Buffer,
    validation: Vec<Arc<Scenario>>,
    progress: Progress,
}

/// The progress of a run as its checkpoint stores it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Progress {
    updates: u64,
    days_finished: u64,
    recent_rewards: Vec<f64>,
    /// Set when a checkpoint is written; during the run the buffer has the days.
    days: Vec<DayInProgress>,
    best_reward: Option<f64>,
    best_steps: u64,
    #[serde(skip)]
    best_params: Vec<f32>,
    curve: Vec<PpoRow>,
}

impl Learner for PpoSettings {
    fn curve_opening(&self) -> &'static str {
        "update,steps,days,mean_reward,"
    }

    fn begin(
        &self,
        plan: &TrainingRequest,
        identity: RunIdentity,
        from: Option<&Path>,
    ) -> Result<Box<dyn TrainingRun>, Error> {
        if !plan.policy.learns_by_ppo() {
            let rule = format!("{} does not learn by PPO", plan.policy.name());
            return Err(Error::BadSetting { name: "policy".to_owned(), rule });
        }
        let Begin { net, vertiports, header, params, adam, checkpoint } =
            Begin::of(plan, &identity, 0.0, from)?;
        let mut progress = Progress::new(params.clone());
        if let Some(checkpoint) = checkpoint {
            let best_params = checkpoint.best_params()?;
            progress = Progress { best_params, ..checkpoint.progress };
        }
        if progress.updates > self.updates() {
            let rule = format!("{} updates are more than the run has", progress.updates);
            return Err(Error::BadCheckpoint { rule });
        }
        let source = Source { world: plan.world.clone(), run_seed: plan.seed };
        let days = from.map(|_| std::mem::take(&mut progress.days));
        let validation = (0..u64::from(self.eval_days))
            .map(|day| {
                let network = plan.world.network(Purpose::Validation, day);
                Ok(Arc::new(network.draw(DaySeed::validation(day)?)))
            })
            .collect::<Result<_, Error>>()?;
        Ok(Box::new(PpoRun {
            buffer: Buffer::new(&source, &net, self, days)?,
            ppo: Ppo::new(&net, vertiports, self),
            weights: net.weights(params),
            header,
            identity,
            settings: self.clone(),
            net,
            adam,
            source,
            validation,
            progress,
        }))
    }
}

impl PpoRun {
    /// Collects decisions and learns from them. After [`Error::Stopped`], nothing is undone.
    fn update(&mut self, stop: &Stop, worked: &dyn Fn(u64)) -> Result<PpoRow, Error> {
        let finished = self.buffer.collect(&self.source, &self.net, &self.weights)?;
        self.progress.remember_days(&finished);
        let update = self.progress.updates;
        let learning_rate = self.settings.learning_rate_at(update);
        let buffer_size = self.settings.buffer_size() as u64;
        let mut shown = 0;
        let losses = self.ppo.update(
            &self.net,
            &self.buffer,
            Update {
                weights: &mut self.weights,
                adam: &mut self.adam,
                // This seed is different for every update of every run seed.
                seed: u64::from(self.identity.seed) << 32 | update,
                learning_rate,
            },
            &mut |share| {
                #[expect(clippy::cast_sign_loss, reason = "a share of the steps")]
                let steps = (share * buffer_size as f64) as u64;
                worked(steps.saturating_sub(shown));
                shown = steps;
                stop.check()
            },
        )?;
        check_finite(self.weights.params(), update + 1)?;
        self.progress.updates += 1;
        let steps = self.steps();
        let looks = self.progress.updates.is_multiple_of(u64::from(self.settings.eval_every));
        let validation_reward = (looks || self.is_done()).then(|| self.validation_reward());
        if let Some(reward) = validation_reward {
            self.progress.keep_if_best(reward, self.weights.params(), steps);
        }
        Ok(PpoRow {
            update: self.progress.updates,
            steps,
            days: self.progress.days_finished,
            mean_reward: self.progress.mean_recent_reward(),
            validation_reward,
            policy_loss: losses.policy_loss,
            value_loss: losses.value_loss,
            entropy: losses.entropy,
            approx_kl: losses.approx_kl,
            clip_fraction: losses.clip_fraction,
            learning_rate: f64::from(learning_rate),
        })
    }

    /// Number of decisions learned from.
    fn steps(&self) -> u64 {
        self.progress.updates * self.settings.buffer_size() as u64
    }

    /// Mean reward on the validation days, with the best choices only.
    fn validation_reward(&self) -> f64 {
        let model = self.model_of(self.weights.params(), 0);
        let blocks: Vec<&[Arc<Scenario>]> = self.validation.chunks(VALIDATION_BLOCK).collect();
        let rewards = blocks
            .par_iter()
            .map(|block| play_together(&mut Learned::new(&model), block))
            .collect::<Vec<_>>();
        rewards.iter().flatten().map(|day| day.reward).sum::<f64>() / self.validation.len() as f64
    }

    fn model_of(&self, params: &[f32], steps: u64) -> Model {
        Model::new(self.header.after(steps), params.to_vec())
            .expect("a run has checked all of this")
    }
}

impl TrainingRun for PpoRun {
    fn is_done(&self) -> bool {
        self.progress.updates >= self.settings.updates()
    }

    fn work(&self) -> Work {
        let total = self.settings.updates() * self.settings.buffer_size() as u64;
        Work { done: self.steps(), total, units: "steps" }
    }

    fn advance(&mut self, stop: &Stop, worked: &(dyn Fn(u64) + Sync)) -> Result<(), Error> {
        let before = (self.weights.params().to_vec(), self.adam.clone());
        let progress = Progress { days: self.buffer.days(), ..self.progress.clone() };
        match self.update(stop, worked) {
            Ok(row) => self.progress.curve.push(row),
            Err(Error::Stopped) => {
                let (params, adam) = before;
                let Self { net, source, settings, .. } = self;
                self.buffer = Buffer::new(source, net, settings, Some(progress.days.clone()))?;
                (self.weights, self.adam) = (self.net.weights(params), adam);
                self.progress = progress;
                return Err(Error::Stopped);
            }
            Err(error) => return Err(error),
        }
        Ok(())
    }

    fn curve(&self) -> Curve {
        Curve::of(&self.progress.curve)
    }

    fn model(&self) -> Model {
        match self.progress.best_reward {
            // Before the first measurement on the validation days, these are the latest weights.
            None => self.model_of(self.weights.params(), self.steps()),
            Some(_) => self.model_of(&self.progress.best_params, self.progress.best_steps),
        }
    }

    fn write_checkpoint(&self, path: &Path) -> Result<(), Error> {
        let progress = Progress { days: self.buffer.days(), ..self.progress.clone() };
        let best = [(BEST_PARAMS.to_owned(), self.progress.best_params.as_slice())];
        checkpoint::write(path, &self.identity, self.weights.params(), &self.adam, &progress, best)
    }
}

impl Progress {
    fn new(params: Vec<f32>) -> Self {
        Self {
            updates: 0,
            days_finished: 0,
            recent_rewards: Vec::new(),
            days: Vec::new(),
            best_reward: None,
            best_steps: 0,
            best_params: params,
            curve: Vec::new(),
        }
    }

    fn remember_days(&mut self, rewards: &[f64]) {
        self.days_finished += rewards.len() as u64;
        self.recent_rewards.extend(rewards);
        let surplus = self.recent_rewards.len().saturating_sub(RECENT_DAYS);
        self.recent_rewards.drain(..surplus);
    }

    fn mean_recent_reward(&self) -> Option<f64> {
        let days = self.recent_rewards.len();
        (days > 0).then(|| self.recent_rewards.iter().sum::<f64>() / days as f64)
    }

    fn keep_if_best(&mut self, reward: f64, params: &[f32], steps: u64) {
        if self.best_reward.is_none_or(|best| reward > best) {
            self.best_reward = Some(reward);
            self.best_steps = steps;
            self.best_params.copy_from_slice(params);
        }
    }
}
