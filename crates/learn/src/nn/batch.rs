//! The inputs and outputs of a pass: the rows of a batch.

/// A batch of observations, row by row. F is the number of node features, G that of aircraft
/// features.
#[derive(Debug, Clone, Copy)]
pub struct Inputs<'a> {
    /// B, the number of decisions.
    pub batch: usize,
    /// Node features [B x N x F].
    pub nodes: &'a [f32],
    /// Aircraft features [B x G].
    pub aircraft: &'a [f32],
    /// [B x N]: 0 where the vertiport may not be chosen. Every row has at least one that may.
    pub mask: &'a [u8],
    /// Weights of the edges between vertiports [B x N x N], in the direction of flights; empty if
    /// the network's graph needs none.
    pub edges: &'a [f32],
    /// Share of the day that is left `[B]`; only the value head reads it.
    pub clock: &'a [f32],
}

/// The slopes of a loss with respect to a batch's outputs.
#[derive(Debug, Clone, Copy)]
pub struct Slopes<'a> {
    /// With respect to the logits [B x N]; those of masked vertiports are ignored.
    pub logits: &'a [f32],
    /// With respect to the values `[B]`.
    pub values: &'a [f32],
}

/// The outputs of a forward pass.
#[derive(Debug)]
pub(crate) struct Outputs {
    pub(crate) logits: Vec<f32>,
    pub(crate) values: Vec<f32>,
}

/// The maximum of some logits or scores; minus infinity if there are none.
pub(crate) fn maximum(numbers: impl Iterator<Item = f32>) -> f32 {
    numbers.fold(f32::NEG_INFINITY, f32::max)
}
