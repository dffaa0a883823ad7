//! The settings of a training by evolution.

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::settings::within;

/// The days of a run, and its length.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EvolutionSettings {
    /// Number of generations.
    pub generations: u32,
    /// Number of random directions in a generation; weights are moved along each and against it.
    pub pairs: u32,
    /// Number of days in a generation; all its weights play the same days.
    pub days: u32,
    /// Share of the days that come from random networks.
    pub random_share: f64,
    /// The size of the perturbation of each weight.
    pub noise: f32,
    /// Adam's step size; it falls in a straight line to a tenth over the run.
    pub learning_rate: f32,
    /// Number of generations between two measurements on the validation days.
    pub eval_every: u32,
    /// Number of validation days of the network, and also of random networks.
    pub validation_days: u32,
}

impl Default for EvolutionSettings {
    /// Noise and step size are the best of three pairs on validation days.
    fn default() -> Self {
        Self {
            generations: 100,
            pairs: 16,
            days: 24,
            random_share: 0.4,
            noise: 0.01,
            learning_rate: 1e-3,
            eval_every: 10,
            validation_days: 100,
        }
    }
}

impl EvolutionSettings {
    pub(crate) fn check(&self) -> Result<(), Error> {
        within("generations", f64::from(self.generations), 1.0, 1_000_000.0)?;
        within("pairs", f64::from(self.pairs), 1.0, 10_000.0)?;
        within("days", f64::from(self.days), 1.0, 100_000.0)?;
        within("random_share", self.random_share, 0.0, 1.0)?;
        within("noise", f64::from(self.noise), 1e-6, 10.0)?;
        within("learning_rate", f64::from(self.learning_rate), 0.0, 1.0)?;
        within("eval_every", f64::from(self.eval_every), 1.0, 1_000_000.0)?;
        within("validation_days", f64::from(self.validation_days), 1.0, 100_000.0)
    }
}
