//! Products of weights that the network uses instead of the weights themselves, taken once per
//! change of the weights.

use crate::nn::gcaps::{DecoderWeights, EncoderWeights};
use crate::nn::init::Init;
use crate::nn::layout::{Layout, Slot};
use crate::nn::linear::add;
use crate::nn::product::{Write, multiply};

/// The places of the products of the paper's encoder, which follow the weights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EncoderProducts {
    /// W_0 S_1 with S_p = V_p0 + V_p1 + V_p2.
    pub(crate) first_node: Slot,
    /// W_0 T_1 with T_p = V_p1 + V_p2.
    pub(crate) first_mean: Slot,
    /// b_0 V_10.
    pub(crate) first_shift: Slot,
    /// S_2.
    pub(crate) second_node: Slot,
    /// T_2.
    pub(crate) second_mean: Slot,
}

/// The places of the products of the decoder, which follow the weights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Products {
    /// (W_f W_K)^T, (W_f W_V)^T, and the shift b_f W_V of the latter. The part of a head is a block
    /// of rows.
    pub(crate) key: Slot,
    pub(crate) value: Slot,
    pub(crate) value_shift: Slot,
    /// W_L W_f^T, and its shift b_f W_L^T.
    pub(crate) pointer: Slot,
    pub(crate) pointer_shift: Slot,
    /// (W_f M)^T, with M the value head's rows for the mean of the embeddings, and b_f M plus the
    /// head's bias.
    pub(crate) means: Slot,
    pub(crate) hidden_shift: Slot,
}

impl EncoderProducts {
    /// Adds the products to a layout that begins where the weights end.
    pub(crate) fn new(layout: &mut Layout, weights: &EncoderWeights) -> Self {
        let (features, width) = (weights.node.weight.rows, weights.node.weight.columns);
        let mut matrix = |name, rows, columns| layout.matrix(name, (rows, columns), Init::Zero);
        Self {
            first_node: matrix("first_node", features, width),
            first_mean: matrix("first_mean", features, width),
            first_shift: matrix("first_shift", 1, width),
            second_node: matrix("second_node", width, width),
            second_mean: matrix("second_mean", width, width),
        }
    }

    /// Computes the products.
    pub(crate) fn prepare(&self, weights: &EncoderWeights, params: &[f32], derived: &mut [f32]) {
        let here = |slot: Slot| slot.counted_from(params.len());
        let node = weights.node.weight.matrix(params);
        let [at_node, once, twice] = weights.first.map(|hop| hop.matrix(params));
        let to = here(self.first_node);
        multiply(to.matrix_mut(derived), Write::Set, node, at_node);
        multiply(to.matrix_mut(derived), Write::Add, node, once);
        multiply(to.matrix_mut(derived), Write::Add, node, twice);
        let to = here(self.first_mean);
        multiply(to.matrix_mut(derived), Write::Set, node, once);
        multiply(to.matrix_mut(derived), Write::Add, node, twice);
        let bias = weights.node.bias.matrix(params);
        multiply(here(self.first_shift).matrix_mut(derived), Write::Set, bias, at_node);

        let [at_node, once, twice] = weights.second.map(|hop| hop.part(params));
        let to = here(self.second_mean).part_mut(derived);
        to.copy_from_slice(once);
        add(twice, to);
        let to = here(self.second_node).part_mut(derived);
        to.copy_from_slice(at_node);
        add(once, to);
        add(twice, to);
    }

    /// Computes the slopes of the weights from those of the products, which follow them in
    /// `gradient`.
    pub(crate) fn finish(&self, weights: &EncoderWeights, params: &[f32], gradient: &mut [f32]) {
        let (own, behind) = gradient.split_at_mut(params.len());
        let here = |slot: Slot| slot.counted_from(params.len());
        let node_slopes = here(self.first_node).matrix(behind);
        let mean_slopes = here(self.first_mean).matrix(behind);
        let shift_slopes = here(self.first_shift).matrix(behind);

        let node = weights.node.weight.matrix(params).transposed();
        let bias = weights.node.bias.matrix(params).transposed();
        let [at_node, once, twice] = weights.first;
        multiply(at_node.matrix_mut(own), Write::Set, node, node_slopes);
        multiply(once.matrix_mut(own), Write::Set, node, mean_slopes);
        add_part(at_node, once, own);
        multiply(at_node.matrix_mut(own), Write::Add, bias, shift_slopes);
        copy_part(once, twice, own);
        for (hop, slopes) in [
            (at_node, node_slopes),
            (once, node_slopes),
            (twice, node_slopes),
            (once, mean_slopes),
            (twice, mean_slopes),
        ] {
            let to = weights.node.weight.matrix_mut(own);
            multiply(to, Write::Add, slopes, hop.matrix(params).transposed());
        }
        let to = weights.node.bias.matrix_mut(own);
        multiply(to, Write::Add, shift_slopes, at_node.matrix(params).transposed());

        let [at_node, once, twice] = weights.second;
        at_node.part_mut(own).copy_from_slice(here(self.second_node).part(behind));
        once.part_mut(own).copy_from_slice(here(self.second_mean).part(behind));
        add_part(at_node, once, own);
        copy_part(once, twice, own);
    }
}

impl Products {
    /// Adds the products to a layout that begins where the weights end.
    pub(crate) fn new(layout: &mut Layout, weights: &DecoderWeights) -> Self {
        let (capsule, width) = (weights.embed.weight.rows, weights.embed.weight.columns);
        let mut matrix = |name, rows, columns| layout.matrix(name, (rows, columns), Init::Zero);
        Self {
            key: matrix("key", width, capsule),
            value: matrix("value", width, capsule),
            value_shift: matrix("value_shift", 1, width),
            pointer: matrix("pointer", width, capsule),
            pointer_shift: matrix("pointer_shift", 1, width),
            means: matrix("means", width, capsule),
            hidden_shift: matrix("hidden_shift", 1, width),
        }
    }

    /// Computes the products.
    pub(crate) fn prepare(&self, weights: &DecoderWeights, params: &[f32], derived: &mut [f32]) {
        let here = |slot: Slot| slot.counted_from(params.len());
        let embed = weights.embed.weight.matrix(params);
        let bias = weights.embed.bias.matrix(params);
        for (product, weight) in
            [(self.key, weights.key), (self.value, weights.value), (self.means, weights.means)]
        {
            let to = here(product).matrix_mut(derived);
            multiply(to, Write::Set, weight.matrix(params).transposed(), embed.transposed());
        }
        let to = here(self.value_shift).matrix_mut(derived);
        multiply(to, Write::Set, bias, weights.value.matrix(params));
        let to = here(self.hidden_shift);
        to.part_mut(derived).copy_from_slice(weights.hidden_bias.part(params));
        multiply(to.matrix_mut(derived), Write::Add, bias, weights.means.matrix(params));

        let pointer = weights.pointer.matrix(params);
        let to = here(self.pointer).matrix_mut(derived);
        multiply(to, Write::Set, pointer, embed.transposed());
        let to = here(self.pointer_shift).matrix_mut(derived);
        multiply(to, Write::Set, bias, pointer.transposed());
    }

    /// Computes the slopes of the weights from those of the products, which follow them in
    /// `gradient`.
    pub(crate) fn finish(&self, weights: &DecoderWeights, params: &[f32], gradient: &mut [f32]) {
        let (own, behind) = gradient.split_at_mut(params.len());
        let slopes = |slot: Slot| slot.counted_from(params.len()).matrix(behind);
        let embed = weights.embed.weight.matrix(params);
        let bias = weights.embed.bias.matrix(params);
        weights.embed.weight.part_mut(own).fill(0.0);
        weights.embed.bias.part_mut(own).fill(0.0);
        for (product, weight) in
            [(self.key, weights.key), (self.value, weights.value), (self.means, weights.means)]
        {
            let slopes = slopes(product).transposed();
            multiply(weight.matrix_mut(own), Write::Set, embed.transposed(), slopes);
            let to = weights.embed.weight.matrix_mut(own);
            multiply(to, Write::Add, slopes, weight.matrix(params).transposed());
        }
        for (shift, weight) in
            [(self.value_shift, weights.value), (self.hidden_shift, weights.means)]
        {
            multiply(weight.matrix_mut(own), Write::Add, bias.transposed(), slopes(shift));
            let to = weights.embed.bias.matrix_mut(own);
            multiply(to, Write::Add, slopes(shift), weight.matrix(params).transposed());
        }
        add(
            self.hidden_shift.counted_from(params.len()).part(behind),
            weights.hidden_bias.part_mut(own),
        );

        let pointer = weights.pointer.matrix(params);
        multiply(weights.pointer.matrix_mut(own), Write::Set, slopes(self.pointer), embed);
        let to = weights.embed.weight.matrix_mut(own);
        multiply(to, Write::Add, slopes(self.pointer).transposed(), pointer);
        let shift = slopes(self.pointer_shift);
        multiply(weights.pointer.matrix_mut(own), Write::Add, shift.transposed(), bias);
        multiply(weights.embed.bias.matrix_mut(own), Write::Add, shift, pointer);
    }
}

fn copy_part(from: Slot, to: Slot, flat: &mut [f32]) {
    flat.copy_within(from.offset..from.offset + from.rows * from.columns, to.offset);
}

/// Does `to += from` within one flat vector, in which `from` lies before `to`.
fn add_part(from: Slot, to: Slot, flat: &mut [f32]) {
    let (front, rest) = flat.split_at_mut(to.offset);
    add(from.part(front), to.counted_from(front.len()).part_mut(rest));
}
