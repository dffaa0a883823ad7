//! What `gcaps-full` and `mlp-full` see of a decision, for others to decide or to learn by.

use vertifleet_sim::{Decision, View};

use crate::full::board::Board;
use crate::full::features::{AIRCRAFT_FEATURES, NODE_FEATURES, Scene, Writer};
use crate::nn::Adjacency;
use crate::rows::Rows;

/// Shows decisions as policies of the full observation see them. It remembers the flights of the
/// days that it showed lately.
#[derive(Debug, Clone)]
pub struct FullObserver {
    writer: Writer,
    rows: Rows,
}

/// A decision as policies of the full observation see it.
#[derive(Debug, Clone, Copy)]
pub struct FullObservation<'a> {
    /// The features of the vertiports, `[N][37]`. The first of each is 1 if the vertiport may be
    /// chosen.
    pub nodes: &'a [f32],
    /// The features of the aircraft, `[11]`.
    pub aircraft: &'a [f32],
    board: &'a Board,
    scene: Scene<'a>,
}

impl Default for FullObserver {
    fn default() -> Self {
        let writer = Writer::of_features();
        Self { rows: writer.rows(0), writer }
    }
}

impl FullObserver {
    /// Number of features of a vertiport.
    pub const NODE_FEATURES: usize = NODE_FEATURES;
    /// Number of features of the deciding aircraft.
    pub const AIRCRAFT_FEATURES: usize = AIRCRAFT_FEATURES;

    /// Shows a decision.
    pub fn observe<'a>(
        &'a mut self,
        view: View<'a>,
        decision: &'a Decision,
    ) -> FullObservation<'a> {
        let Self { writer, rows } = self;
        if rows.vertiports() != view.vertiports() {
            *rows = writer.rows(view.vertiports());
        }
        rows.clear();
        let scene = writer.push(view, decision, rows);
        let inputs = rows.inputs();
        FullObservation {
            nodes: inputs.nodes,
            aircraft: inputs.aircraft,
            board: writer.board(),
            scene,
        }
    }
}

impl FullObservation<'_> {
    /// Writes the weights of the edges between vertiports, in the direction of flights, with a row
    /// of `stride` entries for each vertiport that flights come from, over zeros: what is 0, as
    /// pairs out of range are, need not be written.
    pub fn write_edges(&self, adjacency: Adjacency, stride: usize, edges: &mut [f32]) {
        self.scene.write_edges(self.board, adjacency, stride, edges);
    }
}
