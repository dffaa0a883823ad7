//! What goes into a pass and what comes out of it, rows of a batch side by side.

/// A batch of observations, rows side by side. F are a node's features, G the aircraft's.
#[derive(Debug, Clone, Copy)]
pub struct Inputs<'a> {
    /// B, the number of decisions.
    pub batch: usize,
    /// Node features [B x N x F].
    pub nodes: &'a [f32],
    /// Aircraft features [B x G].
    pub aircraft: &'a [f32],
    /// [B x N]: 0 where the vertiport may not be chosen. At least one of each row may.
    pub mask: &'a [u8],
    /// Share of the day left `[B]`; the value head alone sees it.
    pub clock: &'a [f32],
}

/// The slopes of a loss in a batch's outputs.
#[derive(Debug, Clone, Copy)]
pub struct Slopes<'a> {
    /// In the logits [B x N]; those of masked vertiports are ignored.
    pub logits: &'a [f32],
    /// In the values `[B]`.
    pub values: &'a [f32],
}

/// What a forward pass leaves.
#[derive(Debug)]
pub(crate) struct Outputs {
    pub(crate) logits: Vec<f32>,
    pub(crate) values: Vec<f32>,
}
