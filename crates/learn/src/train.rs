//! A training run: roll out, update, look at the validation days, keep the best weights; stop and go on at will.
//!
//! Training days, validation days and the days people compare on come from disjoint ranges of seeds (`DaySeed`), so no
//! run can ever learn or choose on a day it is later judged by.

use std::sync::Arc;

use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use vertifleet_core::{DaySeed, Network, Scenario};
use vertifleet_policy::Policy;
use vertifleet_sim::Simulation;

use crate::adam::Adam;
use crate::checkpoint::{Checkpoint, Progress};
use crate::curve::CurveRow;
use crate::error::Error;
use crate::features::shape;
use crate::learned::Learned;
use crate::nn::{self, Architecture, Prepared};
use crate::ppo::Ppo;
use crate::rollout::{Rollout, Source};
use crate::settings::Settings;
use crate::weights::{Model, Origin};

/// Days whose rewards the curve averages, as in stable-baselines3.
const RECENT_DAYS: usize = 100;
/// Validation days that share one inference.
const VALIDATION_BLOCK: usize = 16;

/// What a training run is asked to do.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Network whose days are learned from.
    pub network: Arc<Network>,
    /// The policy's kind and sizes.
    pub policy: Architecture,
    /// Settings of the run.
    pub settings: Settings,
    /// Seed of the run: weights, days and choices follow from it.
    pub seed: u32,
    /// Commit of the program, for the weights' header.
    pub commit: String,
}

/// A run under way.
pub struct Training {
    plan: Plan,
    net: nn::Network,
    params: Vec<f32>,
    prepared: Prepared,
    adam: Adam,
    ppo: Ppo,
    rollout: Rollout,
    validation: Vec<Arc<Scenario>>,
    progress: Progress,
    /// What [`network_print`] says; a checkpoint remembers it.
    network_print: u32,
}

impl Training {
    /// A run before its first roll-out.
    ///
    /// # Errors
    /// If the policy's sizes do not fit together or the seed is out of range.
    pub fn start(plan: Plan) -> Result<Self, Error> {
        let net = plan.net()?;
        let params = net.init(u64::from(plan.seed));
        let adam = Adam::new(params.len());
        let progress = Progress::new(params.clone());
        Self::assemble(plan, net, (params, adam), progress, true)
    }

    /// A run that goes on from a checkpoint, bit for bit as if it had never stopped.
    ///
    /// # Errors
    /// If the checkpoint is damaged or of another run.
    pub fn resume(plan: Plan, checkpoint: Checkpoint) -> Result<Self, Error> {
        let net = plan.net()?;
        let (params, adam, progress) =
            checkpoint.unpack(&plan, network_print(&plan.network)?, net.layout().len())?;
        Self::assemble(plan, net, (params, adam), progress, false)
    }

    fn assemble(
        plan: Plan,
        net: nn::Network,
        (params, adam): (Vec<f32>, Adam),
        mut progress: Progress,
        fresh: bool,
    ) -> Result<Self, Error> {
        let source = Source { network: Arc::clone(&plan.network), run_seed: plan.seed };
        let days = (!fresh).then(|| std::mem::take(&mut progress.days));
        let rollout = Rollout::new(source, &net, &plan.settings, days)?;
        let validation = (0..u64::from(plan.settings.eval_days))
            .map(|day| Ok(Arc::new(plan.network.draw(DaySeed::validation(day)?))))
            .collect::<Result<Vec<_>, Error>>()?;
        let mut prepared = net.prepared();
        net.prepare(&params, &mut prepared);
        let ppo = Ppo::new(&net, plan.network.vertiports().len(), &plan.settings);
        let network_print = network_print(&plan.network)?;
        Ok(Self {
            plan,
            net,
            params,
            prepared,
            adam,
            ppo,
            rollout,
            validation,
            progress,
            network_print,
        })
    }

    /// The run's settings.
    pub fn settings(&self) -> &Settings {
        &self.plan.settings
    }

    /// Whether every step asked for has been learned from.
    pub fn is_done(&self) -> bool {
        self.progress.updates >= self.plan.settings.updates()
    }

    /// One roll-out and one update. Returns the new row of the curve.
    ///
    /// `go_on` is told the share of the update that is done, again and again; `false` abandons the update, and nothing
    /// is returned. What was learned in it is lost then: go on from a [`checkpoint`](Self::checkpoint) taken before.
    ///
    /// # Errors
    /// If training days run out, or the weights have left the numbers ([`Error::Diverged`]).
    pub fn update(&mut self, go_on: &dyn Fn(f64) -> bool) -> Result<Option<CurveRow>, Error> {
        let finished = self.rollout.collect(&self.net, &self.params, &self.prepared)?;
        self.progress.remember_days(&finished, RECENT_DAYS);
        let settings = &self.plan.settings;
        let update = self.progress.updates;
        let learning_rate = settings.learning_rate_at(update);
        let losses = self.ppo.update(
            &self.net,
            &self.rollout,
            (&mut self.params, &mut self.adam, &mut self.prepared),
            // Distinct for every update of every seed.
            u64::from(self.plan.seed) << 32 | update,
            learning_rate,
            go_on,
        );
        let Some(losses) = losses else { return Ok(None) };
        check_finite(&self.params, update + 1)?;
        self.progress.updates += 1;
        let steps = self.progress.updates * settings.buffer_size() as u64;
        let looks = self.progress.updates.is_multiple_of(u64::from(settings.eval_every));
        let validation_reward = (looks || self.is_done()).then(|| self.validation_reward());
        if let Some(reward) = validation_reward {
            self.progress.keep_if_best(reward, &self.params, steps);
        }
        let row = CurveRow {
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
        };
        self.progress.curve.push(row);
        Ok(Some(row))
    }

    /// Mean reward on the validation days, best choices only.
    fn validation_reward(&self) -> f64 {
        let model = Arc::new(self.model_of(self.params.clone(), 0));
        let blocks: Vec<&[Arc<Scenario>]> = self.validation.chunks(VALIDATION_BLOCK).collect();
        let rewards = blocks
            .par_iter()
            .map(|block| play_block(&mut Learned::new(Arc::clone(&model)), block))
            .collect::<Vec<_>>();
        rewards.iter().flatten().sum::<f64>() / self.validation.len() as f64
    }

    /// The weights that did best on the validation days so far; before the first look at them, the latest weights.
    pub fn best_model(&self) -> Model {
        if self.progress.best_reward.is_none() {
            let steps = self.progress.updates * self.plan.settings.buffer_size() as u64;
            return self.model_of(self.params.clone(), steps);
        }
        self.model_of(self.progress.best_params.clone(), self.progress.best_steps)
    }

    /// Mean reward of the weights kept on the validation days; none before they were looked at.
    pub fn best_validation_reward(&self) -> Option<f64> {
        self.progress.best_reward
    }

    fn model_of(&self, params: Vec<f32>, steps: u64) -> Model {
        let origin = Origin {
            network: self.plan.network.name().to_owned(),
            feature_scales: self.plan.network.feature_scales(),
            settings: self.plan.settings.clone(),
            seed: self.plan.seed,
            commit: self.plan.commit.clone(),
        };
        Model::new(self.net.clone(), params, origin, steps)
    }

    /// The learning curve so far.
    pub fn curve(&self) -> &[CurveRow] {
        &self.progress.curve
    }

    /// Everything that [`resume`](Self::resume) needs.
    pub fn checkpoint(&self) -> Checkpoint {
        let progress = Progress { days: self.rollout.progress(), ..self.progress.clone() };
        Checkpoint::pack(&self.plan, self.network_print, (&self.params, &self.adam), progress)
    }
}

impl Plan {
    fn net(&self) -> Result<nn::Network, Error> {
        nn::Network::new(self.policy.clone(), shape(self.network.vertiports().len()))
            .map_err(|rule| Error::BadSetting { name: "policy".to_owned(), rule })
    }
}

/// A number that changes when the network's days do: the checksum of one of them, and of the feature scales.
pub(crate) fn network_print(network: &Network) -> Result<u32, Error> {
    let day = network.draw(DaySeed::validation(0)?);
    let scales = serde_json::to_string(&network.feature_scales()).expect("numbers");
    Ok(crc32c::crc32c_append(crc32c::crc32c(day.to_json().as_bytes()), scales.as_bytes()))
}

/// Plays days in lockstep, one inference for all of them; rewards in the order of the days.
fn play_block(policy: &mut Learned, days: &[Arc<Scenario>]) -> Vec<f64> {
    let mut simulations: Vec<Simulation> =
        days.iter().map(|day| Simulation::new(Arc::clone(day))).collect();
    let mut open = Vec::with_capacity(days.len());
    let mut choices = Vec::with_capacity(days.len());
    loop {
        open.clear();
        open.extend(
            simulations
                .iter_mut()
                .enumerate()
                .filter_map(|(at, day)| day.next_decision().map(|decision| (at, decision))),
        );
        if open.is_empty() {
            return simulations.iter().map(|day| day.summary().reward).collect();
        }
        choices.clear();
        let mut asked = open.iter().map(|&(at, decision)| (decision, simulations[at].view()));
        policy
            .choose_batch(&mut asked, &mut choices)
            .expect("a trained network always has an answer");
        for (&(at, _), &choice) in open.iter().zip(&choices) {
            simulations[at].apply(choice).expect("a trained network chooses from the mask");
        }
    }
}

/// Refuses weights that have left the numbers in an update, counted from 1.
pub(crate) fn check_finite(params: &[f32], update: u64) -> Result<(), Error> {
    if params.iter().all(|weight| weight.is_finite()) {
        return Ok(());
    }
    Err(Error::Diverged { update })
}

#[cfg(test)]
mod tests {
    use super::check_finite;

    #[test]
    fn a_run_that_diverges_says_so() {
        check_finite(&[1.0, -2.0], 3).expect("numbers");
        for lost in [f32::NAN, f32::INFINITY] {
            let error = check_finite(&[1.0, lost], 3).expect_err("no number");
            assert_eq!(error.code().to_string(), "V309");
        }
    }
}
