//! Checkpoints: everything a run needs to go on bit for bit, in one safetensors file.
//!
//! Randomness is a function of seed, day and decision, so there is no generator to store; a day in progress is its
//! number and the choices made on it.

use std::path::Path;

use safetensors::tensor::{Dtype, SafeTensors};
use serde::{Deserialize, Serialize};

use crate::adam::Adam;
use crate::curve::CurveRow;
use crate::error::Error;
use crate::nn::Architecture;
use crate::rollout::DayInProgress;
use crate::settings::{Settings, first_difference};
use crate::tensor_file;
use crate::train::Plan;

const FORMAT: &str = "vertifleet-checkpoint/1";
/// No checkpoint of ours comes near; larger files are not read.
const LIMIT_BYTES: u64 = 4 << 30;

/// How far a run has come.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Progress {
    pub(crate) updates: u64,
    pub(crate) days_finished: u64,
    pub(crate) recent_rewards: Vec<f64>,
    /// Filled in when a checkpoint is taken; while a run is under way the roll-out knows.
    pub(crate) days: Vec<DayInProgress>,
    pub(crate) best_reward: Option<f64>,
    pub(crate) best_steps: u64,
    #[serde(skip)]
    pub(crate) best_params: Vec<f32>,
    pub(crate) curve: Vec<CurveRow>,
}

impl Progress {
    pub(crate) fn new(params: Vec<f32>) -> Self {
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

    pub(crate) fn remember_days(&mut self, rewards: &[f64], at_most: usize) {
        self.days_finished += rewards.len() as u64;
        self.recent_rewards.extend(rewards);
        let surplus = self.recent_rewards.len().saturating_sub(at_most);
        self.recent_rewards.drain(..surplus);
    }

    pub(crate) fn mean_recent_reward(&self) -> Option<f64> {
        let days = self.recent_rewards.len();
        (days > 0).then(|| self.recent_rewards.iter().sum::<f64>() / days as f64)
    }

    pub(crate) fn keep_if_best(&mut self, reward: f64, params: &[f32], steps: u64) {
        if self.best_reward.is_none_or(|best| reward > best) {
            self.best_reward = Some(reward);
            self.best_steps = steps;
            self.best_params.copy_from_slice(params);
        }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Header {
    format: String,
    network: String,
    network_print: u32,
    policy: Architecture,
    settings: Settings,
    seed: u32,
    adam_steps: u64,
    progress: Progress,
}

/// A run set aside.
#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint {
    header: Header,
    /// Parameters, Adam's first and second moments, best parameters.
    tensors: [Vec<f32>; 4],
}

const NAMES: [&str; 4] = ["params", "adam_first", "adam_second", "best_params"];

impl Checkpoint {
    pub(crate) fn pack(
        plan: &Plan,
        network_print: u32,
        (params, adam): (&[f32], &Adam),
        mut progress: Progress,
    ) -> Self {
        let best = std::mem::take(&mut progress.best_params);
        let header = Header {
            format: FORMAT.to_owned(),
            network: plan.network.name().to_owned(),
            network_print,
            policy: plan.policy.clone(),
            settings: plan.settings.clone(),
            seed: plan.seed,
            adam_steps: adam.steps,
            progress,
        };
        let tensors = [params.to_vec(), adam.first.clone(), adam.second.clone(), best];
        Self { header, tensors }
    }

    pub(crate) fn unpack(
        self,
        plan: &Plan,
        plan_print: u32,
        parameters: usize,
    ) -> Result<(Vec<f32>, Adam, Progress), Error> {
        let Header {
            network, network_print, policy, settings, seed, adam_steps, mut progress, ..
        } = self.header;
        let of_another = |what: &str, found: String, asked: String| {
            let rule = format!("it is of a run with {what} {found}, but {asked} is asked for");
            Err(Error::BadCheckpoint { rule })
        };
        if network != plan.network.name() {
            return of_another("network", network, plan.network.name().to_owned());
        }
        if network_print != plan_print {
            let rule = format!("network {network:?} has changed since the run was started");
            return Err(Error::BadCheckpoint { rule });
        }
        if policy != plan.policy {
            return of_another("policy", format!("{policy:?}"), format!("{:?}", plan.policy));
        }
        if seed != plan.seed {
            return of_another("seed", seed.to_string(), plan.seed.to_string());
        }
        if let Some((name, found, asked)) = first_difference(&settings, &plan.settings) {
            return of_another(&format!("setting {name}"), found, asked);
        }
        if self.tensors.iter().any(|tensor| tensor.len() != parameters) {
            let rule = format!("every tensor must have {parameters} entries");
            return Err(Error::BadCheckpoint { rule });
        }
        if self.tensors.iter().flatten().any(|entry| !entry.is_finite()) {
            return Err(Error::BadCheckpoint {
                rule: "a weight is not a finite number".to_owned(),
            });
        }
        if progress.updates > plan.settings.updates() {
            let rule = format!("{} updates are more than the run has", progress.updates);
            return Err(Error::BadCheckpoint { rule });
        }
        let [params, first, second, best_params] = self.tensors;
        progress.best_params = best_params;
        Ok((params, Adam { first, second, steps: adam_steps }, progress))
    }

    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// If the folder cannot be written to.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let tensors = NAMES.iter().zip(&self.tensors);
        let tensors =
            tensors.map(|(name, entries)| (*name, vec![entries.len()], entries.as_slice()));
        let bytes = tensor_file::to_bytes(&self.header, tensors);
        Ok(vertifleet_core::write_atomically(path, &bytes)?)
    }

    /// Reads a checkpoint.
    ///
    /// # Errors
    /// If the file cannot be read or is no checkpoint.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let bytes = vertifleet_core::read_at_most(path, LIMIT_BYTES)?;
        Self::from_bytes(&bytes).map_err(|rule| Error::BadCheckpoint { rule })
    }

    fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        let header: Header = tensor_file::header(bytes, FORMAT, |header: &Header| &header.format)?;
        header.settings.check().map_err(|error| error.to_string())?;
        let file = SafeTensors::deserialize(bytes).map_err(|error| error.to_string())?;
        let mut tensors: [Vec<f32>; 4] = Default::default();
        for (name, values) in NAMES.iter().zip(&mut tensors) {
            let view = file.tensor(name).map_err(|error| error.to_string())?;
            if view.dtype() != Dtype::F32 {
                return Err(format!("tensor {name:?} must be F32"));
            }
            *values = tensor_file::entries(&view).collect();
        }
        Ok(Self { header, tensors })
    }
}
