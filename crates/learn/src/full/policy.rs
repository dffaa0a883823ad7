//! `gcaps-full` and `mlp-full` as policies: the feasible vertiport with the highest logit.

use std::sync::Arc;

use vertifleet_core::VertiportIx;
use vertifleet_policy::{Policy, PolicyError, PricedChoice};
use vertifleet_sim::{Decision, View};

use crate::full::features::Writer;
use crate::gcaps_x::features::Scene;
use crate::gcaps_x::scorer::LOGITS_A_UNIT;
use crate::header::network;
use crate::learned::highest;
use crate::model::Model;
use crate::nn::{Architecture, NeuralNetwork, Weights, Workspace};
use crate::rollouts::{MOST_ROWS, Scores};
use crate::rows::Rows;

/// Most decisions per inference, and most vertiports of all of them; larger batches are not faster.
const MOST_DECISIONS: usize = 256;
const MOST_NODES: usize = 2_048;
/// Why there is a network of the right size when roll-outs are scored.
const CLEARED: &str = "rows are cleared before they are added";

/// Decides by the full observation. It is deterministic: among equal logits the first vertiport
/// wins.
pub struct FullPolicy {
    architecture: Architecture,
    weights: Arc<Weights>,
    writer: Writer,
    /// For the number of vertiports of the latest day.
    sized: Option<Sized>,
}

/// What depends on the number of vertiports.
struct Sized {
    net: NeuralNetwork,
    workspace: Workspace,
    rows: Rows,
}

impl FullPolicy {
    /// The policy of a model of `gcaps-full` or `mlp-full`.
    pub fn new(model: &Model) -> Self {
        Self::of(model.header().policy.clone(), Arc::new(model.weights()))
    }

    pub(crate) fn of(architecture: Architecture, weights: Arc<Weights>) -> Self {
        let writer = Writer::of(&architecture);
        Self { architecture, weights, writer, sized: None }
    }

    /// What fits the number of vertiports of a day, without rows.
    fn sized(&mut self, vertiports: usize) -> (&mut Writer, &mut Sized) {
        if self.sized.as_ref().is_none_or(|sized| sized.rows.vertiports() != vertiports) {
            let net = network(&self.architecture, vertiports);
            let workspace = net.workspace(most_decisions(vertiports));
            self.sized = Some(Sized { net, workspace, rows: self.writer.rows(vertiports) });
        }
        let sized = self.sized.as_mut().expect("made above");
        sized.rows.clear();
        (&mut self.writer, sized)
    }

    /// The logits of one decision, minus infinity where the mask is 0.
    fn logits(&mut self, decision: &Decision, view: View<'_>) -> &[f32] {
        let weights = Arc::clone(&self.weights);
        let (writer, Sized { net, workspace, rows }) = self.sized(view.vertiports());
        writer.push(view, decision, rows);
        net.forward(&weights, rows.inputs(), workspace);
        workspace.logits()
    }
}

fn most_decisions(vertiports: usize) -> usize {
    (MOST_NODES / vertiports).clamp(MOST_ROWS, MOST_DECISIONS)
}

impl Policy for FullPolicy {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        Ok(highest(self.logits(decision, *view)))
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
        let logits = self.logits(decision, *view);
        for (value, &logit) in values.iter_mut().zip(logits) {
            *value = if logit.is_finite() { f64::from(logit) } else { f64::NAN };
        }
        Ok(highest(logits))
    }

    fn choose_batch(
        &mut self,
        asked: &mut dyn Iterator<Item = (Decision, View<'_>)>,
        choices: &mut Vec<VertiportIx>,
    ) -> Result<(), PolicyError> {
        let weights = Arc::clone(&self.weights);
        let mut asked = asked.peekable();
        while let Some(vertiports) = asked.peek().map(|(_, view)| view.vertiports()) {
            let (writer, Sized { net, workspace, rows }) = self.sized(vertiports);
            let fits = |(_, view): &(Decision, View<'_>)| view.vertiports() == vertiports;
            while rows.len() < most_decisions(vertiports)
                && let Some((decision, view)) = asked.next_if(fits)
            {
                writer.push(view, &decision, rows);
            }
            net.forward(&weights, rows.inputs(), workspace);
            choices.extend(workspace.logits().chunks_exact(vertiports).map(highest));
        }
        Ok(())
    }
}

/// It decides between all feasible choices. A logit of 1 is worth the unit of the samples that it
/// learned from, divided by [`LOGITS_A_UNIT`].
impl Scores for FullPolicy {
    fn list(&mut self, Scene { view, decision, .. }: Scene<'_>, listed: &mut Vec<PricedChoice>) {
        let unknown = |to| PricedChoice { worth_usd: 0.0, to };
        listed.clear();
        listed.extend(view.feasible(decision).iter().map(unknown));
    }

    fn clear(&mut self, vertiports: usize) {
        self.sized(vertiports);
    }

    fn push(&mut self, Scene { view, decision, .. }: Scene<'_>, _listed: &[PricedChoice]) {
        let sized = self.sized.as_mut().expect(CLEARED);
        self.writer.push(view, decision, &mut sized.rows);
    }

    fn forward(&mut self) {
        let Sized { net, workspace, rows } = self.sized.as_mut().expect(CLEARED);
        net.forward(&self.weights, rows.inputs(), workspace);
    }

    fn rate(&self, row: usize, scene: Scene<'_>, listed: &mut [PricedChoice]) {
        let logits = self.sized.as_ref().expect(CLEARED).workspace.logits();
        let first = row * scene.view.vertiports();
        for choice in listed {
            let logit = f64::from(logits[first + choice.to.at()]);
            choice.worth_usd = logit / LOGITS_A_UNIT * scene.unit_usd;
        }
    }
}
