//! The graph between the vertiports of a decision: its adjacency A and its Laplacian L, which the
//! general encoder multiplies features by.
//!
//! With the degrees D on the diagonal, L is (D - A) / N, or I - D^-1 A if it is normalised. The
//! first is what §IV writes, divided by the number of vertiports so that graphs of all sizes have
//! one scale; on the complete graph both take the mean away. A route that is not flown in one
//! direction has no weight in that direction, so A need not be symmetric.

use crate::nn::architecture::{Adjacency, Laplacian};
use crate::nn::batch::Inputs;
use crate::nn::product::{Matrix, MatrixMut, Write, multiply};

/// How graphs are made.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Graph {
    pub(crate) nodes: usize,
    pub(crate) node_features: usize,
    pub(crate) adjacency: Adjacency,
    pub(crate) laplacian: Laplacian,
}

impl Graph {
    /// Writes L of every decision, [B x N x N].
    pub(crate) fn write(self, inputs: Inputs<'_>, laplacians: &mut [f32]) {
        let count = self.nodes;
        for (at, laplacian) in laplacians.chunks_exact_mut(count * count).enumerate() {
            match self.adjacency {
                Adjacency::Complete => laplacian.fill(1.0),
                Adjacency::Similarity => {
                    let size = count * self.node_features;
                    similarities(&inputs.nodes[at * size..][..size], count, laplacian);
                }
                Adjacency::Distance | Adjacency::Reachable | Adjacency::Profit => {
                    laplacian.copy_from_slice(&inputs.edges[at * count * count..][..count * count]);
                }
            }
            self.turn_into_laplacian(laplacian);
        }
    }

    /// Replaces A by L.
    fn turn_into_laplacian(self, adjacency: &mut [f32]) {
        let count = self.nodes;
        for (from, row) in adjacency.chunks_exact_mut(count).enumerate() {
            row[from] = 0.0;
            let degree: f32 = row.iter().sum();
            let scale = match self.laplacian {
                Laplacian::Plain => 1.0 / count as f32,
                Laplacian::Normalised if degree > 0.0 => 1.0 / degree,
                Laplacian::Normalised => 0.0,
            };
            for weight in &mut *row {
                *weight *= -scale;
            }
            row[from] = degree * scale;
        }
    }
}

/// 1 / (1 + ||x_i - x_j||) for every pair of nodes, as the authors' code has it.
fn similarities(nodes: &[f32], count: usize, to: &mut [f32]) {
    let width = nodes.len() / count;
    for (one, row) in nodes.chunks_exact(width).zip(to.chunks_exact_mut(count)) {
        for (other, weight) in nodes.chunks_exact(width).zip(row) {
            let squares = one.iter().zip(other).map(|(one, other)| (one - other) * (one - other));
            *weight = 1.0 / (1.0 + squares.sum::<f32>().sqrt());
        }
    }
}

/// Adds L X of every decision to `to`.
pub(crate) fn add_product(
    laplacians: &[f32],
    count: usize,
    width: usize,
    from: &[f32],
    to: &mut [f32],
) {
    for (laplacian, from, to) in factors(laplacians, count, width, from, to) {
        multiply(to, Write::Add, laplacian, from);
    }
}

/// Adds the transpose of L times X of every decision to `to`.
pub(crate) fn add_transposed_product(
    laplacians: &[f32],
    count: usize,
    width: usize,
    from: &[f32],
    to: &mut [f32],
) {
    for (laplacian, from, to) in factors(laplacians, count, width, from, to) {
        multiply(to, Write::Add, laplacian.transposed(), from);
    }
}

/// L, X and what their product is added to, of every decision.
fn factors<'a>(
    laplacians: &'a [f32],
    count: usize,
    width: usize,
    from: &'a [f32],
    to: &'a mut [f32],
) -> impl Iterator<Item = (Matrix<'a>, Matrix<'a>, MatrixMut<'a>)> {
    let laplacians = laplacians.chunks_exact(count * count);
    let from = from.chunks_exact(count * width).map(move |from| Matrix::new(from, count, width));
    let to = to.chunks_exact_mut(count * width).map(move |to| MatrixMut::new(to, count, width));
    let square = move |laplacian| Matrix::new(laplacian, count, count);
    laplacians.map(square).zip(from).zip(to).map(|((laplacian, from), to)| (laplacian, from, to))
}
