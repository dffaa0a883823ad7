//! Graph capsules on any graph (§IV.A.1, Eq. 18 and 19), with any number of moments, hops and
//! layers.
//!
//! ```text
//! f_p = ReLU(sum over a of L^a F^p W_pa)      F^p is F to the power p, entry by entry
//! ```
//!
//! The sum over a is taken from the highest power down, H_0 + L (H_1 + L (H_2 + ...)) with H_a =
//! F^p W_pa, so that L is applied K times. The capsules of a layer are [f_1, ..., f_P]. Those of
//! the last layer are the decoder's input; between layers, `C W + b` maps them back to features.

use crate::nn::batch::Inputs;
use crate::nn::gcaps::graph::{Graph, add_product, add_transposed_product};
use crate::nn::init::{self, Init};
use crate::nn::layout::{Layout, Slot, Tensors};
use crate::nn::linear::{Linear, add_weight_slopes};
use crate::nn::product::{Matrix, MatrixMut, Write, multiply};
use crate::nn::relu;

/// Sizes and weights of the layers.
#[derive(Debug, Clone)]
pub(crate) struct CapsuleLayers {
    graph: Graph,
    width: usize,
    /// W_0, b_0.
    node: Linear,
    layers: Vec<CapsuleLayer>,
}

/// One layer.
#[derive(Debug, Clone)]
struct CapsuleLayer {
    /// The map from the capsules of the layer before to features; the first layer uses the nodes'
    /// features.
    input: Option<Linear>,
    /// W_pa, by p and then a.
    weights: Vec<Vec<Slot>>,
}

/// The working memory of the layers; sizes for one sample in brackets.
#[derive(Debug)]
pub(crate) struct CapsuleSpace {
    /// L [N x N].
    laplacians: Vec<f32>,
    /// F of each layer [N x h].
    features: Vec<Vec<f32>>,
    /// The capsules of each layer [N x P h].
    capsules: Vec<Vec<f32>>,
    /// Slopes of the capsules of each layer but the last.
    capsule_slopes: Vec<Vec<f32>>,
    /// F^p [N x h].
    powers: Vec<f32>,
    /// Slopes of F^p [N x h].
    power_slopes: Vec<f32>,
    /// Sums over hops, and the next ones [N x h].
    sums: [Vec<f32>; 2],
    /// Slopes of F [N x h].
    slopes: Vec<f32>,
}

impl CapsuleLayers {
    /// Adds the tensors of the layers; their names begin with `name`.
    pub(crate) fn new(
        layout: &mut Layout,
        name: &str,
        graph: Graph,
        width: usize,
        (layers, moments, hops): (usize, usize, usize),
    ) -> Self {
        let node = Linear::new(layout, &format!("{name}.node"), (graph.node_features, width), 1.0);
        // As many terms as there are hops add up before each rectifier.
        let hop = Init::Uniform { inputs: (hops + 1) * width, gain: init::BEFORE_RELU };
        let layer = |number: usize| {
            let of_layer =
                if number == 1 { name.to_owned() } else { format!("{name}.layer_{number}") };
            let input = (number > 1).then(|| {
                let name = format!("{of_layer}.input");
                Linear::new(layout, &name, (moments * width, width), 1.0)
            });
            let mut weights = Vec::new();
            for p in 1..=moments {
                let name = |a: usize| format!("{of_layer}.moment_{p}.hop_{a}.weight");
                let slots = (0..=hops).map(|a| layout.matrix(&name(a), (width, width), hop));
                weights.push(slots.collect());
            }
            CapsuleLayer { input, weights }
        };
        let layers = (1..=layers).map(layer).collect();
        Self { graph, width, node, layers }
    }

    /// Number of columns of a node's capsules.
    pub(crate) fn capsule_width(&self) -> usize {
        self.layers[0].weights.len() * self.width
    }

    pub(crate) fn space(&self, batch: usize) -> CapsuleSpace {
        let count = self.graph.nodes;
        let nodes = batch * count;
        let rows = |width: usize| vec![0.0; nodes * width];
        let of_layers = |layers: usize, width: usize| (0..layers).map(|_| rows(width)).collect();
        let layers = self.layers.len();
        CapsuleSpace {
            laplacians: vec![0.0; nodes * count],
            features: of_layers(layers, self.width),
            capsules: of_layers(layers, self.capsule_width()),
            capsule_slopes: of_layers(layers - 1, self.capsule_width()),
            powers: rows(self.width),
            power_slopes: rows(self.width),
            sums: [rows(self.width), rows(self.width)],
            slopes: rows(self.width),
        }
    }

    /// Computes the capsules of all layers.
    pub(crate) fn forward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        space: &mut CapsuleSpace,
    ) {
        let nodes = inputs.batch * self.graph.nodes;
        self.graph.write(inputs, &mut space.laplacians[..nodes * self.graph.nodes]);
        for at in 0..self.layers.len() {
            let (before, rest) = space.capsules.split_at_mut(at);
            let features = &mut space.features[at][..nodes * self.width];
            match &self.layers[at].input {
                None => self.node.forward(tensors, inputs.nodes, features),
                Some(input) => {
                    let from = &before[at - 1][..nodes * self.capsule_width()];
                    input.forward(tensors, from, features);
                }
            }
            let capsules = &mut rest[0][..nodes * self.capsule_width()];
            let room = Scratch {
                laplacians: &space.laplacians[..nodes * self.graph.nodes],
                powers: &mut space.powers[..nodes * self.width],
                power_slopes: &mut space.power_slopes[..nodes * self.width],
                sums: space.sums.each_mut().map(|sums| &mut sums[..nodes * self.width]),
            };
            self.capsules(tensors, &self.layers[at], features, room, capsules);
        }
    }

    /// The capsules of a batch after a forward pass.
    pub(crate) fn read<'space>(&self, space: &'space CapsuleSpace, batch: usize) -> &'space [f32] {
        let last = space.capsules.last().expect("there is a layer");
        &last[..batch * self.graph.nodes * self.capsule_width()]
    }

    fn capsules(
        &self,
        tensors: Tensors<'_>,
        layer: &CapsuleLayer,
        features: &[f32],
        room: Scratch<'_>,
        capsules: &mut [f32],
    ) {
        let (width, step) = (self.width, self.capsule_width());
        let rows = features.len() / width;
        let Scratch { laplacians, powers, sums: [mut sums, mut next], .. } = room;
        for (p, weights) in layer.weights.iter().enumerate() {
            raise(features, p + 1, powers);
            let from = Matrix::new(powers, rows, width);
            for (a, &weight) in weights.iter().enumerate().rev() {
                multiply(
                    MatrixMut::new(next, rows, width),
                    Write::Set,
                    from,
                    tensors.matrix(weight),
                );
                if a + 1 < weights.len() {
                    add_product(laplacians, self.graph.nodes, width, sums, next);
                }
                std::mem::swap(&mut sums, &mut next);
            }
            let of_moment = capsules.chunks_exact_mut(step);
            for (capsule, sum) in of_moment.zip(sums.chunks_exact(width)) {
                capsule[p * width..][..width].copy_from_slice(sum);
            }
        }
        relu::forward(capsules);
    }

    /// Adds the slopes of all weights. `slopes` are those of the last layer's capsules; they are
    /// overwritten.
    pub(crate) fn backward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        space: &mut CapsuleSpace,
        slopes: &mut [f32],
        gradient: &mut [f32],
    ) {
        let nodes = inputs.batch * self.graph.nodes;
        for at in (0..self.layers.len()).rev() {
            let layer = &self.layers[at];
            let (before, here) = space.capsule_slopes.split_at_mut(at);
            let slopes = here
                .first_mut()
                .map_or(&mut *slopes, |own| &mut own[..nodes * self.capsule_width()]);
            relu::backward(&space.capsules[at][..slopes.len()], slopes);
            let features = &space.features[at][..nodes * self.width];
            let feature_slopes = &mut space.slopes[..nodes * self.width];
            let room = Scratch {
                laplacians: &space.laplacians[..nodes * self.graph.nodes],
                powers: &mut space.powers[..nodes * self.width],
                power_slopes: &mut space.power_slopes[..nodes * self.width],
                sums: space.sums.each_mut().map(|sums| &mut sums[..nodes * self.width]),
            };
            self.capsules_backward(
                tensors,
                layer,
                features,
                slopes,
                room,
                feature_slopes,
                gradient,
            );
            match &layer.input {
                None => self.node.backward(inputs.nodes, feature_slopes, gradient),
                Some(input) => {
                    let len = nodes * self.capsule_width();
                    input.backward(&space.capsules[at - 1][..len], feature_slopes, gradient);
                    let to = &mut before[at - 1][..len];
                    input.input_slopes(tensors, feature_slopes, Write::Set, to);
                }
            }
        }
    }

    /// Adds the slopes of a layer's weights, and writes those of its features.
    #[expect(clippy::too_many_arguments, reason = "a layer's pass back has this much to say")]
    fn capsules_backward(
        &self,
        tensors: Tensors<'_>,
        layer: &CapsuleLayer,
        features: &[f32],
        slopes: &[f32],
        room: Scratch<'_>,
        feature_slopes: &mut [f32],
        gradient: &mut [f32],
    ) {
        let (width, step) = (self.width, self.capsule_width());
        let rows = features.len() / width;
        let Scratch { laplacians, powers, power_slopes, sums: [mut sums, mut next] } = room;
        feature_slopes.fill(0.0);
        for (p, weights) in layer.weights.iter().enumerate() {
            for (slopes, sum) in slopes.chunks_exact(step).zip(sums.chunks_exact_mut(width)) {
                sum.copy_from_slice(&slopes[p * width..][..width]);
            }
            power_slopes.fill(0.0);
            raise(features, p + 1, powers);
            for (a, &weight) in weights.iter().enumerate() {
                add_weight_slopes(weight, powers, sums, gradient);
                let from = Matrix::new(sums, rows, width);
                let to = MatrixMut::new(power_slopes, rows, width);
                multiply(to, Write::Add, from, tensors.matrix(weight).transposed());
                if a + 1 < weights.len() {
                    next.fill(0.0);
                    add_transposed_product(laplacians, self.graph.nodes, width, sums, next);
                    std::mem::swap(&mut sums, &mut next);
                }
            }
            raise(features, p, powers);
            let scale = (p + 1) as f32;
            for ((to, slope), power) in feature_slopes.iter_mut().zip(&*power_slopes).zip(&*powers)
            {
                *to += scale * power * slope;
            }
        }
    }
}

/// What a layer's pass works in.
struct Scratch<'a> {
    laplacians: &'a [f32],
    powers: &'a mut [f32],
    power_slopes: &'a mut [f32],
    sums: [&'a mut [f32]; 2],
}

/// Writes every entry to the power `exponent`.
fn raise(from: &[f32], exponent: usize, to: &mut [f32]) {
    match exponent {
        0 => to.fill(1.0),
        1 => to.copy_from_slice(from),
        _ => {
            for (to, &from) in to.iter_mut().zip(from) {
                *to = (1..exponent).fold(from, |power, _| power * from);
            }
        }
    }
}
