//! Observations of any number of decisions on days with one number of vertiports, side by side, as
//! a network takes them. The memory grows with the number of rows and is kept.

use vertifleet_core::VertiportIx;
use vertifleet_sim::VertiportSet;

use crate::nn::{Architecture, Inputs, Shape};

/// Rows of features.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    shape: Shape,
    has_edges: bool,
    nodes: Vec<f32>,
    aircraft: Vec<f32>,
    mask: Vec<u8>,
    edges: Vec<f32>,
    clock: Vec<f32>,
}

/// The parts of a row that is being written; all are zeros at first.
pub(crate) struct Row<'a> {
    /// Node features [N x F]. The first of each node says whether it may be chosen.
    pub(crate) nodes: &'a mut [f32],
    /// Aircraft features [G].
    pub(crate) aircraft: &'a mut [f32],
    /// Weights of edges [N x N], or none.
    pub(crate) edges: &'a mut [f32],
    /// Share of the day that is left.
    pub(crate) clock: &'a mut f32,
}

/// Whether the rows of a policy have weights of edges.
pub(crate) fn has_edges(policy: &Architecture) -> bool {
    policy.adjacency().is_observed()
}

impl Rows {
    /// No rows yet, for features of this shape and perhaps weights of edges.
    pub(crate) fn new(shape: Shape, has_edges: bool) -> Self {
        Self {
            shape,
            has_edges,
            nodes: Vec::new(),
            aircraft: Vec::new(),
            mask: Vec::new(),
            edges: Vec::new(),
            clock: Vec::new(),
        }
    }

    /// Rows with the features and edges of earlier [`inputs`](Self::inputs), and
    /// with their masks where the features do not tell them.
    pub(crate) fn of(
        shape: Shape,
        nodes: Vec<f32>,
        aircraft: Vec<f32>,
        edges: Option<Vec<f32>>,
        masks: Option<&[f32]>,
    ) -> Self {
        let clock = vec![0.0; aircraft.len() / shape.aircraft_features];
        let open = |&number: &f32| u8::from(number == 1.0);
        let mask = match masks {
            Some(masks) => masks.iter().map(open).collect(),
            None => nodes.iter().step_by(shape.node_features).map(open).collect(),
        };
        let has_edges = edges.is_some();
        Self { shape, has_edges, nodes, aircraft, mask, edges: edges.unwrap_or_default(), clock }
    }

    pub(crate) fn shape(&self) -> Shape {
        self.shape
    }

    pub(crate) fn vertiports(&self) -> usize {
        self.shape.vertiports
    }

    /// The number of weights of edges in a row.
    fn edges_a_row(&self) -> usize {
        if self.has_edges { self.vertiports() * self.vertiports() } else { 0 }
    }

    pub(crate) fn len(&self) -> usize {
        self.clock.len()
    }

    pub(crate) fn clear(&mut self) {
        self.truncate(0);
    }

    /// Drops all rows after the first `len`.
    pub(crate) fn truncate(&mut self, len: usize) {
        let Shape { vertiports, node_features, aircraft_features } = self.shape;
        self.nodes.truncate(len * vertiports * node_features);
        self.aircraft.truncate(len * aircraft_features);
        self.mask.truncate(len * vertiports);
        self.edges.truncate(len * self.edges_a_row());
        self.clock.truncate(len);
    }

    /// All rows as the input of a network.
    pub(crate) fn inputs(&self) -> Inputs<'_> {
        Inputs {
            batch: self.len(),
            nodes: &self.nodes,
            aircraft: &self.aircraft,
            mask: &self.mask,
            edges: &self.edges,
            clock: &self.clock,
        }
    }

    /// Adds a copy of a row of `from`, which has the same shape.
    pub(crate) fn push_copy(&mut self, from: &Self, row: usize) {
        fn part<T>(all: &[T], row: usize, width: usize) -> &[T] {
            &all[row * width..][..width]
        }
        let Shape { vertiports, node_features, aircraft_features } = self.shape;
        self.nodes.extend(part(&from.nodes, row, vertiports * node_features));
        self.aircraft.extend(part(&from.aircraft, row, aircraft_features));
        self.mask.extend(part(&from.mask, row, vertiports));
        self.edges.extend(part(&from.edges, row, self.edges_a_row()));
        self.clock.push(from.clock[row]);
    }

    /// Adds a row, which `write` writes, of a decision between these vertiports. The features need
    /// not tell which they are.
    pub(crate) fn push_between(&mut self, open: VertiportSet, write: impl FnOnce(&mut Row<'_>)) {
        self.push(write);
        let first = self.mask.len() - self.shape.vertiports;
        for (at, mask) in self.mask[first..].iter_mut().enumerate() {
            *mask = u8::from(open.contains(VertiportIx::new(at)));
        }
    }

    /// Adds a row, which `write` writes.
    pub(crate) fn push(&mut self, write: impl FnOnce(&mut Row<'_>)) {
        let Shape { vertiports, node_features, aircraft_features } = self.shape;
        let edges = self.edges_a_row();
        let first = [&self.nodes, &self.aircraft, &self.edges, &self.clock];
        let first = first.map(Vec::len);
        self.nodes.resize(first[0] + vertiports * node_features, 0.0);
        self.aircraft.resize(first[1] + aircraft_features, 0.0);
        self.edges.resize(first[2] + edges, 0.0);
        self.clock.push(0.0);
        write(&mut Row {
            nodes: &mut self.nodes[first[0]..],
            aircraft: &mut self.aircraft[first[1]..],
            edges: &mut self.edges[first[2]..],
            clock: &mut self.clock[first[3]],
        });
        let chosen = self.nodes[first[0]..].iter().step_by(node_features);
        self.mask.extend(chosen.map(|&chosen| u8::from(chosen == 1.0)));
    }
}
