//! Observations of decisions on days with one number of vertiports, row by row, in the form in
//! which a network reads them. The memory grows with the number of rows and is reused.

use vertifleet_observe::{Row, Shape};

use crate::nn::{Architecture, Inputs};

/// Rows of features.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    shape: Shape,
    /// The number of weights of edges in a row.
    edges_a_row: usize,
    nodes: Vec<f32>,
    aircraft: Vec<f32>,
    mask: Vec<u8>,
    edges: Vec<f32>,
    clock: Vec<f32>,
}

impl Rows {
    /// Zero rows, for a policy's observations of days with this number of vertiports.
    pub(crate) fn new(policy: &Architecture, vertiports: usize) -> Self {
        Self {
            shape: policy.shape(vertiports),
            edges_a_row: policy.edges().map_or(0, |_| vertiports * vertiports),
            nodes: Vec::new(),
            aircraft: Vec::new(),
            mask: Vec::new(),
            edges: Vec::new(),
            clock: Vec::new(),
        }
    }

    /// Rows with the features and edges of earlier [`inputs`](Self::inputs), and with their masks
    /// where the features do not contain them.
    pub(crate) fn of(
        policy: &Architecture,
        vertiports: usize,
        nodes: Vec<f32>,
        aircraft: Vec<f32>,
        edges: Option<Vec<f32>>,
        masks: Option<&[f32]>,
    ) -> Self {
        let none = Self::new(policy, vertiports);
        let clock = vec![0.0; aircraft.len() / none.shape.aircraft_features];
        let open = |&number: &f32| u8::from(number == 1.0);
        let mask = match masks {
            Some(masks) => masks.iter().map(open).collect(),
            None => nodes.iter().step_by(none.shape.node_features).map(open).collect(),
        };
        Self { nodes, aircraft, mask, edges: edges.unwrap_or_default(), clock, ..none }
    }

    pub(crate) fn vertiports(&self) -> usize {
        self.shape.vertiports
    }

    pub(crate) fn len(&self) -> usize {
        self.clock.len()
    }

    pub(crate) fn clear(&mut self) {
        self.resize(0);
    }

    /// Drops rows from the end, or adds rows of zeros.
    pub(crate) fn resize(&mut self, len: usize) {
        let Shape { vertiports, node_features, aircraft_features } = self.shape;
        self.nodes.resize(len * vertiports * node_features, 0.0);
        self.aircraft.resize(len * aircraft_features, 0.0);
        self.mask.resize(len * vertiports, 0);
        self.edges.resize(len * self.edges_a_row, 0.0);
        self.clock.resize(len, 0.0);
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
        self.resize(self.len() + 1);
        self.copy(self.len() - 1, from, row);
    }

    /// Makes row `at` a copy of a row of `from`, which has the same shape.
    pub(crate) fn copy(&mut self, at: usize, from: &Self, row: usize) {
        fn part<T: Copy>(to: &mut [T], at: usize, from: &[T], row: usize, width: usize) {
            to[at * width..][..width].copy_from_slice(&from[row * width..][..width]);
        }
        let Shape { vertiports, node_features, aircraft_features } = self.shape;
        part(&mut self.nodes, at, &from.nodes, row, vertiports * node_features);
        part(&mut self.aircraft, at, &from.aircraft, row, aircraft_features);
        part(&mut self.mask, at, &from.mask, row, vertiports);
        part(&mut self.edges, at, &from.edges, row, self.edges_a_row);
        self.clock[at] = from.clock[row];
    }

    /// Adds a row; `write` fills it.
    pub(crate) fn push(&mut self, write: impl FnOnce(&mut Row<'_>)) {
        let row = self.len();
        self.resize(row + 1);
        let Shape { vertiports, node_features, aircraft_features } = self.shape;
        write(&mut Row {
            nodes: &mut self.nodes[row * vertiports * node_features..],
            aircraft: &mut self.aircraft[row * aircraft_features..],
            mask: &mut self.mask[row * vertiports..],
            edges: &mut self.edges[row * self.edges_a_row..],
            clock: &mut self.clock[row],
        });
    }
}
