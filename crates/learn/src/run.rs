//! A training run: what is asked for, how it goes on, and what it leaves.
//!
//! There are two ways to learn, [PPO](crate::ppo) for policies of one network and [imitation](crate::imitation) for `gcaps-x`. To
//! those who start a run they are one: a [`TrainingRun`] that is advanced until it is done, and that can be set aside and resumed.
//! A [`RunFolder`] does so and keeps its files.
//!
//! Training days, validation days and the days people compare on come from disjoint ranges of seeds (`DaySeed`), so no run can
//! ever learn or choose on a day it is later judged by.

pub(crate) mod checkpoint;
mod curve;
mod event_file;
mod folder;

use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use vertifleet_core::{DaySeed, Network, Stop};

pub use curve::Curve;
pub use folder::{RunFolder, TrainingWatch};

use crate::error::Error;
use crate::imitation::ImitationRun;
use crate::model::Model;
use crate::nn::Architecture;
use crate::ppo::PpoRun;
use crate::settings::TrainingSettings;

/// What a training run is asked to do.
#[derive(Debug, Clone)]
pub struct TrainingPlan {
    /// Network whose days are learned from; by imitation, beside days of random networks.
    pub network: Arc<Network>,
    /// The policy's kind and sizes.
    pub policy: Architecture,
    /// Settings of the way in which such a policy learns.
    pub settings: TrainingSettings,
    /// Seed of the run: first weights, days and choices follow from it.
    pub seed: u32,
    /// Commit of the program, for the weights' header.
    pub commit: String,
}

/// A run under way. It is advanced by an update of PPO or by a round of imitation at a time.
pub trait TrainingRun: Send {
    /// Whether all that was asked for has been learned.
    fn is_done(&self) -> bool;

    /// How much of the work is done.
    fn work(&self) -> Work;

    /// Learns a little more, and adds a row to the curve. `worked` is told of every so many units of work as they are done.
    ///
    /// # Errors
    /// [`Error::Stopped`] soon after `stop` is requested, [`Error::Diverged`] if a weight is infinite or no number, or if training
    /// days run out. After a stop the run stands as it did before.
    fn advance(&mut self, stop: &Stop, worked: &(dyn Fn(u64) + Sync)) -> Result<(), Error>;

    /// The learning curve so far.
    fn curve(&self) -> Curve;

    /// The policy as it would be kept now: of PPO, the weights that did best on the validation days so far.
    fn model(&self) -> Model;

    /// Sets the run aside, the file whole or not at all.
    ///
    /// # Errors
    /// If the file cannot be written.
    fn write_checkpoint(&self, path: &Path) -> Result<(), Error>;
}

/// How much of a run's work is done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Work {
    /// Units done.
    pub done: u64,
    /// Units of the whole run.
    pub total: u64,
    /// What the units are.
    pub units: &'static str,
}

impl TrainingPlan {
    /// A run before its first step.
    ///
    /// # Errors
    /// If settings and policy do not go together, a setting is out of its bounds, the policy's sizes do not fit, or the seed is out
    /// of range.
    pub fn start(self) -> Result<Box<dyn TrainingRun>, Error> {
        self.begin(None)
    }

    /// A run that goes on from a checkpoint, bit for bit as if it had never stopped.
    ///
    /// # Errors
    /// As [`start`](Self::start), or if the checkpoint cannot be read, is damaged or of another run.
    pub fn resume(self, checkpoint: &Path) -> Result<Box<dyn TrainingRun>, Error> {
        self.begin(Some(checkpoint))
    }

    fn begin(self, checkpoint: Option<&Path>) -> Result<Box<dyn TrainingRun>, Error> {
        self.settings.check()?;
        let asked = RunIdentity {
            network: self.network.name().to_owned(),
            network_fingerprint: network_fingerprint(&self.network)?,
            policy: self.policy.clone(),
            settings: self.settings.clone(),
            seed: self.seed,
        };
        Ok(match (&self.policy, &self.settings) {
            (Architecture::GcapsX(_), TrainingSettings::Imitation(settings)) => {
                Box::new(ImitationRun::new(&self, asked, settings.clone(), checkpoint)?)
            }
            (Architecture::Gcaps(_) | Architecture::Mlp(_), TrainingSettings::Ppo(settings)) => {
                Box::new(PpoRun::new(&self, asked, settings.clone(), checkpoint)?)
            }
            (policy, _) => {
                let rule = format!("{} does not learn with these settings", policy.name());
                return Err(Error::BadSetting { name: "policy".to_owned(), rule });
            }
        })
    }
}

/// What makes a run the run that it is: a checkpoint goes on only where all of this is the same.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RunIdentity {
    pub(crate) network: String,
    /// Changes when the network's days do.
    pub(crate) network_fingerprint: u32,
    pub(crate) policy: Architecture,
    pub(crate) settings: TrainingSettings,
    pub(crate) seed: u32,
}

/// A number that changes when the network's days do: the checksum of one of them, and of the feature scales.
fn network_fingerprint(network: &Network) -> Result<u32, Error> {
    let day = network.draw(DaySeed::validation(0)?);
    let scales = serde_json::to_string(&network.feature_scales()).expect("numbers");
    Ok(crc32c::crc32c_append(crc32c::crc32c(day.to_json().as_bytes()), scales.as_bytes()))
}

/// Refuses weights of which one is infinite or no number after an update, counted from 1.
pub(crate) fn check_finite(params: &[f32], update: u64) -> Result<(), Error> {
    if params.iter().all(|weight| weight.is_finite()) {
        return Ok(());
    }
    Err(Error::Diverged { update })
}

#[cfg(test)]
mod tests {
    use super::check_finite;
    use vertifleet_core::Coded;

    #[test]
    fn a_run_that_diverges_says_so() {
        check_finite(&[1.0, -2.0], 3).expect("numbers");
        for lost in [f32::NAN, f32::INFINITY] {
            let error = check_finite(&[1.0, lost], 3).expect_err("no number");
            assert_eq!(error.code().to_string(), "V309");
        }
    }
}
