//! The graph of the other aircraft, as a later study of the paper's authors has one beside that of the vertiports
//! (arXiv:2401.04851).
//!
//! Its nodes are the other aircraft that will be ready first, every one a neighbour of every other. One layer of graph
//! capsules reads them; on a complete graph more than one hop says no more. What the mean of their capsules says is added
//! to the query of the decoder:
//!
//! ```text
//! q = psi W_Q + b_Q + mean(C) W_A
//! ```
//!
//! A day with fewer other aircraft has empty rows, which count in the mean as aircraft that are not there.

use crate::nn::architecture::{Adjacency, Laplacian};
use crate::nn::batch::Inputs;
use crate::nn::gcaps::capsule_layers::{CapsuleLayers, CapsuleSpace};
use crate::nn::gcaps::graph::Graph;
use crate::nn::init::Init;
use crate::nn::layout::{Layout, Slot, Tensors};
use crate::nn::linear::{add_weight_slopes, sum_groups};
use crate::nn::product::{Matrix, MatrixMut, Write, multiply};

/// M, the number of other aircraft that are shown; the network `paper` has one less.
pub const AIRCRAFT_SHOWN: usize = 40;
/// H, the number of features of each.
pub const FLEET_FEATURES: usize = 16;

/// Sizes and weights of the graph of the other aircraft.
#[derive(Debug, Clone)]
pub(crate) struct Fleet {
    layers: CapsuleLayers,
    /// W_A.
    join: Slot,
}

/// The working memory; sizes for one sample in brackets.
#[derive(Debug)]
pub(crate) struct FleetSpace {
    capsules: CapsuleSpace,
    capsule_slopes: Vec<f32>,
    /// Mean of the capsules [P h]; in the backward pass, its slopes.
    means: Vec<f32>,
    /// What is added to the query [h].
    added: Vec<f32>,
}

impl Fleet {
    pub(crate) fn new(layout: &mut Layout, width: usize, moments: usize) -> Self {
        let graph = Graph {
            nodes: AIRCRAFT_SHOWN,
            node_features: FLEET_FEATURES,
            adjacency: Adjacency::Complete,
            laplacian: Laplacian::Plain,
        };
        let layers = CapsuleLayers::new(layout, "fleet_encoder", graph, width, (1, moments, 1));
        let capsule = layers.capsule_width();
        let plain = Init::Uniform { inputs: capsule, gain: 1.0 };
        Self { layers, join: layout.matrix("fleet_encoder.join.weight", (capsule, width), plain) }
    }

    pub(crate) fn space(&self, batch: usize) -> FleetSpace {
        let (capsule, width) = (self.join.rows, self.join.columns);
        FleetSpace {
            capsules: self.layers.space(batch),
            capsule_slopes: vec![0.0; batch * AIRCRAFT_SHOWN * capsule],
            means: vec![0.0; batch * capsule],
            added: vec![0.0; batch * width],
        }
    }

    /// What the aircraft add to the queries [B x h].
    pub(crate) fn forward<'space>(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        space: &'space mut FleetSpace,
    ) -> &'space [f32] {
        let (batch, capsule, width) = (inputs.batch, self.join.rows, self.join.columns);
        self.layers.forward(tensors, aircraft(inputs), &mut space.capsules);
        let capsules = self.layers.read(&space.capsules, batch);
        let means = &mut space.means[..batch * capsule];
        sum_groups(capsules, AIRCRAFT_SHOWN, capsule, 1.0 / AIRCRAFT_SHOWN as f32, means);
        let added = &mut space.added[..batch * width];
        let means = Matrix::new(means, batch, capsule);
        let to = MatrixMut::new(added, batch, width);
        multiply(to, Write::Set, means, tensors.matrix(self.join));
        added
    }

    /// Adds the slopes of all weights; `slopes` are those of the queries.
    pub(crate) fn backward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        slopes: &[f32],
        space: &mut FleetSpace,
        gradient: &mut [f32],
    ) {
        let (batch, capsule, width) = (inputs.batch, self.join.rows, self.join.columns);
        let means = &mut space.means[..batch * capsule];
        add_weight_slopes(self.join, means, slopes, gradient);
        let slopes = Matrix::new(slopes, batch, width);
        let to = MatrixMut::new(means, batch, capsule);
        multiply(to, Write::Set, slopes, tensors.matrix(self.join).transposed());
        let capsule_slopes = &mut space.capsule_slopes[..batch * AIRCRAFT_SHOWN * capsule];
        let of_samples = capsule_slopes.chunks_exact_mut(AIRCRAFT_SHOWN * capsule);
        for (slopes, means) in of_samples.zip(means.chunks_exact(capsule)) {
            for slopes in slopes.chunks_exact_mut(capsule) {
                for (slope, mean) in slopes.iter_mut().zip(means) {
                    *slope = mean / AIRCRAFT_SHOWN as f32;
                }
            }
        }
        let of_aircraft = aircraft(inputs);
        self.layers.backward(tensors, of_aircraft, &mut space.capsules, capsule_slopes, gradient);
    }
}

/// The aircraft as the nodes of a graph.
fn aircraft(inputs: Inputs<'_>) -> Inputs<'_> {
    Inputs { nodes: inputs.fleet, ..inputs }
}
