//! The settings of a `gcaps-x` run.

use serde::{Deserialize, Serialize};
use vertifleet_policy::TryOut;

use crate::error::Error;
use crate::settings::{with_member, within};

/// What a run learns from, and how.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// Rounds of playing and learning.
    pub rounds: u32,
    /// Days played a round.
    pub days: u32,
    /// Share of the days that are of random networks.
    pub random_share: f64,
    /// Passes over all lessons so far, a round.
    pub passes: u32,
    /// Adam's step size; falls in a straight line to a tenth over the run.
    pub learning_rate: f32,
    /// Weight of the entropy in the loss.
    pub entropy_weight: f32,
    /// Share of decisions that are drawn from the list at random while lessons are collected.
    pub exploration: f64,
    /// How choices are tried out.
    #[serde(flatten)]
    pub expert: TryOut,
    /// Validation days of the network, and as many of random networks.
    pub validation_days: u32,
}

impl Default for Course {
    /// Tuned on validation days.
    fn default() -> Self {
        Self {
            rounds: 4,
            days: 120,
            random_share: 0.4,
            passes: 12,
            learning_rate: 1e-3,
            entropy_weight: 1.0,
            exploration: 0.05,
            expert: TryOut { horizon_s: 7_200, courses: 8, noise: 0.06, own: 0.5 },
            validation_days: 12,
        }
    }
}

impl Course {
    /// Changes settings by their names, as `--set name=value` does; all of them, or none if one does not fit.
    ///
    /// # Errors
    /// If there is no such setting, or a value does not fit it.
    pub fn set<'a>(
        &mut self,
        pairs: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<(), Error> {
        let mut changed = self.clone();
        for (name, value) in pairs {
            changed = with_member(&changed, name, value)?;
        }
        changed.check()?;
        *self = changed;
        Ok(())
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        within("rounds", f64::from(self.rounds), 1.0, 10_000.0)?;
        within("days", f64::from(self.days), 1.0, 100_000.0)?;
        within("random_share", self.random_share, 0.0, 1.0)?;
        within("passes", f64::from(self.passes), 1.0, 10_000.0)?;
        within("learning_rate", f64::from(self.learning_rate), 0.0, 1.0)?;
        within("entropy_weight", f64::from(self.entropy_weight), 0.0, 100.0)?;
        within("exploration", self.exploration, 0.0, 1.0)?;
        within("horizon_s", f64::from(self.expert.horizon_s), 0.0, 86_400.0)?;
        within("courses", f64::from(self.expert.courses), 1.0, 10_000.0)?;
        within("noise", self.expert.noise, 0.0, 100.0)?;
        within("own", self.expert.own, 0.0, 100.0)?;
        within("validation_days", f64::from(self.validation_days), 1.0, 100_000.0)
    }
}
