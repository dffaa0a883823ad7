//! A trained network of layers as a policy: it chooses the feasible vertiport with the highest
//! logit (§IV.B, greedy decoding).

use vertifleet_core::VertiportIx;
use vertifleet_policy::{Policy, PolicyError};
use vertifleet_sim::{Decision, View};

use crate::features::{Observations, Scales};
use crate::model::Model;
use crate::nn::{self, Weights, Workspace};

/// Decisions per inference; larger batches are not faster.
const BATCH: usize = 256;

/// Decides by a trained network. It is deterministic: among equal logits the first vertiport wins.
pub struct Learned {
    net: nn::NeuralNetwork,
    scales: Scales,
    weights: Weights,
    workspace: Workspace,
    observations: Observations,
}

impl Learned {
    /// The policy of a model.
    ///
    /// # Panics
    /// Panics if the model is not of `gcaps` or `mlp`.
    pub fn new(model: &Model) -> Self {
        let header = model.header();
        let vertiports = header.shape.vertiports.expect("weights of one number of vertiports");
        let scales = header.feature_scales.expect("a header is checked when it is read");
        Self::of(model.net(vertiports), model.weights(), Scales::from(scales))
    }

    pub(crate) fn of(net: nn::NeuralNetwork, weights: Weights, scales: Scales) -> Self {
        Self {
            scales,
            weights,
            workspace: net.workspace(BATCH),
            observations: Observations::new(net.shape(), BATCH),
            net,
        }
    }

    /// Chooses for the first `batch` rows of the observations.
    fn infer(&mut self, batch: usize) -> impl Iterator<Item = VertiportIx> {
        let inputs = self.observations.inputs(batch);
        self.net.forward(&self.weights, inputs, &mut self.workspace);
        self.workspace.logits().chunks_exact(self.net.shape().vertiports).map(highest)
    }
}

impl Policy for Learned {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        self.observations.write(0, decision, view, &self.scales);
        Ok(self.infer(1).next().expect("one choice for one decision"))
    }

    /// Logits.
    fn values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<(), PolicyError> {
        self.choose_with_values(decision, view, values).map(|_| ())
    }

    fn choose_with_values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<VertiportIx, PolicyError> {
        let choice = self.choose(decision, view)?;
        values.fill(f64::NAN);
        let feasible = view.feasible(decision);
        for (at, &logit) in self.workspace.logits()[..values.len()].iter().enumerate() {
            if feasible.contains(VertiportIx::new(at)) {
                values[at] = f64::from(logit);
            }
        }
        Ok(choice)
    }

    fn choose_batch(
        &mut self,
        asked: &mut dyn Iterator<Item = (Decision, View<'_>)>,
        choices: &mut Vec<VertiportIx>,
    ) -> Result<(), PolicyError> {
        loop {
            let mut batch = 0;
            for (decision, view) in asked.take(BATCH) {
                self.observations.write(batch, &decision, &view, &self.scales);
                batch += 1;
            }
            if batch == 0 {
                return Ok(());
            }
            choices.extend(self.infer(batch));
        }
    }
}

/// The vertiport with the highest logit, the first among equals.
pub(crate) fn highest(logits: &[f32]) -> VertiportIx {
    let mut best = 0;
    for (at, logit) in logits.iter().enumerate() {
        if *logit > logits[best] {
            best = at;
        }
    }
    VertiportIx::new(best)
}
