//! Adam with stable-baselines3's constants (betas 0.9 and 0.999, epsilon 1e-5), and the gradient
//! clipping that precedes it.

const BETA_1: f32 = 0.9;
const BETA_2: f32 = 0.999;
const EPSILON: f32 = 1e-5;

/// First and second moments of every parameter's gradient, and the number of steps taken.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Adam {
    pub(crate) first: Vec<f32>,
    pub(crate) second: Vec<f32>,
    pub(crate) steps: u64,
}

impl Adam {
    pub(crate) fn new(parameters: usize) -> Self {
        Self { first: vec![0.0; parameters], second: vec![0.0; parameters], steps: 0 }
    }

    /// Takes one step against the gradient.
    pub(crate) fn step(&mut self, params: &mut [f32], gradient: &[f32], learning_rate: f32) {
        self.steps += 1;
        let steps = i32::try_from(self.steps).unwrap_or(i32::MAX);
        // This needs double precision: in single precision, 1 - 0.999^t loses most of its digits.
        let correction_1 = (1.0 - f64::from(BETA_1).powi(steps)) as f32;
        let correction_2 = (1.0 - f64::from(BETA_2).powi(steps)) as f32;
        let rate = learning_rate / correction_1;
        let root = correction_2.sqrt();
        let moments = self.first.iter_mut().zip(&mut self.second);
        for ((param, &slope), (first, second)) in params.iter_mut().zip(gradient).zip(moments) {
            *first = BETA_1 * *first + (1.0 - BETA_1) * slope;
            *second = BETA_2 * *second + (1.0 - BETA_2) * slope * slope;
            *param -= rate * *first / (second.sqrt() / root + EPSILON);
        }
    }
}

/// Shrinks the gradient to `max_norm` where it is longer, as PyTorch's `clip_grad_norm_` does.
pub(crate) fn clip_norm(gradient: &mut [f32], max_norm: f32) {
    // Each partial sum has a few thousand entries: few enough for single precision to stay
    // accurate, and the loop is fast.
    let squares: f64 = gradient
        .chunks(4096)
        .map(|chunk| f64::from(chunk.iter().map(|slope| slope * slope).sum::<f32>()))
        .sum();
    let norm = squares.sqrt() as f32;
    let scale = max_norm / (norm + 1e-6);
    if scale < 1.0 {
        for slope in gradient {
            *slope *= scale;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Adam, clip_norm};

    #[test]
    fn steps_follow_the_algorithm() {
        let mut adam = Adam::new(2);
        let mut params = [1.0, -2.0];
        for gradient in [[0.5, -1.0], [0.25, 3.0], [-1.0, 0.0]] {
            adam.step(&mut params, &gradient, 0.1);
        }
        let expected = adam_by_definition();
        for (found, expected) in params.iter().zip(expected) {
            assert!((f64::from(*found) - expected).abs() < 1e-6, "{found} is not {expected}");
        }
    }

    /// Algorithm 1 of Kingma & Ba in double precision, written without any shortcut.
    fn adam_by_definition() -> [f64; 2] {
        let gradients = [[0.5, 0.25, -1.0], [-1.0, 3.0, 0.0]];
        let starts = [1.0, -2.0];
        std::array::from_fn(|at| {
            let (mut p, mut m, mut v) = (starts[at], 0.0, 0.0);
            for (t, g) in (1..).zip(gradients[at]) {
                m = 0.9 * m + 0.1 * g;
                v = 0.999 * v + 0.001 * g * g;
                let (m_hat, v_hat) = (m / (1.0 - 0.9_f64.powi(t)), v / (1.0 - 0.999_f64.powi(t)));
                p -= 0.1 * m_hat / (v_hat.sqrt() + 1e-5);
            }
            p
        })
    }

    #[test]
    fn a_long_gradient_is_cut_to_the_norm_and_a_short_one_kept() {
        let mut long = [3.0, 4.0];
        clip_norm(&mut long, 1.0);
        assert!((long[0] - 0.6).abs() < 1e-5 && (long[1] - 0.8).abs() < 1e-5);
        let mut short = [0.3, 0.4];
        clip_norm(&mut short, 1.0);
        assert_eq!(short, [0.3, 0.4]);
    }
}
