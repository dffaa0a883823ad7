//! A row of imitation's learning curve.

use serde::{Deserialize, Serialize};

/// One round.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImitationRow {
    /// Rounds done.
    pub round: u32,
    /// Decisions learned from so far.
    pub decisions: u64,
    /// Share of decisions whose best choice is the expert's, in the last pass.
    pub agreement: f64,
    /// By how much choices are better than those at the prices, by the expert's values, in units.
    pub lift: f64,
    /// By how much the expert's choices are.
    pub most_lift: f64,
    /// Mean reward on the network's validation days.
    pub validation_reward: f64,
    /// Profit over that of `prices`, as a share of it, on the network's validation days.
    pub gain: f64,
    /// The same on random networks.
    pub random_gain: f64,
}

impl ImitationRow {
    /// What was measured, as TensorBoard is told.
    pub(crate) fn scalars(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("eval/mean_reward", self.validation_reward),
            ("eval/gain", self.gain),
            ("eval/random_gain", self.random_gain),
            ("train/agreement", self.agreement),
            ("train/lift", self.lift),
        ]
    }
}
