//! A policy's scorer: its observation and its network. A scorer observes decisions, any number of
//! them at a time, and scores their choices.
//!
//! With the logits of `gcaps-x`, the worth of a choice is its worth at the day's prices plus the
//! network's addition:
//!
//! ```text
//! worth_j = worth of j at the prices  +  logit_j * unit / 20
//! ```
//!
//! where the unit is the profit of a typical full flight, or less if the decision has less at stake
//! ([`PricedDecision::addition_usd`]). A network of zeros adds nothing, so it decides as `prices`
//! does. Only the choices of a [`Shortlist`] are scored, whose worth is close to that of the best.
//!
//! The other policies decide by their logits alone, between all feasible choices.

use std::sync::Arc;

use vertifleet_core::{FeatureScales, VertiportIx};
use vertifleet_observe::{LOGITS_A_UNIT, PricedDecision, Writer};
use vertifleet_policy::{DayPrices, PricedChoice, Shortlist};
use vertifleet_sim::{Decision, View};

use crate::nn::{Architecture, NeuralNetwork, Weights, Workspace};
use crate::rollouts::MOST_ROWS;
use crate::rows::Rows;

/// Largest number of decisions per inference, and of their vertiports; larger batches are not
/// faster.
const MOST_DECISIONS: usize = 256;
const MOST_NODES: usize = 2_048;
/// The reason why there is a network of the right size when decisions are added.
const CLEARED: &str = "rows are cleared before they are added";

pub(crate) struct Scorer {
    architecture: Architecture,
    weights: Arc<Weights>,
    writer: Writer,
    /// For the number of vertiports of the latest day.
    sized: Option<Sized>,
    shortlist: Shortlist,
}

/// The parts that depend on the number of vertiports.
struct Sized {
    net: NeuralNetwork,
    workspace: Workspace,
    rows: Rows,
}

impl Scorer {
    pub(crate) fn new(
        architecture: &Architecture,
        scales: Option<FeatureScales>,
        weights: Arc<Weights>,
    ) -> Self {
        Self {
            writer: architecture.writer(scales),
            architecture: architecture.clone(),
            weights,
            sized: None,
            shortlist: Shortlist::default(),
        }
    }

    fn adds_to_prices(&self) -> bool {
        self.architecture.observation().is_priced()
    }

    /// Removes all decisions, and prepares for those of days with this many vertiports.
    pub(crate) fn clear(&mut self, vertiports: usize) {
        match &mut self.sized {
            Some(sized) if sized.rows.vertiports() == vertiports => sized.rows.clear(),
            _ => {
                let net = self.architecture.network(vertiports);
                let workspace = net.workspace(most_decisions(vertiports));
                let rows = Rows::new(&self.architecture, vertiports);
                self.sized = Some(Sized { net, workspace, rows });
            }
        }
    }

    /// Whether the scorer has room for no further decision.
    pub(crate) fn is_full(&self) -> bool {
        let rows = &self.sized.as_ref().expect(CLEARED).rows;
        rows.len() >= most_decisions(rows.vertiports())
    }

    /// Adds a decision. `priced` has the day's prices and the choices to decide between, the best
    /// first; only `gcaps-x` needs them.
    pub(crate) fn push(
        &mut self,
        view: View<'_>,
        decision: &Decision,
        priced: Option<(&DayPrices, &[PricedChoice])>,
    ) {
        let rows = &mut self.sized.as_mut().expect(CLEARED).rows;
        rows.push(|row| self.writer.write(view, decision, priced, row));
    }

    /// Scores all decisions.
    pub(crate) fn forward(&mut self) {
        let Sized { net, workspace, rows } = self.sized.as_mut().expect(CLEARED);
        net.forward(&self.weights, rows.inputs(), workspace);
    }

    /// Scores one decision, in row 0. Returns its logits, minus infinity for infeasible choices.
    pub(crate) fn score(
        &mut self,
        view: View<'_>,
        decision: &Decision,
        priced: Option<(&DayPrices, &[PricedChoice])>,
    ) -> &[f32] {
        self.clear(view.vertiports());
        self.push(view, decision, priced);
        self.forward();
        self.logits().next().expect("one row for one decision")
    }

    /// The logits of each decision.
    pub(crate) fn logits(&self) -> impl Iterator<Item = &[f32]> {
        let Sized { workspace, rows, .. } = self.sized.as_ref().expect(CLEARED);
        workspace.logits().chunks_exact(rows.vertiports())
    }

    /// Lists choices with their worth by prices and network, in their order; they are ranked by the
    /// prices.
    pub(crate) fn worth(
        &mut self,
        scene: PricedDecision<'_>,
        listed: &[PricedChoice],
        scored: &mut Vec<PricedChoice>,
    ) {
        self.score(scene.view, scene.decision, Some((scene.prices, listed)));
        scored.clear();
        scored.extend(listed.iter().map(|&choice| self.rated(0, scene, choice)));
    }

    /// Its choice; `listed` is the shortlist of the decision, ranked by the prices.
    pub(crate) fn choose(
        &mut self,
        scene: PricedDecision<'_>,
        listed: &[PricedChoice],
    ) -> VertiportIx {
        let PricedDecision { view, decision, prices, .. } = scene;
        match listed {
            [only] if self.adds_to_prices() => only.to,
            _ if self.adds_to_prices() => {
                self.score(view, decision, Some((prices, listed)));
                let scored = listed.iter().map(|&choice| self.rated(0, scene, choice));
                PricedChoice::best(scored).unwrap_or(listed[0].to)
            }
            _ => highest(self.score(view, decision, None)),
        }
    }

    /// Lists the choices that it decides between in roll-outs.
    pub(crate) fn list(&mut self, scene: PricedDecision<'_>, listed: &mut Vec<PricedChoice>) {
        let PricedDecision { view, decision, prices, .. } = scene;
        listed.clear();
        if self.adds_to_prices() {
            listed.extend(self.shortlist.rank(prices, view, decision));
        } else {
            let unknown = |to| PricedChoice { worth_usd: 0.0, to };
            listed.extend(view.feasible(decision).iter().map(unknown));
        }
    }

    /// A choice with its worth by a row of the latest [`forward`](Self::forward), dollars. Only
    /// differences count. A logit of 1 is worth the unit of the samples that the network learned
    /// from, divided by [`LOGITS_A_UNIT`].
    pub(crate) fn rated(
        &self,
        row: usize,
        scene: PricedDecision<'_>,
        PricedChoice { worth_usd, to }: PricedChoice,
    ) -> PricedChoice {
        let Sized { workspace, rows, .. } = self.sized.as_ref().expect(CLEARED);
        let logit = f64::from(workspace.logits()[row * rows.vertiports() + to.at()]);
        let worth_usd = if self.adds_to_prices() {
            worth_usd + logit / LOGITS_A_UNIT * scene.addition_usd()
        } else {
            logit / LOGITS_A_UNIT * scene.unit_usd
        };
        PricedChoice { worth_usd, to }
    }
}

fn most_decisions(vertiports: usize) -> usize {
    (MOST_NODES / vertiports).clamp(MOST_ROWS, MOST_DECISIONS)
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
