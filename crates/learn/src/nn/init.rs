//! Initial weights, which follow from a seed: uniform, with a variance that keeps signals on one
//! scale (He et al. 2015, LeCun et al. 1998). No function is used whose last bit differs between
//! machines.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::nn::layout::Layout;

/// How the entries of a tensor are initialised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Init {
    Zero,
    One,
    /// Uniform with mean 0 and variance `gain² / inputs`.
    Uniform {
        inputs: usize,
        gain: f32,
    },
}

/// Gain before a rectifier, which loses half of the signal's power.
pub(crate) const BEFORE_RELU: f32 = std::f32::consts::SQRT_2;
/// Gain of the last matrix of the logits, as in stable-baselines3: the first policy is nearly
/// uniform.
pub(crate) const LOGITS: f32 = 0.01;
/// Gain of the last matrix of the value: the first values are near 0.
pub(crate) const VALUE: f32 = 0.1;

/// The initial weights of a layout.
pub(crate) fn draw(layout: &Layout, seed: u64) -> Vec<f32> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut params = Vec::with_capacity(layout.len());
    for tensor in layout.tensors() {
        let entries = std::iter::repeat_n((), tensor.len());
        match tensor.init {
            Init::Zero => params.extend(entries.map(|()| 0.0)),
            Init::One => params.extend(entries.map(|()| 1.0)),
            Init::Uniform { inputs, gain } => {
                let reach = gain * (3.0 / inputs as f32).sqrt();
                params.extend(entries.map(|()| reach * symmetric(&mut rng)));
            }
        }
    }
    params
}

/// A uniform number in [-1, 1).
fn symmetric(rng: &mut ChaCha8Rng) -> f32 {
    (rng.next_u32() >> 8) as f32 / (1 << 23) as f32 - 1.0
}

#[cfg(test)]
mod tests {
    use super::{Init, draw};
    use crate::nn::layout::Layout;

    #[test]
    fn entries_have_the_variance_asked_for() {
        let mut layout = Layout::starting_at(0);
        layout.vector("bias", 3, Init::Zero);
        layout.matrix("weight", (200, 100), Init::Uniform { inputs: 200, gain: 2.0 });
        layout.vector("scale", 2, Init::One);
        let params = draw(&layout, 5);
        assert_eq!((&params[..3], &params[20_003..]), ([0.0; 3].as_slice(), [1.0; 2].as_slice()));
        let weight = &params[3..20_003];
        let mean = weight.iter().sum::<f32>() / 20_000.0;
        let variance = weight.iter().map(|entry| entry * entry).sum::<f32>() / 20_000.0;
        assert!(mean.abs() < 0.003, "mean {mean}");
        assert!((variance - 0.02).abs() < 0.0005, "variance {variance}");
        assert_eq!(params, draw(&layout, 5));
        assert_ne!(params, draw(&layout, 6));
    }
}
