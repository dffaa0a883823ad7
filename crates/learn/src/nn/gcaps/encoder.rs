//! The paper's graph-capsule encoder (§IV.A.1, Eq. 18 and 19) on the complete graph, with P = 2,
//! K = 2 and one layer.
//!
//! The convolutions use powers of L / N instead of L = D - A. This gives the same family of
//! functions (W_pa = V_pa / N^a) with all terms on one scale. On the complete graph, L / N
//! subtracts the mean over the nodes, and subtracting it twice is the same as once. Hence, with S =
//! V_p0 + V_p1 + V_p2 and T = V_p1 + V_p2,
//!
//! ```text
//! sum over a of (L/N)^a F V_pa  =  F S - mean(F) T
//! ```
//!
//! which is one product for all nodes and one for their mean. For p = 1, F is linear in the
//! features, so that branch reads the features themselves: X (W_0 S) - mean(X) (W_0 T) + b_0 V_10.
//! The products of weights are in [`EncoderProducts`](super::products::EncoderProducts).

use crate::nn::batch::Inputs;
use crate::nn::gcaps::products::EncoderProducts;
use crate::nn::layout::Tensors;
use crate::nn::linear::{Linear, add, add_rows, repeat, sum_groups};
use crate::nn::product::{Matrix, MatrixMut, Write, multiply};
use crate::nn::relu;

/// The working memory of the encoder; sizes for one sample in brackets.
#[derive(Debug)]
pub(crate) struct EncoderSpace {
    /// Mean features [F].
    feature_means: Vec<f32>,
    /// F_0 [N x h].
    embeddings: Vec<f32>,
    /// The square of F_0, entry by entry [N x h]; in the backward pass, its slopes.
    squares: Vec<f32>,
    /// Mean of the squares [h].
    square_means: Vec<f32>,
    /// One row of h per sample.
    sample_rows: Vec<f32>,
    /// [f_1, f_2] of Eq. 19 [N x 2h].
    pub(crate) capsules: Vec<f32>,
}

/// Sizes and weights of the encoder.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Encoder {
    pub(crate) vertiports: usize,
    pub(crate) width: usize,
    /// W_0, b_0.
    pub(crate) node: Linear,
    pub(crate) products: EncoderProducts,
}

impl EncoderSpace {
    pub(crate) fn new(encoder: &Encoder, batch: usize) -> Self {
        let (nodes, width) = (batch * encoder.vertiports, encoder.width);
        Self {
            feature_means: vec![0.0; batch * encoder.node.weight.rows],
            embeddings: vec![0.0; nodes * width],
            squares: vec![0.0; nodes * width],
            square_means: vec![0.0; batch * width],
            sample_rows: vec![0.0; batch * width],
            capsules: vec![0.0; nodes * 2 * width],
        }
    }
}

impl Encoder {
    /// Computes the capsules.
    pub(crate) fn forward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        space: &mut EncoderSpace,
    ) {
        let products = self.products;
        let (batch, width, features) = (inputs.batch, self.width, self.node.weight.rows);
        let nodes = batch * self.vertiports;
        let over_nodes = 1.0 / self.vertiports as f32;
        let embeddings = &mut space.embeddings[..nodes * width];
        let squares = &mut space.squares[..nodes * width];
        let square_means = &mut space.square_means[..batch * width];
        let feature_means = &mut space.feature_means[..batch * features];
        let rows = &mut space.sample_rows[..batch * width];
        let capsules = &mut space.capsules[..nodes * 2 * width];

        sum_groups(inputs.nodes, self.vertiports, features, over_nodes, feature_means);
        self.node.forward(tensors, inputs.nodes, embeddings);
        for (square, embedding) in squares.iter_mut().zip(&*embeddings) {
            *square = embedding * embedding;
        }
        sum_groups(squares, self.vertiports, width, over_nodes, square_means);

        let means = Matrix::new(feature_means, batch, features);
        repeat(tensors.part(products.first_shift), rows);
        multiply(
            MatrixMut::new(rows, batch, width),
            Write::Subtract,
            means,
            tensors.matrix(products.first_mean),
        );
        self.spread(rows, 0, capsules);
        let means = Matrix::new(square_means, batch, width);
        rows.fill(0.0);
        multiply(
            MatrixMut::new(rows, batch, width),
            Write::Subtract,
            means,
            tensors.matrix(products.second_mean),
        );
        self.spread(rows, width, capsules);

        let first = MatrixMut::new(capsules, nodes, 2 * width).columns(0, width);
        let from = Matrix::new(inputs.nodes, nodes, features);
        multiply(first, Write::Add, from, tensors.matrix(products.first_node));
        let second = MatrixMut::new(capsules, nodes, 2 * width).columns(width, width);
        let from = Matrix::new(squares, nodes, width);
        multiply(second, Write::Add, from, tensors.matrix(products.second_node));
        relu::forward(capsules);
    }

    /// Writes each sample's row into the columns from `first` on of the capsules of all its nodes.
    fn spread(&self, rows: &[f32], first: usize, capsules: &mut [f32]) {
        let of_samples = capsules.chunks_exact_mut(self.vertiports * 2 * self.width);
        for (row, capsules) in rows.chunks_exact(self.width).zip(of_samples) {
            for capsule in capsules.chunks_exact_mut(2 * self.width) {
                capsule[first..][..self.width].copy_from_slice(row);
            }
        }
    }

    /// Sums the columns from `first` on over the nodes of each sample.
    fn gather(&self, slopes: &[f32], first: usize, rows: &mut [f32]) {
        let of_samples = slopes.chunks_exact(self.vertiports * 2 * self.width);
        for (row, slopes) in rows.chunks_exact_mut(self.width).zip(of_samples) {
            row.fill(0.0);
            for slopes in slopes.chunks_exact(2 * self.width) {
                add(&slopes[first..][..self.width], row);
            }
        }
    }

    /// Adds the slopes of W_0, b_0 and the products. `slopes` are those of the capsules; they are
    /// overwritten.
    pub(crate) fn backward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        space: &mut EncoderSpace,
        slopes: &mut [f32],
        gradient: &mut [f32],
    ) {
        let products = self.products;
        let (batch, width, features) = (inputs.batch, self.width, self.node.weight.rows);
        let nodes = batch * self.vertiports;
        let over_nodes = 1.0 / self.vertiports as f32;
        let squares = &mut space.squares[..nodes * width];
        let rows = &mut space.sample_rows[..batch * width];
        relu::backward(&space.capsules[..nodes * 2 * width], slopes);
        let both = Matrix::new(slopes, nodes, 2 * width);
        let (first, second) = (both.columns(0, width), both.columns(width, width));

        self.gather(slopes, 0, rows);
        add_rows(rows, products.first_shift.part_mut(gradient));
        let from = Matrix::new(inputs.nodes, nodes, features);
        multiply(products.first_node.matrix_mut(gradient), Write::Add, from.transposed(), first);
        let means = Matrix::new(&space.feature_means[..batch * features], batch, features);
        let sums = Matrix::new(rows, batch, width);
        multiply(
            products.first_mean.matrix_mut(gradient),
            Write::Subtract,
            means.transposed(),
            sums,
        );

        self.gather(slopes, width, rows);
        let from = Matrix::new(squares, nodes, width);
        multiply(products.second_node.matrix_mut(gradient), Write::Add, from.transposed(), second);
        let means = Matrix::new(&space.square_means[..batch * width], batch, width);
        let sums = Matrix::new(rows, batch, width);
        multiply(
            products.second_mean.matrix_mut(gradient),
            Write::Subtract,
            means.transposed(),
            sums,
        );

        // A square's slope has two parts: one through the node's own term, and one through the
        // mean, which is the same for all nodes of a sample.
        let mean_slopes = &mut space.square_means[..batch * width];
        let to = MatrixMut::new(mean_slopes, batch, width);
        multiply(to, Write::Set, sums, tensors.matrix(products.second_mean).transposed());
        let of_samples = squares.chunks_exact_mut(self.vertiports * width);
        for (squares, row) in of_samples.zip(mean_slopes.chunks_exact(width)) {
            for square in squares.chunks_exact_mut(width) {
                for (square, slope) in square.iter_mut().zip(row) {
                    *square = -over_nodes * slope;
                }
            }
        }
        let to = MatrixMut::new(squares, nodes, width);
        multiply(to, Write::Add, second, tensors.matrix(products.second_node).transposed());
        for (slope, embedding) in squares.iter_mut().zip(&space.embeddings) {
            *slope *= 2.0 * embedding;
        }
        self.node.backward(inputs.nodes, squares, gradient);
    }
}
