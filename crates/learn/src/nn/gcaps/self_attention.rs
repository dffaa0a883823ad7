//! An encoder without a graph: layers of self-attention (Vaswani et al., 2017), in which every
//! vertiport attends to all others. It is the baseline of the graph capsules.
//!
//! ```text
//! A = softmax(Q K^T / sqrt(d)) of each head, with Q = F W_Q, K = F W_K, V = F W_V
//! G = LayerNorm(F + [A V of all heads] W_O)
//! F' = LayerNorm(G + ReLU(G W_1 + b_1) W_2 + b_2)
//! ```

use crate::nn::batch::Inputs;
use crate::nn::gcaps::reads::{softmax, softmax_backward};
use crate::nn::init::{self, Init};
use crate::nn::layer_norm::{LayerNorm, Normalised};
use crate::nn::layout::{Layout, Slot, Tensors};
use crate::nn::linear::{Linear, add, add_weight_slopes};
use crate::nn::product::{Matrix, MatrixMut, Write, multiply};
use crate::nn::relu;

/// Sizes and weights of the layers.
#[derive(Debug, Clone)]
pub(crate) struct SelfAttention {
    vertiports: usize,
    width: usize,
    heads: usize,
    /// W_0, b_0.
    node: Linear,
    layers: Vec<AttentionLayer>,
}

/// One layer.
#[derive(Debug, Clone, Copy)]
struct AttentionLayer {
    /// W_Q, W_K, W_V.
    reads: [Slot; 3],
    /// W_O.
    output: Slot,
    first_norm: LayerNorm,
    lift: Linear,
    lower: Linear,
    second_norm: LayerNorm,
}

/// The working memory of the layers.
#[derive(Debug)]
pub(crate) struct AttentionSpace {
    /// The features that each layer reads, then the output of the last one, [N x h] for a sample.
    features: Vec<Vec<f32>>,
    layers: Vec<LayerSpace>,
    /// Slopes of a layer's features, and two more rows of scratch, [N x h] for a sample.
    slopes: [Vec<f32>; 3],
    /// Slopes of queries, keys and values.
    read_slopes: [Vec<f32>; 3],
    /// Slopes of the attention of one head [N x N].
    score_slopes: Vec<f32>,
}

/// The state of a layer that the backward pass needs.
#[derive(Debug)]
struct LayerSpace {
    /// Q, K, V.
    reads: [Vec<f32>; 3],
    /// A of every head [heads x N x N].
    attention: Vec<f32>,
    collected: Vec<f32>,
    first_norm: Normalised,
    middle: Vec<f32>,
    lifted: Vec<f32>,
    second_norm: Normalised,
}

impl SelfAttention {
    /// Adds the tensors of the layers.
    pub(crate) fn new(
        layout: &mut Layout,
        (vertiports, node_features): (usize, usize),
        (width, heads): (usize, usize),
        layers: usize,
    ) -> Self {
        let node = Linear::new(layout, "encoder.node", (node_features, width), 1.0);
        let square = (width, width);
        let plain = Init::Uniform { inputs: width, gain: 1.0 };
        let layer = |number: usize| {
            let name = |part: &str| format!("encoder.layer_{number}.{part}");
            AttentionLayer {
                reads: ["query", "key", "value"]
                    .map(|read| layout.matrix(&name(&format!("{read}.weight")), square, plain)),
                output: layout.matrix(&name("output.weight"), square, plain),
                first_norm: LayerNorm::new(layout, &name("norm_1"), width),
                lift: Linear::new(layout, &name("lift"), (width, 2 * width), init::BEFORE_RELU),
                lower: Linear::new(layout, &name("lower"), (2 * width, width), 1.0),
                second_norm: LayerNorm::new(layout, &name("norm_2"), width),
            }
        };
        let layers = (1..=layers).map(layer).collect();
        Self { vertiports, width, heads, node, layers }
    }

    pub(crate) fn space(&self, batch: usize) -> AttentionSpace {
        let nodes = batch * self.vertiports;
        let rows = || vec![0.0; nodes * self.width];
        let layer = || LayerSpace {
            reads: [rows(), rows(), rows()],
            attention: vec![0.0; nodes * self.heads * self.vertiports],
            collected: rows(),
            first_norm: Normalised::new(nodes, self.width),
            middle: rows(),
            lifted: vec![0.0; nodes * 2 * self.width],
            second_norm: Normalised::new(nodes, self.width),
        };
        AttentionSpace {
            features: (0..=self.layers.len()).map(|_| rows()).collect(),
            layers: self.layers.iter().map(|_| layer()).collect(),
            slopes: [rows(), rows(), vec![0.0; nodes * 2 * self.width]],
            read_slopes: [rows(), rows(), rows()],
            score_slopes: vec![0.0; self.vertiports * self.vertiports],
        }
    }

    /// The embeddings of a batch after a forward pass.
    pub(crate) fn read<'space>(
        &self,
        space: &'space AttentionSpace,
        batch: usize,
    ) -> &'space [f32] {
        &space.features[self.layers.len()][..batch * self.vertiports * self.width]
    }

    /// Computes the embeddings.
    pub(crate) fn forward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        space: &mut AttentionSpace,
    ) {
        let len = inputs.batch * self.vertiports * self.width;
        self.node.forward(tensors, inputs.nodes, &mut space.features[0][..len]);
        let AttentionSpace { features, layers, slopes: [sums, ..], .. } = space;
        for (at, (layer, kept)) in self.layers.iter().zip(layers).enumerate() {
            let [from, to] = features[at..].first_chunk_mut().expect("features before and after");
            let (from, to, sums) = (&from[..len], &mut to[..len], &mut sums[..len]);
            for (weight, read) in layer.reads.iter().zip(&mut kept.reads) {
                product(tensors, *weight, from, Write::Set, &mut read[..len]);
            }
            self.attend(inputs.batch, kept);
            sums.copy_from_slice(from);
            product(tensors, layer.output, &kept.collected[..len], Write::Add, sums);
            let middle = &mut kept.middle[..len];
            layer.first_norm.forward(tensors, sums, &mut kept.first_norm, middle);
            let lifted = &mut kept.lifted[..2 * len];
            layer.lift.forward(tensors, middle, lifted);
            relu::forward(lifted);
            layer.lower.forward(tensors, lifted, sums);
            add(middle, sums);
            layer.second_norm.forward(tensors, sums, &mut kept.second_norm, to);
        }
    }

    fn score_scale(&self) -> f32 {
        1.0 / ((self.width / self.heads) as f32).sqrt()
    }

    /// Computes what each head collects.
    fn attend(&self, batch: usize, kept: &mut LayerSpace) {
        let (count, width, each) = (self.vertiports, self.width, self.width / self.heads);
        let [queries, keys, values] = &kept.reads;
        for sample in 0..batch {
            let rows = sample * count * width..(sample + 1) * count * width;
            let [queries, keys, values] =
                [queries, keys, values].map(|read| Matrix::new(&read[rows.clone()], count, width));
            for head in 0..self.heads {
                let [queries, keys, values] =
                    [queries, keys, values].map(|rows| rows.columns(head * each, each));
                let first = (sample * self.heads + head) * count * count;
                let attention = &mut kept.attention[first..][..count * count];
                let scores = MatrixMut::new(attention, count, count);
                multiply(scores, Write::Set, queries, keys.transposed());
                let scale = self.score_scale();
                attention.chunks_exact_mut(count).for_each(|scores| softmax(scores, scale));
                let to = MatrixMut::new(&mut kept.collected[rows.clone()], count, width);
                let attention = Matrix::new(attention, count, count);
                multiply(to.columns(head * each, each), Write::Set, attention, values);
            }
        }
    }

    /// Adds the slopes of all weights; `slopes` are those of the embeddings.
    pub(crate) fn backward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        space: &mut AttentionSpace,
        slopes: &[f32],
        gradient: &mut [f32],
    ) {
        let len = slopes.len();
        space.slopes[0][..len].copy_from_slice(slopes);
        for at in (0..self.layers.len()).rev() {
            let layer = &self.layers[at];
            let kept = &space.layers[at];
            let [slopes, sums, lifted_slopes] = &mut space.slopes;
            let (slopes, sums) = (&mut slopes[..len], &mut sums[..len]);
            let lifted_slopes = &mut lifted_slopes[..2 * len];
            layer.second_norm.backward(tensors, &kept.second_norm, slopes, gradient);
            let lifted = &kept.lifted[..2 * len];
            layer.lower.backward(lifted, slopes, gradient);
            layer.lower.input_slopes(tensors, slopes, Write::Set, lifted_slopes);
            relu::backward(lifted, lifted_slopes);
            layer.lift.backward(&kept.middle[..len], lifted_slopes, gradient);
            layer.lift.input_slopes(tensors, lifted_slopes, Write::Add, slopes);
            layer.first_norm.backward(tensors, &kept.first_norm, slopes, gradient);

            add_weight_slopes(layer.output, &kept.collected[..len], slopes, gradient);
            back_product(tensors, layer.output, slopes, Write::Set, sums);
            self.attend_backward(
                inputs.batch,
                kept,
                sums,
                &mut space.read_slopes,
                &mut space.score_slopes,
            );
            let from = &space.features[at][..len];
            for (weight, read) in layer.reads.iter().zip(&space.read_slopes) {
                add_weight_slopes(*weight, from, &read[..len], gradient);
                back_product(tensors, *weight, &read[..len], Write::Add, slopes);
            }
        }
        self.node.backward(inputs.nodes, &space.slopes[0][..len], gradient);
    }

    /// Computes the slopes of queries, keys and values from those of what the heads collected.
    fn attend_backward(
        &self,
        batch: usize,
        kept: &LayerSpace,
        slopes: &[f32],
        read_slopes: &mut [Vec<f32>; 3],
        score_slopes: &mut [f32],
    ) {
        let (count, width, each) = (self.vertiports, self.width, self.width / self.heads);
        for sample in 0..batch {
            let rows = sample * count * width..(sample + 1) * count * width;
            let slopes = Matrix::new(&slopes[rows.clone()], count, width);
            let [queries, keys, values] =
                kept.reads.each_ref().map(|read| Matrix::new(&read[rows.clone()], count, width));
            let [to_queries, to_keys, to_values] = read_slopes;
            for head in 0..self.heads {
                let first = (sample * self.heads + head) * count * count;
                let attention = &kept.attention[first..][..count * count];
                let [slopes, queries, keys, values] =
                    [slopes, queries, keys, values].map(|rows| rows.columns(head * each, each));
                let weights = Matrix::new(attention, count, count).transposed();
                let to = MatrixMut::new(&mut to_values[rows.clone()], count, width);
                multiply(to.columns(head * each, each), Write::Set, weights, slopes);
                let scores = MatrixMut::new(score_slopes, count, count);
                multiply(scores, Write::Set, slopes, values.transposed());
                let rows_of_scores = score_slopes.chunks_exact_mut(count);
                for (attention, slopes) in attention.chunks_exact(count).zip(rows_of_scores) {
                    softmax_backward(attention, slopes, self.score_scale());
                }
                let scores = Matrix::new(score_slopes, count, count);
                let to = MatrixMut::new(&mut to_queries[rows.clone()], count, width);
                multiply(to.columns(head * each, each), Write::Set, scores, keys);
                let to = MatrixMut::new(&mut to_keys[rows.clone()], count, width);
                multiply(to.columns(head * each, each), Write::Set, scores.transposed(), queries);
            }
        }
    }
}

/// `to = from W`, written as `write` specifies.
fn product(tensors: Tensors<'_>, weight: Slot, from: &[f32], write: Write, to: &mut [f32]) {
    let rows = from.len() / weight.rows;
    let from = Matrix::new(from, rows, weight.rows);
    multiply(MatrixMut::new(to, rows, weight.columns), write, from, tensors.matrix(weight));
}

/// The slopes of `from` in [`product`].
fn back_product(tensors: Tensors<'_>, weight: Slot, slopes: &[f32], write: Write, to: &mut [f32]) {
    let rows = slopes.len() / weight.columns;
    let slopes = Matrix::new(slopes, rows, weight.columns);
    let to = MatrixMut::new(to, rows, weight.rows);
    multiply(to, write, slopes, tensors.matrix(weight).transposed());
}
