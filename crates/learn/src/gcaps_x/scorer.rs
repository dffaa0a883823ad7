//! The worth of a choice: what the day's prices say, and what the network adds.
//!
//! ```text
//! worth_j = worth of j at the prices  +  logit_j * unit / 20
//! ```
//!
//! where the unit is the profit of a typical full flight, or less if the decision has less at stake
//! ([`Scene::addition_usd`]). A network of zeros adds nothing, so it decides as `prices` does. Only
//! the choices of a [`Shortlist`] are scored, which are worth nearly as much as the best.

use std::sync::Arc;

use vertifleet_core::VertiportIx;
use vertifleet_policy::{PricedChoice, Shortlist};

use crate::gcaps_x::features::{Scene, Writer, shape};
use crate::header::network;
use crate::nn::{self, Architecture, Weights, Workspace};
use crate::rollouts::{MOST_ROWS, Scores};
use crate::rows::Rows;

/// A logit of 1 is worth the unit divided by this.
pub(crate) const LOGITS_A_UNIT: f64 = 20.0;

/// The network for one number of vertiports, with the workspace of its passes.
pub(crate) struct Scorer {
    net: nn::NeuralNetwork,
    weights: Arc<Weights>,
    workspace: Workspace,
    writer: Writer,
    rows: Rows,
    /// The lists of roll-outs.
    shortlist: Shortlist,
}

impl Scorer {
    /// # Panics
    /// Panics if the weights are not of this architecture.
    pub(crate) fn new(
        architecture: &Architecture,
        weights: Arc<Weights>,
        vertiports: usize,
    ) -> Self {
        let net = network(architecture, vertiports);
        let workspace = net.workspace(MOST_ROWS);
        let rows = Rows::new(shape(vertiports), false);
        Self {
            net,
            weights,
            workspace,
            writer: Writer::default(),
            rows,
            shortlist: Shortlist::default(),
        }
    }

    pub(crate) fn vertiports(&self) -> usize {
        self.rows.vertiports()
    }

    /// The choice of a list with the highest worth, the first of them if several are equal. The
    /// list is ranked by the prices.
    pub(crate) fn best(&mut self, scene: Scene<'_>, listed: &[PricedChoice]) -> VertiportIx {
        if let [only] = listed {
            return only.to;
        }
        self.score(scene, listed);
        self.best_of_first_row(scene.addition_usd(), listed)
    }

    /// Scores one decision, in row 0.
    pub(crate) fn score(&mut self, scene: Scene<'_>, listed: &[PricedChoice]) {
        self.rows.clear();
        self.push(scene, listed);
        self.forward();
    }

    /// The choice with the highest worth in row 0.
    fn best_of_first_row(&self, addition_usd: f64, listed: &[PricedChoice]) -> VertiportIx {
        let scored = listed.iter().map(|&choice| self.scored(0, addition_usd, choice));
        PricedChoice::best(scored).unwrap_or(listed[0].to)
    }

    /// A choice with its worth in a row of the latest [`forward`](Scores::forward).
    pub(crate) fn scored(
        &self,
        row: usize,
        addition_usd: f64,
        PricedChoice { worth_usd, to }: PricedChoice,
    ) -> PricedChoice {
        let logit = self.workspace.logits()[row * self.vertiports() + to.at()];
        PricedChoice { worth_usd: worth_usd + f64::from(logit) / LOGITS_A_UNIT * addition_usd, to }
    }
}

impl Scores for Scorer {
    fn list(&mut self, scene: Scene<'_>, listed: &mut Vec<PricedChoice>) {
        listed.clear();
        listed.extend(self.shortlist.rank(scene.prices, scene.view, scene.decision));
    }

    fn clear(&mut self, _vertiports: usize) {
        self.rows.clear();
    }

    fn push(&mut self, scene: Scene<'_>, listed: &[PricedChoice]) {
        self.writer.push(scene, listed, &mut self.rows);
    }

    fn forward(&mut self) {
        self.net.forward(&self.weights, self.rows.inputs(), &mut self.workspace);
    }

    fn rate(&self, row: usize, scene: Scene<'_>, listed: &mut [PricedChoice]) {
        let addition_usd = scene.addition_usd();
        for choice in listed {
            *choice = self.scored(row, addition_usd, *choice);
        }
    }
}
