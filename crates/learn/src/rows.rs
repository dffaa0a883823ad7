//! Observations of any number of decisions on days with one number of vertiports, side by side, as a network takes
//! them. The memory grows with the number of rows and is kept.

use vertifleet_core::VertiportIx;
use vertifleet_sim::VertiportSet;

use crate::nn::{AIRCRAFT_SHOWN, Architecture, FLEET_FEATURES, Inputs, Shape};

/// Rows of features.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    shape: Shape,
    beside: ExtraInputs,
    nodes: Vec<f32>,
    aircraft: Vec<f32>,
    mask: Vec<u8>,
    edges: Vec<f32>,
    fleet: Vec<f32>,
    clock: Vec<f32>,
}

/// What rows have beside the features of the vertiports and of the deciding aircraft.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ExtraInputs {
    /// Weights of edges.
    pub(crate) edges: bool,
    /// Features of the other aircraft.
    pub(crate) fleet: bool,
}

/// The parts of a row that is being written; all are zeros at first.
pub(crate) struct Row<'a> {
    /// Node features [N x F]. The first of each node says whether it may be chosen.
    pub(crate) nodes: &'a mut [f32],
    /// Aircraft features [G].
    pub(crate) aircraft: &'a mut [f32],
    /// Weights of edges [N x N], or none.
    pub(crate) edges: &'a mut [f32],
    /// Features of the other aircraft [M x H], or none.
    pub(crate) fleet: &'a mut [f32],
    /// Share of the day that is left.
    pub(crate) clock: &'a mut f32,
}

impl ExtraInputs {
    /// What a policy's network reads.
    pub(crate) fn of(policy: &Architecture) -> Self {
        Self { edges: policy.adjacency().is_observed(), fleet: policy.has_aircraft_graph() }
    }

    /// Numbers of a row with so many vertiports: those of the edges, and those of the other aircraft.
    pub(crate) fn widths(self, vertiports: usize) -> [usize; 2] {
        let of = |is_there: bool, numbers: usize| if is_there { numbers } else { 0 };
        [of(self.edges, vertiports * vertiports), of(self.fleet, AIRCRAFT_SHOWN * FLEET_FEATURES)]
    }
}

impl Rows {
    /// No rows yet, for features of this shape.
    pub(crate) fn new(shape: Shape, beside: ExtraInputs) -> Self {
        Self {
            shape,
            beside,
            nodes: Vec::new(),
            aircraft: Vec::new(),
            mask: Vec::new(),
            edges: Vec::new(),
            fleet: Vec::new(),
            clock: Vec::new(),
        }
    }

    /// Rows with the features, edges and other aircraft of earlier [`inputs`](Self::inputs), and with their masks where the
    /// features do not tell them.
    pub(crate) fn of(
        (shape, beside): (Shape, ExtraInputs),
        nodes: Vec<f32>,
        aircraft: Vec<f32>,
        [edges, fleet]: [Vec<f32>; 2],
        masks: Option<&[f32]>,
    ) -> Self {
        let clock = vec![0.0; aircraft.len() / shape.aircraft_features];
        let open = |&number: &f32| u8::from(number == 1.0);
        let mask = match masks {
            Some(masks) => masks.iter().map(open).collect(),
            None => nodes.iter().step_by(shape.node_features).map(open).collect(),
        };
        Self { shape, beside, nodes, aircraft, mask, edges, fleet, clock }
    }

    pub(crate) fn shape(&self) -> Shape {
        self.shape
    }

    pub(crate) fn vertiports(&self) -> usize {
        self.shape.vertiports
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
        let [edges, fleet] = self.beside.widths(vertiports);
        self.edges.truncate(len * edges);
        self.fleet.truncate(len * fleet);
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
            fleet: &self.fleet,
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
        let [edges, fleet] = self.beside.widths(vertiports);
        self.edges.extend(part(&from.edges, row, edges));
        self.fleet.extend(part(&from.fleet, row, fleet));
        self.clock.push(from.clock[row]);
    }

    /// Adds a row, which `write` writes, of a decision between these vertiports. The features need not tell which they
    /// are.
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
        let [edges, fleet] = self.beside.widths(vertiports);
        let first = [&self.nodes, &self.aircraft, &self.edges, &self.fleet, &self.clock];
        let first = first.map(Vec::len);
        self.nodes.resize(first[0] + vertiports * node_features, 0.0);
        self.aircraft.resize(first[1] + aircraft_features, 0.0);
        self.edges.resize(first[2] + edges, 0.0);
        self.fleet.resize(first[3] + fleet, 0.0);
        self.clock.push(0.0);
        write(&mut Row {
            nodes: &mut self.nodes[first[0]..],
            aircraft: &mut self.aircraft[first[1]..],
            edges: &mut self.edges[first[2]..],
            fleet: &mut self.fleet[first[3]..],
            clock: &mut self.clock[first[4]],
        });
        let chosen = self.nodes[first[0]..].iter().step_by(node_features);
        self.mask.extend(chosen.map(|&chosen| u8::from(chosen == 1.0)));
    }
}
