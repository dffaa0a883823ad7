//! How the decoder reads a sample's capsules: by attention over them, by their mean, and by a logit
//! for each.
//!
//! A sample has one query, so the keys and values of all nodes are never computed. Instead, the
//! query of a head is transformed to the nodes' side (u = W_K q), its scores are C . u, and W_V is
//! applied to the sum that its attention collects, a C. All reads of a sample are rows with the
//! width of a capsule, so they are stored together, and in the backward pass the slopes of the
//! capsules are one product, `factors^T rows`:
//!
//! | rows | factors |
//! |---|---|
//! | slopes of what each head collected | attention |
//! | queries | slopes of the scores |
//! | pointer | slopes of the logits |
//! | slopes of the mean | 1 / N |

use crate::nn::batch::maximum;
use crate::nn::linear::sum_groups;
use crate::nn::product::{Matrix, MatrixMut, Write, multiply};

/// Sizes of the reads.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reads {
    pub(crate) vertiports: usize,
    pub(crate) heads: usize,
    /// Width of a capsule.
    pub(crate) width: usize,
    /// The factor of the scores, 1 / sqrt(d).
    pub(crate) score_scale: f32,
    /// The factor of the logits, 1 / sqrt(h).
    pub(crate) logit_scale: f32,
    /// Whether the heads attend; otherwise each collects the mean.
    pub(crate) attention: bool,
}

/// The rows and factors of the table above, and what the attention collected; sizes for one sample
/// in brackets.
#[derive(Debug)]
pub(crate) struct ReadsSpace {
    /// [(2 heads + 2) x width].
    rows: Vec<f32>,
    /// [(2 heads + 2) x N].
    factors: Vec<f32>,
    /// [heads x width].
    pub(crate) collected: Vec<f32>,
    /// [width].
    pub(crate) means: Vec<f32>,
    /// The shift of all logits of a sample; in the backward pass, its slopes [1].
    logit_shifts: Vec<f32>,
    /// Slopes of the queries and the pointer [(heads + 1) x width].
    query_slopes: Vec<f32>,
}

impl ReadsSpace {
    /// The place to write the shifts of the logits to.
    pub(crate) fn logit_shifts(&mut self, batch: usize) -> MatrixMut<'_> {
        MatrixMut::new(&mut self.logit_shifts[..batch], batch, 1)
    }

    /// The slopes of the shifts.
    pub(crate) fn shift_slopes(&self, batch: usize) -> Matrix<'_> {
        Matrix::new(&self.logit_shifts[..batch], batch, 1)
    }
}

impl Reads {
    fn block(self) -> usize {
        2 * self.heads + 2
    }

    pub(crate) fn space(self, batch: usize) -> ReadsSpace {
        ReadsSpace {
            rows: vec![0.0; batch * self.block() * self.width],
            factors: vec![1.0 / self.vertiports as f32; batch * self.block() * self.vertiports],
            collected: vec![0.0; batch * self.heads * self.width],
            means: vec![0.0; batch * self.width],
            logit_shifts: vec![0.0; batch],
            query_slopes: vec![0.0; batch * (self.heads + 1) * self.width],
        }
    }

    /// One row of every sample's block.
    fn row(self, space: &mut ReadsSpace, batch: usize, row: usize) -> MatrixMut<'_> {
        let rows = &mut space.rows[..batch * self.block() * self.width];
        MatrixMut::new(rows, batch, self.block() * self.width).columns(row * self.width, self.width)
    }

    /// The place to write a head's query on the nodes' side to.
    pub(crate) fn query(self, space: &mut ReadsSpace, batch: usize, head: usize) -> MatrixMut<'_> {
        self.row(space, batch, self.heads + head)
    }

    /// The place to write the pointer to.
    pub(crate) fn pointer(self, space: &mut ReadsSpace, batch: usize) -> MatrixMut<'_> {
        self.row(space, batch, 2 * self.heads)
    }

    /// The place to write the slopes of what a head collected to.
    pub(crate) fn collected_slopes(
        self,
        space: &mut ReadsSpace,
        batch: usize,
        head: usize,
    ) -> MatrixMut<'_> {
        self.row(space, batch, head)
    }

    /// The place to write the slopes of the means to.
    pub(crate) fn mean_slopes(self, space: &mut ReadsSpace, batch: usize) -> MatrixMut<'_> {
        self.row(space, batch, 2 * self.heads + 1)
    }

    /// What a head collected, for every sample.
    pub(crate) fn collected(self, space: &ReadsSpace, batch: usize, head: usize) -> Matrix<'_> {
        let collected = &space.collected[..batch * self.heads * self.width];
        Matrix::new(collected, batch, self.heads * self.width)
            .columns(head * self.width, self.width)
    }

    /// The slopes of a head's query; the index after the last head gives those of the pointer.
    pub(crate) fn query_slopes(self, space: &ReadsSpace, batch: usize, head: usize) -> Matrix<'_> {
        let slopes = &space.query_slopes[..batch * (self.heads + 1) * self.width];
        Matrix::new(slopes, batch, (self.heads + 1) * self.width)
            .columns(head * self.width, self.width)
    }

    /// Computes Eq. 20 for all heads, and the means. The queries must be written first.
    pub(crate) fn attend(self, capsules: &[f32], space: &mut ReadsSpace) {
        let Self { vertiports, heads, width, .. } = self;
        let nodes = capsules.chunks_exact(vertiports * width);
        let rows = space.rows.chunks_exact(self.block() * width);
        let factors = space.factors.chunks_exact_mut(self.block() * vertiports);
        let collected = space.collected.chunks_exact_mut(heads * width);
        for (((nodes, rows), factors), collected) in nodes.zip(rows).zip(factors).zip(collected) {
            let nodes = Matrix::new(nodes, vertiports, width);
            let queries = Matrix::new(&rows[heads * width..][..heads * width], heads, width);
            let attention = &mut factors[..heads * vertiports];
            let scores = MatrixMut::new(attention, heads, vertiports);
            multiply(scores, Write::Set, queries, nodes.transposed());
            if self.attention {
                attention
                    .chunks_exact_mut(vertiports)
                    .for_each(|scores| softmax(scores, self.score_scale));
            } else {
                attention.fill(1.0 / vertiports as f32);
            }
            let attention = Matrix::new(attention, heads, vertiports);
            multiply(MatrixMut::new(collected, heads, width), Write::Set, attention, nodes);
        }
        let batch = capsules.len() / (vertiports * width);
        let means = &mut space.means[..batch * width];
        sum_groups(capsules, vertiports, width, 1.0 / vertiports as f32, means);
    }

    /// Computes the logits of every node, minus infinity where the mask is 0. The pointers and
    /// shifts must be written first.
    pub(crate) fn point(
        self,
        capsules: &[f32],
        mask: &[u8],
        space: &ReadsSpace,
        logits: &mut [f32],
    ) {
        let Self { vertiports, heads, width, .. } = self;
        let nodes = capsules.chunks_exact(vertiports * width);
        let rows = space.rows.chunks_exact(self.block() * width);
        let rows = rows.zip(&space.logit_shifts);
        for ((nodes, (rows, shift)), logits) in
            nodes.zip(rows).zip(logits.chunks_exact_mut(vertiports))
        {
            let pointer = Matrix::new(&rows[2 * heads * width..][..width], 1, width);
            let nodes = Matrix::new(nodes, vertiports, width).transposed();
            logits.fill(*shift);
            multiply(MatrixMut::new(logits, 1, vertiports), Write::Add, pointer, nodes);
        }
        for (logit, &open) in logits.iter_mut().zip(mask) {
            *logit = if open == 0 { f32::NEG_INFINITY } else { *logit * self.logit_scale };
        }
    }

    /// Computes the slopes of pointers and shifts from those of the logits.
    pub(crate) fn point_backward(
        self,
        capsules: &[f32],
        mask: &[u8],
        slopes: &[f32],
        space: &mut ReadsSpace,
    ) {
        let Self { vertiports, heads, width, .. } = self;
        let factors = space.factors.chunks_exact_mut(self.block() * vertiports);
        let of_logits = mask.chunks_exact(vertiports).zip(slopes.chunks_exact(vertiports));
        let nodes = capsules.chunks_exact(vertiports * width);
        let to = space.query_slopes.chunks_exact_mut((heads + 1) * width);
        let to = to.zip(&mut space.logit_shifts);
        for (((mask, slopes), nodes), (factors, (to, shift))) in
            of_logits.zip(nodes).zip(factors.zip(to))
        {
            let factors = &mut factors[2 * heads * vertiports..][..vertiports];
            for ((factor, slope), &open) in factors.iter_mut().zip(slopes).zip(mask) {
                *factor = if open == 0 { 0.0 } else { slope * self.logit_scale };
            }
            *shift = factors.iter().sum();
            let to = MatrixMut::new(&mut to[heads * width..], 1, width);
            let nodes = Matrix::new(nodes, vertiports, width);
            multiply(to, Write::Set, Matrix::new(factors, 1, vertiports), nodes);
        }
    }

    /// Computes the slopes of the queries from those of what was collected, and the slopes of the
    /// capsules from all reads together.
    pub(crate) fn attend_backward(
        self,
        capsules: &[f32],
        space: &mut ReadsSpace,
        slopes: &mut [f32],
    ) {
        let Self { vertiports, heads, width, .. } = self;
        let nodes = capsules.chunks_exact(vertiports * width);
        let rows = space.rows.chunks_exact(self.block() * width);
        let factors = space.factors.chunks_exact_mut(self.block() * vertiports);
        let to = space.query_slopes.chunks_exact_mut((heads + 1) * width);
        let slopes = slopes.chunks_exact_mut(vertiports * width);
        for ((((nodes, rows), factors), to), slopes) in
            nodes.zip(rows).zip(factors).zip(to).zip(slopes)
        {
            let nodes = Matrix::new(nodes, vertiports, width);
            let collected = Matrix::new(&rows[..heads * width], heads, width);
            let (attention, rest) = factors.split_at_mut(heads * vertiports);
            let scores = &mut rest[..heads * vertiports];
            multiply(
                MatrixMut::new(scores, heads, vertiports),
                Write::Set,
                collected,
                nodes.transposed(),
            );
            let of_heads =
                attention.chunks_exact(vertiports).zip(scores.chunks_exact_mut(vertiports));
            of_heads.for_each(|(attention, slopes)| {
                let scale = if self.attention { self.score_scale } else { 0.0 };
                softmax_backward(attention, slopes, scale);
            });
            let to = MatrixMut::new(&mut to[..heads * width], heads, width);
            multiply(to, Write::Set, Matrix::new(scores, heads, vertiports), nodes);

            let factors = Matrix::new(factors, self.block(), vertiports).transposed();
            let rows = Matrix::new(rows, self.block(), width);
            multiply(MatrixMut::new(slopes, vertiports, width), Write::Set, factors, rows);
        }
    }
}

/// Replaces the scores by the softmax of `scale` times the scores.
pub(crate) fn softmax(scores: &mut [f32], scale: f32) {
    let highest = maximum(scores.iter().copied());
    let mut total = 0.0;
    for score in &mut *scores {
        *score = ((*score - highest) * scale).exp();
        total += *score;
    }
    for score in scores {
        *score /= total;
    }
}

/// Replaces the slopes of the softmax by those of its scores.
pub(crate) fn softmax_backward(softmax: &[f32], slopes: &mut [f32], scale: f32) {
    let mean: f32 = softmax.iter().zip(&*slopes).map(|(weight, slope)| weight * slope).sum();
    for (slope, weight) in slopes.iter_mut().zip(softmax) {
        *slope = scale * weight * (*slope - mean);
    }
}
