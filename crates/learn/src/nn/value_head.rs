//! The value head that both networks share: v = w2 . ReLU(z + clock c + b1) + b2, where z is what
//! the network adds to the head's hidden layer. The clock (share of the day that is left) enters
//! here only; no choice depends on it directly.

use crate::nn::init::{BEFORE_RELU, Init, VALUE};
use crate::nn::layout::{Layout, Slot, Tensors};
use crate::nn::linear::{add_rows, dot};
use crate::nn::relu;

/// The places of the head's weights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ValueHead {
    /// The rows for the `inputs` features, then the clock's.
    hidden: Slot,
    pub(crate) hidden_bias: Slot,
    output: Slot,
    output_bias: Slot,
}

impl ValueHead {
    /// Adds the head's tensors. Its hidden layer takes `inputs` features and the clock from here;
    /// together with what the network adds it has `inputs_in_all` inputs, which sets the scale of
    /// its first weights.
    pub(crate) fn new(
        layout: &mut Layout,
        inputs: usize,
        inputs_in_all: usize,
        width: usize,
    ) -> Self {
        let hidden = Init::Uniform { inputs: inputs_in_all, gain: BEFORE_RELU };
        let output = Init::Uniform { inputs: width, gain: VALUE };
        Self {
            hidden: layout.matrix("value.hidden.weight", (inputs + 1, width), hidden),
            hidden_bias: layout.vector("value.hidden.bias", width, Init::Zero),
            output: layout.vector("value.output.weight", width, output),
            output_bias: layout.vector("value.output.bias", 1, Init::Zero),
        }
    }

    /// The rows of the hidden layer for the features, without the clock's.
    pub(crate) fn features(self) -> Slot {
        self.hidden.rows(0, self.hidden.rows - 1)
    }

    fn clock(self) -> Slot {
        self.hidden.rows(self.hidden.rows - 1, 1)
    }

    /// Computes the values from the hidden layer's sums (bias included).
    pub(crate) fn forward(
        self,
        tensors: Tensors<'_>,
        clock: &[f32],
        hidden: &mut [f32],
        values: &mut [f32],
    ) {
        let width = self.hidden.columns;
        let (of_clock, output) = (tensors.part(self.clock()), tensors.part(self.output));
        let bias = tensors.part(self.output_bias)[0];
        for ((hidden, clock), value) in hidden.chunks_exact_mut(width).zip(clock).zip(values) {
            for (sum, of_clock) in hidden.iter_mut().zip(of_clock) {
                *sum += clock * of_clock;
            }
            relu::forward(hidden);
            *value = bias + dot(hidden, output);
        }
    }

    /// Adds the slopes of the clock's row, the output and its bias, and writes those of the hidden
    /// layer's sums.
    pub(crate) fn backward(
        self,
        tensors: Tensors<'_>,
        clock: &[f32],
        hidden: &[f32],
        value_slopes: &[f32],
        hidden_slopes: &mut [f32],
        gradient: &mut [f32],
    ) {
        let width = self.hidden.columns;
        let output = tensors.part(self.output);
        let rows = hidden.chunks_exact(width).zip(hidden_slopes.chunks_exact_mut(width));
        for ((hidden, slopes), (clock, value_slope)) in rows.zip(clock.iter().zip(value_slopes)) {
            for (sum, hidden) in self.output.part_mut(gradient).iter_mut().zip(hidden) {
                *sum += value_slope * hidden;
            }
            for (slope, output) in slopes.iter_mut().zip(output) {
                *slope = value_slope * output;
            }
            relu::backward(hidden, slopes);
            for (sum, slope) in self.clock().part_mut(gradient).iter_mut().zip(&*slopes) {
                *sum += clock * slope;
            }
        }
        add_rows(value_slopes, self.output_bias.part_mut(gradient));
    }
}
