//! The work that the benchmark and the example `update_speed` measure: made-up decisions of a
//! network with 8 vertiports, and one gradient step on them as PPO takes it.

use rayon::prelude::{
    IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator, ParallelSliceMut,
};
use vertifleet_learn::nn::{
    Architecture, Gradient, Inputs, NeuralNetwork, Shape, Slopes, Weights, Workspace,
};

/// Number of gradients that are filled in parallel.
const LANES: usize = 8;
const VERTIPORTS: usize = 8;

/// The network with this name and its default sizes, for 8 vertiports.
pub(crate) fn network(name: &str) -> NeuralNetwork {
    let shape = Shape {
        vertiports: VERTIPORTS,
        node_features: 2 * VERTIPORTS + 4,
        aircraft_features: 2 * VERTIPORTS + 2,
    };
    let architecture = Architecture::named(name).expect("gcaps or mlp");
    NeuralNetwork::new(architecture, shape).expect("default sizes fit")
}

/// Made-up decisions, and the slopes of a made-up loss with respect to the network's outputs.
pub(crate) struct Decisions {
    shape: Shape,
    nodes: Vec<f32>,
    aircraft: Vec<f32>,
    mask: Vec<u8>,
    clock: Vec<f32>,
    logit_slopes: Vec<f32>,
    value_slopes: Vec<f32>,
}

/// Numbers in [0, 1) without an obvious pattern.
fn spread(len: usize, pace: f32) -> Vec<f32> {
    (0..len).map(|at| (at as f32 * pace).fract()).collect()
}

impl Decisions {
    pub(crate) fn new(shape: Shape, count: usize) -> Self {
        let logits = count * shape.vertiports;
        Self {
            nodes: spread(logits * shape.node_features, 0.618_034),
            aircraft: spread(count * shape.aircraft_features, 0.414_214),
            mask: (0..logits).map(|at| u8::from(at % 5 != 3)).collect(),
            clock: spread(count, 0.732_051),
            logit_slopes: spread(logits, 0.236_068)
                .iter()
                .map(|x| (x - 0.5) / count as f32)
                .collect(),
            value_slopes: spread(count, 0.645_751)
                .iter()
                .map(|x| (x - 0.5) / count as f32)
                .collect(),
            shape,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.clock.len()
    }

    /// The decisions from `first` on, at most `count` of them.
    pub(crate) fn inputs(&self, first: usize, count: usize) -> Inputs<'_> {
        let Shape { vertiports, node_features, aircraft_features } = self.shape;
        let batch = count.min(self.len() - first);
        Inputs {
            batch,
            nodes: &self.nodes[first * vertiports * node_features..]
                [..batch * vertiports * node_features],
            aircraft: &self.aircraft[first * aircraft_features..][..batch * aircraft_features],
            mask: &self.mask[first * vertiports..][..batch * vertiports],
            edges: &[],
            clock: &self.clock[first..][..batch],
        }
    }

    fn slopes(&self, first: usize, batch: usize) -> Slopes<'_> {
        let vertiports = self.shape.vertiports;
        Slopes {
            logits: &self.logit_slopes[first * vertiports..][..batch * vertiports],
            values: &self.value_slopes[first..][..batch],
        }
    }
}

/// A learner: weights, Adam's moments, and the lanes that it works in.
pub(crate) struct Learner {
    network: NeuralNetwork,
    weights: Weights,
    moments: Vec<[f32; 2]>,
    lanes: Vec<(Workspace, Gradient)>,
    chunk: usize,
}

impl Learner {
    pub(crate) fn new(network: NeuralNetwork, chunk: usize) -> Self {
        let weights = network.weights(network.init(1));
        Self {
            moments: vec![[0.0; 2]; weights.params().len()],
            lanes: (0..LANES).map(|_| (network.workspace(chunk), network.gradient())).collect(),
            network,
            weights,
            chunk,
        }
    }

    /// One gradient step: chunks go forward and backward on all of rayon's threads, the gradients
    /// are added up, and Adam moves the weights.
    pub(crate) fn step(&mut self, decisions: &Decisions) {
        let Self { network, weights, moments, lanes, chunk } = self;
        let chunk = *chunk;
        let used = decisions.len().div_ceil(chunk).min(LANES);
        lanes[..used].par_iter_mut().enumerate().for_each(|(lane, (workspace, gradient))| {
            gradient.clear();
            for first in (lane * chunk..decisions.len()).step_by(LANES * chunk) {
                let inputs = decisions.inputs(first, chunk);
                network.forward(weights, inputs, workspace);
                let slopes = decisions.slopes(first, inputs.batch);
                network.backward(weights, inputs, slopes, workspace, gradient);
            }
        });
        let (total, rest) = lanes[..used].split_first_mut().expect("at least one lane");
        add_up(total.1.sums_mut(), rest);
        let gradient = network.finish(weights, &mut total.1);
        network.update(weights, |params| adam(params, gradient, moments));
    }
}

fn add_up(total: &mut [f32], lanes: &[(Workspace, Gradient)]) {
    const SPAN: usize = 1 << 16;
    total.par_chunks_mut(SPAN).enumerate().for_each(|(span, total)| {
        for (_, gradient) in lanes {
            let part = &gradient.sums()[span * SPAN..][..total.len()];
            for (sum, slope) in total.iter_mut().zip(part) {
                *sum += slope;
            }
        }
    });
}

/// Adam's arithmetic, without the bias corrections that matter in its first steps.
fn adam(params: &mut [f32], gradient: &[f32], moments: &mut [[f32; 2]]) {
    for ((param, slope), [first, second]) in params.iter_mut().zip(gradient).zip(moments) {
        *first = 0.9 * *first + 0.1 * slope;
        *second = 0.999 * *second + 0.001 * slope * slope;
        *param -= 1e-6 * *first / (second.sqrt() + 1e-5);
    }
}
