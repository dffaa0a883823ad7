//! A row of evolution's learning curve.

use serde::{Deserialize, Serialize};

/// One generation.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EvolutionRow {
    /// Number of generations done.
    pub generation: u32,
    /// Number of decisions taken on training days so far.
    pub decisions: u64,
    /// By how much the days of weights moved along a direction differ from those of weights moved
    /// against it: the root of the mean square over the pairs, as a share of what these days earn.
    pub difference: f64,
    /// Mean reward on the network's validation days, if it was measured after this generation.
    pub validation_reward: Option<f64>,
    /// Profit above that of `prices` on the network's validation days, as a share of the profit of
    /// `prices`.
    pub gain: Option<f64>,
    /// The same gain on the validation days of random networks, if the weights fit networks of any
    /// size.
    pub random_gain: Option<f64>,
}
