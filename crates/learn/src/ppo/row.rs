//! A row of PPO's learning curve.

use serde::{Deserialize, Serialize};

/// One update.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PpoRow {
    /// Number of updates done.
    pub update: u64,
    /// Number of decisions learned from.
    pub steps: u64,
    /// Number of days finished.
    pub days: u64,
    /// Mean reward of the last 100 days finished, with choices drawn from the policy; `None` before
    /// the first day is over.
    pub mean_reward: Option<f64>,
    /// Mean reward on the validation days, with the best choices only, if it was measured after
    /// this update.
    pub validation_reward: Option<f64>,
    /// Mean clipped surrogate loss of the last epoch.
    pub policy_loss: f64,
    /// Mean squared error of the values in the last epoch, in scaled rewards.
    pub value_loss: f64,
    /// Mean entropy of the policy in the last epoch, nats.
    pub entropy: f64,
    /// Mean estimate of the Kullback-Leibler divergence in the last epoch.
    pub approx_kl: f64,
    /// Share of decisions in the last epoch whose probability ratio was clipped.
    pub clip_fraction: f64,
    /// Adam's step size.
    pub learning_rate: f64,
}
