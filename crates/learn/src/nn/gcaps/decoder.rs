//! The decoder (§IV.B, Eq. 20 and 21), the logits and the value.
//!
//! ```text
//! q = psi W_Q + b_Q
//! z = LayerNorm(q + MHA(q, E))
//! y = LayerNorm(z + ReLU(z W_1 + b_1))
//! logit_i = (y W_L) . E_i / sqrt(h)
//! v = head of [mean E, y, clock]
//! ```
//!
//! The embeddings E = C W_f + b_f of the capsules C are never computed. Each reader of the
//! embeddings multiplies them by a matrix, so the product of W_f and that matrix, taken once per
//! change of the weights ([`Products`]), is applied to the capsules instead. b_f adds a constant
//! shift to the result.

use crate::nn::batch::{Inputs, Outputs, Slopes};
use crate::nn::gcaps::products::Products;
use crate::nn::gcaps::reads::{Reads, ReadsSpace};
use crate::nn::layer_norm::{LayerNorm, Normalised};
use crate::nn::layout::{Slot, Tensors};
use crate::nn::linear::{Linear, add, add_rows, add_weight_slopes, repeat};
use crate::nn::product::{Matrix, MatrixMut, Write, multiply};
use crate::nn::relu;
use crate::nn::value_head::ValueHead;

/// Sizes and weights of the decoder.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Decoder {
    pub(crate) reads: Reads,
    pub(crate) query: Linear,
    /// W_O.
    pub(crate) output: Slot,
    pub(crate) first_norm: LayerNorm,
    pub(crate) feed_forward: Linear,
    pub(crate) second_norm: LayerNorm,
    pub(crate) head: ValueHead,
    pub(crate) products: Products,
}

/// The working memory of the decoder: rows of h entries, one per sample, and the reads.
#[derive(Debug)]
pub(crate) struct DecoderSpace {
    pub(crate) reads: ReadsSpace,
    query: Vec<f32>,
    heads: Vec<f32>,
    sum: Vec<f32>,
    first_norm: Normalised,
    z: Vec<f32>,
    lifted: Vec<f32>,
    second_norm: Normalised,
    y: Vec<f32>,
    hidden: Vec<f32>,
    /// Slopes of y, which the backward pass turns into those of the layers below.
    slopes: Vec<f32>,
    branch_slopes: Vec<f32>,
}

/// The output of the encoder, and the place for its slopes.
pub(crate) struct Capsules<'a> {
    pub(crate) values: &'a [f32],
    pub(crate) slopes: &'a mut [f32],
}

impl DecoderSpace {
    pub(crate) fn new(decoder: &Decoder, batch: usize) -> Self {
        let width = decoder.output.columns;
        let rows = || vec![0.0; batch * width];
        Self {
            reads: decoder.reads.space(batch),
            query: rows(),
            heads: rows(),
            sum: rows(),
            first_norm: Normalised::new(batch, width),
            z: rows(),
            lifted: rows(),
            second_norm: Normalised::new(batch, width),
            y: rows(),
            hidden: rows(),
            slopes: rows(),
            branch_slopes: rows(),
        }
    }

    /// The part of the memory that a batch uses.
    fn rows(&mut self, len: usize) -> Rows<'_> {
        Rows {
            query: &mut self.query[..len],
            heads: &mut self.heads[..len],
            sum: &mut self.sum[..len],
            z: &mut self.z[..len],
            lifted: &mut self.lifted[..len],
            y: &mut self.y[..len],
            hidden: &mut self.hidden[..len],
            slopes: &mut self.slopes[..len],
            branch_slopes: &mut self.branch_slopes[..len],
            reads: &mut self.reads,
            first_norm: &mut self.first_norm,
            second_norm: &mut self.second_norm,
        }
    }
}

/// The working memory of one batch.
struct Rows<'a> {
    query: &'a mut [f32],
    heads: &'a mut [f32],
    sum: &'a mut [f32],
    z: &'a mut [f32],
    lifted: &'a mut [f32],
    y: &'a mut [f32],
    hidden: &'a mut [f32],
    slopes: &'a mut [f32],
    branch_slopes: &'a mut [f32],
    reads: &'a mut ReadsSpace,
    first_norm: &'a mut Normalised,
    second_norm: &'a mut Normalised,
}

impl Decoder {
    fn width(&self) -> usize {
        self.output.columns
    }

    /// Number of columns of one head in a row of all heads.
    fn head_width(&self) -> usize {
        self.width() / self.reads.heads
    }

    /// Computes logits and values from capsules.
    pub(crate) fn forward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        capsules: &[f32],
        space: &mut DecoderSpace,
        outputs: &mut Outputs,
    ) {
        let (batch, width) = (inputs.batch, self.width());
        let rows = space.rows(batch * width);
        self.query.forward(tensors, inputs.aircraft, rows.query);
        self.attend(tensors, batch, capsules, rows.query, rows.reads, rows.heads);

        rows.sum.copy_from_slice(rows.query);
        let heads = Matrix::new(rows.heads, batch, width);
        multiply(
            MatrixMut::new(rows.sum, batch, width),
            Write::Add,
            heads,
            tensors.matrix(self.output),
        );
        self.first_norm.forward(tensors, rows.sum, rows.first_norm, rows.z);
        self.feed_forward.forward(tensors, rows.z, rows.lifted);
        relu::forward(rows.lifted);
        rows.sum.copy_from_slice(rows.z);
        add(rows.lifted, rows.sum);
        self.second_norm.forward(tensors, rows.sum, rows.second_norm, rows.y);

        let y = Matrix::new(rows.y, batch, width);
        multiply(
            self.reads.pointer(rows.reads, batch),
            Write::Set,
            y,
            tensors.matrix(self.products.pointer),
        );
        let shift = tensors.matrix(self.products.pointer_shift).transposed();
        multiply(rows.reads.logit_shifts(batch), Write::Set, y, shift);
        let logits = &mut outputs.logits[..batch * self.reads.vertiports];
        self.reads.point(capsules, inputs.mask, rows.reads, logits);

        repeat(tensors.part(self.products.hidden_shift), rows.hidden);
        let hidden = MatrixMut::new(rows.hidden, batch, width);
        multiply(hidden, Write::Add, y, tensors.matrix(self.head.features()));
        let means =
            Matrix::new(&rows.reads.means[..batch * self.reads.width], batch, self.reads.width);
        let hidden = MatrixMut::new(rows.hidden, batch, width);
        multiply(hidden, Write::Add, means, tensors.matrix(self.products.means).transposed());
        self.head.forward(tensors, inputs.clock, rows.hidden, &mut outputs.values[..batch]);
    }

    /// Computes Eq. 20 for all heads, side by side in a row.
    fn attend(
        &self,
        tensors: Tensors<'_>,
        batch: usize,
        capsules: &[f32],
        query: &[f32],
        reads: &mut ReadsSpace,
        heads: &mut [f32],
    ) {
        let (width, each) = (self.width(), self.head_width());
        let query = Matrix::new(query, batch, width);
        for head in 0..self.reads.heads {
            let key = tensors.matrix(self.products.key.rows(head * each, each));
            let to = self.reads.query(reads, batch, head);
            multiply(to, Write::Set, query.columns(head * each, each), key);
        }
        self.reads.attend(capsules, reads);
        repeat(tensors.part(self.products.value_shift), heads);
        for head in 0..self.reads.heads {
            let to = MatrixMut::new(heads, batch, width).columns(head * each, each);
            let collected = self.reads.collected(reads, batch, head);
            let value = tensors.matrix(self.products.value.rows(head * each, each));
            multiply(to, Write::Add, collected, value.transposed());
        }
    }

    /// Adds the slopes of the decoder's weights, and writes the slopes of the capsules.
    pub(crate) fn backward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        capsules: Capsules<'_>,
        slopes: Slopes<'_>,
        space: &mut DecoderSpace,
        gradient: &mut [f32],
    ) {
        let Capsules { values: capsules, slopes: capsule_slopes } = capsules;
        let (batch, width) = (inputs.batch, self.width());
        let rows = &mut space.rows(batch * width);
        self.read_out_backward(tensors, inputs, capsules, slopes, rows, gradient);

        self.second_norm.backward(tensors, rows.second_norm, rows.slopes, gradient);
        rows.branch_slopes.copy_from_slice(rows.slopes);
        relu::backward(rows.lifted, rows.branch_slopes);
        self.feed_forward.backward(rows.z, rows.branch_slopes, gradient);
        self.feed_forward.input_slopes(tensors, rows.branch_slopes, Write::Add, rows.slopes);
        self.first_norm.backward(tensors, rows.first_norm, rows.slopes, gradient);

        add_weight_slopes(self.output, rows.heads, rows.slopes, gradient);
        let slopes = Matrix::new(rows.slopes, batch, width);
        let to = MatrixMut::new(rows.branch_slopes, batch, width);
        multiply(to, Write::Set, slopes, tensors.matrix(self.output).transposed());
        self.attend_backward(tensors, batch, capsules, rows, capsule_slopes, gradient);

        self.query.backward(inputs.aircraft, rows.slopes, gradient);
    }

    /// Computes the slopes of y from those of logits and values.
    fn read_out_backward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        capsules: &[f32],
        slopes: Slopes<'_>,
        rows: &mut Rows<'_>,
        gradient: &mut [f32],
    ) {
        let (batch, width) = (inputs.batch, self.width());
        let hidden_slopes = &mut *rows.branch_slopes;
        let hidden = &*rows.hidden;
        self.head.backward(tensors, inputs.clock, hidden, slopes.values, hidden_slopes, gradient);
        add_rows(hidden_slopes, self.products.hidden_shift.part_mut(gradient));
        add_weight_slopes(self.head.features(), rows.y, hidden_slopes, gradient);
        let hidden_slopes = Matrix::new(hidden_slopes, batch, width);
        let means =
            Matrix::new(&rows.reads.means[..batch * self.reads.width], batch, self.reads.width);
        let to = self.products.means.matrix_mut(gradient);
        multiply(to, Write::Add, hidden_slopes.transposed(), means);
        let to = self.reads.mean_slopes(rows.reads, batch);
        multiply(to, Write::Set, hidden_slopes, tensors.matrix(self.products.means));
        let to = MatrixMut::new(rows.slopes, batch, width);
        multiply(to, Write::Set, hidden_slopes, tensors.matrix(self.head.features()).transposed());

        self.reads.point_backward(capsules, inputs.mask, slopes.logits, rows.reads);
        let pointer_slopes = self.reads.query_slopes(rows.reads, batch, self.reads.heads);
        let y = Matrix::new(rows.y, batch, width);
        multiply(
            self.products.pointer.matrix_mut(gradient),
            Write::Add,
            y.transposed(),
            pointer_slopes,
        );
        let to = MatrixMut::new(rows.slopes, batch, width);
        multiply(
            to,
            Write::Add,
            pointer_slopes,
            tensors.matrix(self.products.pointer).transposed(),
        );
        let shift_slopes = rows.reads.shift_slopes(batch);
        let to = self.products.pointer_shift.matrix_mut(gradient);
        multiply(to, Write::Add, shift_slopes.transposed(), y);
        let to = MatrixMut::new(rows.slopes, batch, width);
        multiply(to, Write::Add, shift_slopes, tensors.matrix(self.products.pointer_shift));
    }

    /// Computes the slopes of the capsules from those of the heads (in `branch_slopes`), and adds
    /// those of the query.
    fn attend_backward(
        &self,
        tensors: Tensors<'_>,
        batch: usize,
        capsules: &[f32],
        rows: &mut Rows<'_>,
        capsule_slopes: &mut [f32],
        gradient: &mut [f32],
    ) {
        let (width, each) = (self.width(), self.head_width());
        add_rows(rows.branch_slopes, self.products.value_shift.part_mut(gradient));
        let slopes = Matrix::new(rows.branch_slopes, batch, width);
        for head in 0..self.reads.heads {
            let value = self.products.value.rows(head * each, each);
            let slopes = slopes.columns(head * each, each);
            let collected = self.reads.collected(rows.reads, batch, head);
            multiply(value.matrix_mut(gradient), Write::Add, slopes.transposed(), collected);
            let to = self.reads.collected_slopes(rows.reads, batch, head);
            multiply(to, Write::Set, slopes, tensors.matrix(value));
        }
        self.reads.attend_backward(capsules, rows.reads, capsule_slopes);
        let query = Matrix::new(rows.query, batch, width);
        for head in 0..self.reads.heads {
            let key = self.products.key.rows(head * each, each);
            let slopes = self.reads.query_slopes(rows.reads, batch, head);
            let query = query.columns(head * each, each).transposed();
            multiply(key.matrix_mut(gradient), Write::Add, query, slopes);
            let to = MatrixMut::new(rows.slopes, batch, width).columns(head * each, each);
            multiply(to, Write::Add, slopes, tensors.matrix(key).transposed());
        }
    }
}
