//! What `gcaps-x` sees of a decision, for others to decide or to learn by.

use vertifleet_policy::{PriceMemory, Shortlist};
use vertifleet_sim::{Decision, View};

use crate::gcaps_x::features::{AIRCRAFT_FEATURES, NODE_FEATURES, Scene, Writer, shape};
use crate::gcaps_x::scorer::LOGITS_A_UNIT;
use crate::rows::Rows;

/// Shows decisions as `gcaps-x` sees them. It remembers the bid prices of the day that it showed
/// last, so each day that is played side by side with others should have an observer of its own.
#[derive(Debug, Clone)]
pub struct PricedObserver {
    prices: PriceMemory,
    shortlist: Shortlist,
    writer: Writer,
    rows: Rows,
    worth: Vec<f32>,
}

/// A decision as `gcaps-x` sees it.
#[derive(Debug, Clone, Copy)]
pub struct PricedObservation<'a> {
    /// The features of the vertiports, `[N][24]`. The first of each is 1 if the vertiport is on the
    /// shortlist.
    pub nodes: &'a [f32],
    /// The features of the aircraft, `[10]`.
    pub aircraft: &'a [f32],
    /// The worth of each choice of the shortlist at the bid prices, less that of the best, in the
    /// unit of the network's logits; 0 for the others, `[N]`. The choice of `gcaps-x` has the
    /// highest sum of this and its logit.
    pub worth: &'a [f32],
}

impl Default for PricedObserver {
    fn default() -> Self {
        Self {
            prices: PriceMemory::default(),
            shortlist: Shortlist::default(),
            writer: Writer::default(),
            rows: Rows::new(shape(0), false),
            worth: Vec::new(),
        }
    }
}

impl PricedObserver {
    /// Number of features of a vertiport.
    pub const NODE_FEATURES: usize = NODE_FEATURES;
    /// Number of features of the deciding aircraft.
    pub const AIRCRAFT_FEATURES: usize = AIRCRAFT_FEATURES;
    /// The least worth, which stands for all that are lower.
    const LEAST: f64 = -1e6;

    /// Shows a decision.
    pub fn observe(&mut self, view: View<'_>, decision: &Decision) -> PricedObservation<'_> {
        let prices = self.prices.at(view, decision);
        let listed = self.shortlist.rank(prices, view, decision);
        let scene = Scene::of(view, decision, prices);
        let vertiports = view.vertiports();
        if self.rows.vertiports() != vertiports {
            self.rows = Rows::new(shape(vertiports), false);
        }
        self.rows.clear();
        self.writer.push(scene, listed, &mut self.rows);
        self.worth.clear();
        self.worth.resize(vertiports, 0.0);
        for choice in listed {
            let less_usd = choice.worth_usd - listed[0].worth_usd;
            let logits = LOGITS_A_UNIT * less_usd / scene.addition_usd();
            // Where nothing is at stake the network adds nothing, and any difference is infinite in
            // its unit.
            self.worth[choice.to.at()] =
                if less_usd == 0.0 { 0.0 } else { logits.max(Self::LEAST) as f32 };
        }
        let inputs = self.rows.inputs();
        PricedObservation { nodes: inputs.nodes, aircraft: inputs.aircraft, worth: &self.worth }
    }
}
