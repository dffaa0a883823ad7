//! A trained network as a policy: the feasible vertiport with the highest logit (§IV.B, greedy decoding).

use std::sync::Arc;

use vertifleet_core::VertiportIx;
use vertifleet_policy::{Policy, PolicyError};
use vertifleet_sim::{Decision, View};

use crate::features::{Observations, Scales};
use crate::nn::{Prepared, Workspace};
use crate::weights::Model;

/// Decisions per inference; larger batches gain nothing.
const BATCH: usize = 256;

/// Decides by a trained network. Deterministic; among equal logits the vertiport listed first wins.
pub struct Learned {
    model: Arc<Model>,
    scales: Scales,
    prepared: Prepared,
    workspace: Workspace,
    observations: Observations,
}

impl Learned {
    /// The policy of a model.
    pub fn new(model: Arc<Model>) -> Self {
        let mut prepared = model.net().prepared();
        model.net().prepare(model.params(), &mut prepared);
        Self {
            scales: Scales::from(model.header().feature_scales),
            prepared,
            workspace: model.net().workspace(BATCH),
            observations: Observations::new(model.net().shape(), BATCH),
            model,
        }
    }

    /// Chooses for the first `batch` rows of the observations.
    fn infer(&mut self, batch: usize) -> impl Iterator<Item = VertiportIx> {
        let inputs = self.observations.inputs(batch);
        let net = self.model.net();
        net.forward(self.model.params(), &self.prepared, inputs, &mut self.workspace);
        self.workspace.logits().chunks_exact(net.shape().vertiports).map(highest)
    }
}

impl Policy for Learned {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        self.observations.write(0, decision, view, &self.scales);
        Ok(self.infer(1).next().expect("one choice for one decision"))
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
fn highest(logits: &[f32]) -> VertiportIx {
    let mut best = 0;
    for (at, logit) in logits.iter().enumerate() {
        if *logit > logits[best] {
            best = at;
        }
    }
    VertiportIx::new(best)
}
