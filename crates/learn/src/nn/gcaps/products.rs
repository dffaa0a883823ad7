//! Products of weights that the network works with in the weights' place, taken once per change of the weights.

use crate::nn::gcaps::Weights;
use crate::nn::init::Init;
use crate::nn::layout::{Layout, Slot};
use crate::nn::linear::add;
use crate::nn::product::{Write, multiply};

/// Where the products lie, behind the weights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Products {
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

impl Products {
    /// Adds the products to a layout that begins where the weights end.
    pub(crate) fn new(layout: &mut Layout, weights: &Weights) -> Self {
        let (features, width) = (weights.node.weight.rows, weights.node.weight.columns);
        Self {
            first_node: layout.matrix("first_node", (features, width), Init::Zero),
            first_mean: layout.matrix("first_mean", (features, width), Init::Zero),
            first_shift: layout.vector("first_shift", width, Init::Zero),
            second_node: layout.matrix("second_node", (width, width), Init::Zero),
            second_mean: layout.matrix("second_mean", (width, width), Init::Zero),
        }
    }
}

impl Products {
    /// Takes the products.
    pub(crate) fn prepare(&self, weights: &Weights, params: &[f32], derived: &mut [f32]) {
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

    /// From the slopes of the products, behind those of the weights, to the weights' own.
    pub(crate) fn finish(&self, weights: &Weights, params: &[f32], gradient: &mut [f32]) {
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

fn copy_part(from: Slot, to: Slot, flat: &mut [f32]) {
    flat.copy_within(from.offset..from.offset + from.rows * from.columns, to.offset);
}

/// `to += from` within one flat vector; `from` lies in front of `to`.
fn add_part(from: Slot, to: Slot, flat: &mut [f32]) {
    let (front, rest) = flat.split_at_mut(to.offset);
    add(from.part(front), to.counted_from(front.len()).part_mut(rest));
}
