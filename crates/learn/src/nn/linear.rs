//! Linear layers `y = x W + b` on row-major batches, and the arithmetic on rows that goes with
//! them.

use crate::nn::init::Init;
use crate::nn::layout::{Layout, Slot, Tensors};
use crate::nn::product::{Matrix, MatrixMut, Write, multiply};

/// The places of a linear layer's weights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Linear {
    pub(crate) weight: Slot,
    pub(crate) bias: Slot,
}

impl Linear {
    /// Adds the layer's tensors.
    pub(crate) fn new(
        layout: &mut Layout,
        name: &str,
        (from, to): (usize, usize),
        gain: f32,
    ) -> Self {
        let init = Init::Uniform { inputs: from, gain };
        Self {
            weight: layout.matrix(&format!("{name}.weight"), (from, to), init),
            bias: layout.vector(&format!("{name}.bias"), to, Init::Zero),
        }
    }

    /// Computes `to = from W + b`.
    pub(crate) fn forward(self, tensors: Tensors<'_>, from: &[f32], to: &mut [f32]) {
        let rows = to.len() / self.weight.columns;
        repeat(tensors.part(self.bias), to);
        let from = Matrix::new(from, rows, self.weight.rows);
        let to = MatrixMut::new(to, rows, self.weight.columns);
        multiply(to, Write::Add, from, tensors.matrix(self.weight));
    }

    /// Adds the slopes of W and b.
    pub(crate) fn backward(self, from: &[f32], slopes: &[f32], gradient: &mut [f32]) {
        add_weight_slopes(self.weight, from, slopes, gradient);
        add_rows(slopes, self.bias.part_mut(gradient));
    }

    /// Computes the slopes of the layer's input.
    pub(crate) fn input_slopes(
        self,
        tensors: Tensors<'_>,
        slopes: &[f32],
        write: Write,
        to: &mut [f32],
    ) {
        let rows = slopes.len() / self.weight.columns;
        let slopes = Matrix::new(slopes, rows, self.weight.columns);
        let to = MatrixMut::new(to, rows, self.weight.rows);
        multiply(to, write, slopes, tensors.matrix(self.weight).transposed());
    }
}

/// Adds the slopes of W in `y = x W`.
pub(crate) fn add_weight_slopes(weight: Slot, from: &[f32], slopes: &[f32], gradient: &mut [f32]) {
    let rows = from.len() / weight.rows;
    let from = Matrix::new(from, rows, weight.rows);
    let slopes = Matrix::new(slopes, rows, weight.columns);
    multiply(weight.matrix_mut(gradient), Write::Add, from.transposed(), slopes);
}

/// Writes one row into every row of `to`.
pub(crate) fn repeat(row: &[f32], to: &mut [f32]) {
    for to in to.chunks_exact_mut(row.len()) {
        to.copy_from_slice(row);
    }
}

/// Adds one slice to another.
pub(crate) fn add(from: &[f32], to: &mut [f32]) {
    debug_assert_eq!(from.len(), to.len());
    for (to, from) in to.iter_mut().zip(from) {
        *to += from;
    }
}

/// Adds every row of `rows` to `to`.
pub(crate) fn add_rows(rows: &[f32], to: &mut [f32]) {
    for row in rows.chunks_exact(to.len()) {
        add(row, to);
    }
}

/// Sums each group of `group` rows of `width` entries and multiplies the sum by `factor`, giving
/// one row of `to` per group.
pub(crate) fn sum_groups(rows: &[f32], group: usize, width: usize, factor: f32, to: &mut [f32]) {
    for (rows, to) in rows.chunks_exact(group * width).zip(to.chunks_exact_mut(width)) {
        to.fill(0.0);
        add_rows(rows, to);
        for sum in to {
            *sum *= factor;
        }
    }
}

/// The dot product, in eight partial sums that the compiler keeps in vector registers.
pub(crate) fn dot(left: &[f32], right: &[f32]) -> f32 {
    debug_assert_eq!(left.len(), right.len());
    let (left, left_rest) = left.as_chunks::<8>();
    let (right, right_rest) = right.as_chunks::<8>();
    let mut strands = [0.0_f32; 8];
    for (left, right) in left.iter().zip(right) {
        for (strand, (left, right)) in strands.iter_mut().zip(left.iter().zip(right)) {
            *strand += left * right;
        }
    }
    let rest: f32 = left_rest.iter().zip(right_rest).map(|(left, right)| left * right).sum();
    strands.iter().sum::<f32>() + rest
}
