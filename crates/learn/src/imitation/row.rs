//! A row of imitation's learning curve.

use serde::{Deserialize, Serialize};

/// One round.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImitationRow {
    /// Number of rounds done.
    pub round: u32,
    /// Number of decisions learned from so far.
    pub decisions: u64,
    /// Share of decisions in the last pass for which the network's best choice is the expert's.
    pub agreement: f64,
    /// Advantage of the network's choices over those at the prices, by the expert's values, in
    /// units.
    pub lift: f64,
    /// Advantage of the expert's choices over those at the prices, in the same units.
    pub most_lift: f64,
    /// Mean reward on the network's validation days.
    pub validation_reward: f64,
    /// Profit above that of `prices` on the network's validation days, as a share of the profit of
    /// `prices`.
    pub gain: f64,
    /// The same gain on the validation days of random networks, if the weights fit networks of any
    /// size.
    pub random_gain: Option<f64>,
}
