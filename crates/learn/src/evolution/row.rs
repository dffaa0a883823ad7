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
    /// The effect of the perturbations: the root mean square, over the pairs, of the difference
    /// between the days of weights moved along a direction and those of weights moved against it.
    /// It is a share of the profit of these days.
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
