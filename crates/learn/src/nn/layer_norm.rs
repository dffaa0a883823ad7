//! Layer normalisation (Ba et al. 2016): brings every row to mean 0 and variance 1, then applies a
//! learned scale and shift.

use crate::nn::init::Init;
use crate::nn::layout::{Layout, Slot, Tensors};
use crate::nn::linear::{add, dot};

/// The same value as in PyTorch.
const EPSILON: f32 = 1e-5;

/// The places of the layer's weights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LayerNorm {
    scale: Slot,
    shift: Slot,
}

/// What the backward pass needs from the forward pass: the normalised rows and the reciprocals of
/// their spreads.
#[derive(Debug)]
pub(crate) struct Normalised {
    rows: Vec<f32>,
    over_spread: Vec<f32>,
}

impl Normalised {
    /// Allocates memory for `batch` rows of `width` entries.
    pub(crate) fn new(batch: usize, width: usize) -> Self {
        Self { rows: vec![0.0; batch * width], over_spread: vec![0.0; batch] }
    }
}

impl LayerNorm {
    /// Adds the layer's tensors.
    pub(crate) fn new(layout: &mut Layout, name: &str, width: usize) -> Self {
        Self {
            scale: layout.vector(&format!("{name}.scale"), width, Init::One),
            shift: layout.vector(&format!("{name}.shift"), width, Init::Zero),
        }
    }

    /// Normalises the rows of `from` into `to`.
    pub(crate) fn forward(
        self,
        tensors: Tensors<'_>,
        from: &[f32],
        kept: &mut Normalised,
        to: &mut [f32],
    ) {
        let width = self.scale.columns;
        let (scale, shift) = (tensors.part(self.scale), tensors.part(self.shift));
        let kept = kept.rows.chunks_exact_mut(width).zip(&mut kept.over_spread);
        let rows = from.chunks_exact(width).zip(to.chunks_exact_mut(width));
        for ((from, to), (normal, over_spread)) in rows.zip(kept) {
            let mean = from.iter().sum::<f32>() / width as f32;
            for (normal, from) in normal.iter_mut().zip(from) {
                *normal = from - mean;
            }
            *over_spread = 1.0 / (dot(normal, normal) / width as f32 + EPSILON).sqrt();
            for normal in &mut *normal {
                *normal *= *over_spread;
            }
            for ((to, normal), (scale, shift)) in
                to.iter_mut().zip(&*normal).zip(scale.iter().zip(shift))
            {
                *to = normal * scale + shift;
            }
        }
    }

    /// Adds the slopes of scale and shift, and turns the slopes of the output into those of the
    /// input.
    pub(crate) fn backward(
        self,
        tensors: Tensors<'_>,
        kept: &Normalised,
        slopes: &mut [f32],
        gradient: &mut [f32],
    ) {
        let width = self.scale.columns;
        let scale = tensors.part(self.scale);
        let kept = kept.rows.chunks_exact(width).zip(&kept.over_spread);
        for (slopes, (normal, over_spread)) in slopes.chunks_exact_mut(width).zip(kept) {
            let scale_slopes = self.scale.part_mut(gradient).iter_mut();
            for (sum, (slope, normal)) in scale_slopes.zip(slopes.iter().zip(normal)) {
                *sum += slope * normal;
            }
            add(slopes, self.shift.part_mut(gradient));
            for (slope, scale) in slopes.iter_mut().zip(scale) {
                *slope *= scale;
            }
            let mean = slopes.iter().sum::<f32>() / width as f32;
            let lean = dot(slopes, normal) / width as f32;
            for (slope, normal) in slopes.iter_mut().zip(normal) {
                *slope = (*slope - mean - normal * lean) * over_spread;
            }
        }
    }
}
