//! The settings of a training by imitation.

use serde::{Deserialize, Serialize};
use vertifleet_policy::RolloutSettings;

use crate::error::Error;
use crate::rollouts::ROLLOUTS;
use crate::settings::within;

/// The samples of a run, and how it learns from them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImitationSettings {
    /// Number of rounds of playing and learning.
    pub rounds: u32,
    /// Number of days played in a round.
    pub days: u32,
    /// Share of the days that come from random networks.
    pub random_share: f64,
    /// Approximate number of decisions that are rolled out on a day; on a day with more decisions,
    /// a random share of them is.
    #[serde(default = "usual_samples")]
    pub samples: u32,
    /// Number of rounds at the end in which the policy, and not the prices, decides in the
    /// roll-outs.
    #[serde(default)]
    pub own_rounds: u32,
    /// Number of passes over all samples so far in a round.
    pub passes: u32,
    /// The run returns a weighted mean of its initial and its learned weights; this is the share of
    /// the initial ones. It preserves the abilities of the initial weights (M. Wortsman and others,
    /// *Robust fine-tuning of zero-shot models*, 2022).
    #[serde(default)]
    pub kept: f64,
    /// Adam's step size; it falls in a straight line to a tenth over the run.
    pub learning_rate: f32,
    /// Weight of the entropy in the loss.
    pub entropy_weight: f32,
    /// Share of decisions that are taken at random from the shortlist while samples are collected.
    pub exploration: f64,
    /// How the expert rolls choices out.
    #[serde(flatten)]
    pub expert: RolloutSettings,
    /// Number of validation days of the network, and also of random networks.
    pub validation_days: u32,
}

/// The number of decisions that were rolled out before it was a setting.
fn usual_samples() -> u32 {
    400
}

impl Default for ImitationSettings {
    /// These values were tuned on validation days.
    fn default() -> Self {
        Self {
            rounds: 4,
            days: 120,
            random_share: 0.4,
            samples: usual_samples(),
            own_rounds: 0,
            passes: 12,
            kept: 0.0,
            learning_rate: 1e-3,
            entropy_weight: 1.0,
            exploration: 0.05,
            expert: ROLLOUTS,
            validation_days: 12,
        }
    }
}

impl ImitationSettings {
    pub(crate) fn check(&self) -> Result<(), Error> {
        within("rounds", f64::from(self.rounds), 1.0, 10_000.0)?;
        within("days", f64::from(self.days), 1.0, 100_000.0)?;
        within("random_share", self.random_share, 0.0, 1.0)?;
        within("own_rounds", f64::from(self.own_rounds), 0.0, 10_000.0)?;
        within("samples", f64::from(self.samples), 1.0, 1_000_000.0)?;
        within("passes", f64::from(self.passes), 1.0, 10_000.0)?;
        within("kept", self.kept, 0.0, 1.0)?;
        within("learning_rate", f64::from(self.learning_rate), 0.0, 1.0)?;
        within("entropy_weight", f64::from(self.entropy_weight), 0.0, 100.0)?;
        within("exploration", self.exploration, 0.0, 1.0)?;
        within("horizon_s", f64::from(self.expert.horizon_s), 0.0, 86_400.0)?;
        within("rollouts", f64::from(self.expert.rollouts), 1.0, 10_000.0)?;
        within("noise", self.expert.noise, 0.0, 100.0)?;
        within("price_weight", self.expert.price_weight, 0.0, 100.0)?;
        within("validation_days", f64::from(self.validation_days), 1.0, 100_000.0)
    }
}
