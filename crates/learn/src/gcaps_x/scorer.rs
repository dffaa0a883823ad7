//! What a choice is worth: what the day's prices say, and what the network adds.
//!
//! ```text
//! worth_j = worth of j at the prices  +  logit_j * unit / 20
//! ```
//!
//! with the profit of a typical full flight as unit, and less where less is at stake ([`Scene::addition_usd`]). A network of zeros adds nothing, so it decides as `prices` does. Only
//! choices that are worth nearly as much as the best are scored: those of a [`Shortlist`].

use std::sync::Arc;

use vertifleet_core::VertiportIx;
use vertifleet_policy::Shortlist;

use crate::gcaps_x::ROLLOUTS;
use crate::gcaps_x::features::{Rows, Scene, shape};
use crate::nn::{self, Architecture, Weights, Workspace};

/// A logit of 1 is worth the unit over this.
pub(crate) const LOGITS_A_UNIT: f64 = 20.0;
/// Rows scored at once at most: one decision, or one of every roll-out of all choices.
const BATCH: usize = Shortlist::MOST * ROLLOUTS.rollouts as usize;

/// The network at one number of vertiports, and what a pass needs.
pub(crate) struct Scorer {
    net: nn::NeuralNetwork,
    weights: Arc<Weights>,
    workspace: Workspace,
    pub(crate) rows: Rows,
}

impl Scorer {
    /// # Panics
    /// If the weights are not of this architecture.
    pub(crate) fn new(
        architecture: &Architecture,
        weights: Arc<Weights>,
        vertiports: usize,
    ) -> Self {
        let net = network(architecture, vertiports);
        let workspace = net.workspace(BATCH);
        Self { net, weights, workspace, rows: Rows::new(vertiports) }
    }

    pub(crate) fn vertiports(&self) -> usize {
        self.rows.vertiports()
    }

    /// The choice of a list that is worth most, the one listed first among equals. The list comes ranked by the prices.
    pub(crate) fn best(&mut self, scene: Scene<'_>, listed: &[(f64, VertiportIx)]) -> VertiportIx {
        if let [(_, only)] = *listed {
            return only;
        }
        self.score(scene, listed);
        self.best_of_row(0, scene.addition_usd(), listed)
    }

    /// Scorers one decision, in row 0.
    pub(crate) fn score(&mut self, scene: Scene<'_>, listed: &[(f64, VertiportIx)]) {
        self.rows.clear();
        self.rows.push(scene, listed);
        self.forward();
    }

    /// Scorers all rows.
    pub(crate) fn forward(&mut self) {
        self.net.forward(&self.weights, self.rows.inputs(), &mut self.workspace);
    }

    /// The choice that is worth most in a row of the latest [`forward`](Self::forward).
    pub(crate) fn best_of_row(
        &self,
        row: usize,
        addition_usd: f64,
        listed: &[(f64, VertiportIx)],
    ) -> VertiportIx {
        let mut best = (f64::NEG_INFINITY, listed[0].1);
        for &choice in listed {
            let usd = self.worth_usd(row, addition_usd, choice);
            if usd > best.0 {
                best = (usd, choice.1);
            }
        }
        best.1
    }

    /// What a choice is worth in a row of the latest [`forward`](Self::forward), dollars.
    pub(crate) fn worth_usd(
        &self,
        row: usize,
        addition_usd: f64,
        (priced_usd, to): (f64, VertiportIx),
    ) -> f64 {
        let logit = self.workspace.logits()[row * self.vertiports() + to.at()];
        priced_usd + f64::from(logit) / LOGITS_A_UNIT * addition_usd
    }
}

/// The network for a number of vertiports. The weights are the same for all.
pub(crate) fn network(architecture: &Architecture, vertiports: usize) -> nn::NeuralNetwork {
    nn::NeuralNetwork::new(architecture.clone(), shape(vertiports)).expect(
        "sizes were checked when the weights were made, and days have at most 256 vertiports",
    )
}
