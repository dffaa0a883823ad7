//! Proximal policy optimisation (Schulman et al. 2017), in which every setting means what it means
//! in stable-baselines3.
//!
//! An update estimates advantages on the collected decisions, then passes over them `n_epochs`
//! times in shuffled minibatches, each of which is one step of Adam on
//!
//! ```text
//! L = -mean min(r A, clip(r, 1 - ε, 1 + ε) A)  +  vf_coef mean (V - R)²  -  ent_coef mean H
//! ```
//!
//! where r is the probability of the choice now over its probability when it was made. A minibatch
//! is split into chunks of fixed size, which a fixed number of lanes process. Lanes are added up in
//! order, so the resulting weights do not depend on the number of threads.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::{
    IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator, ParallelSliceMut,
};
use vertifleet_core::Stopped;

use crate::adam::{Adam, clip_norm};
use crate::nn::{self, Gradient, Slopes, Weights, Workspace};
use crate::ppo::buffer::Buffer;
use crate::ppo::{PpoSettings, advantage};
use crate::rows::Rows;

/// Decisions per forward and backward pass: as many as fit in the second-level cache.
const CHUNK: usize = 128;
/// Number of gradients that are filled in parallel and then added up. More would cost memory; fewer
/// would leave threads idle.
const LANES: usize = 8;

/// Means over the minibatches of the last epoch, when the update is nearly done. (stable-baselines3
/// logs means over all epochs, except for the divergence.)
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Losses {
    pub(crate) policy_loss: f64,
    pub(crate) value_loss: f64,
    pub(crate) entropy: f64,
    pub(crate) approx_kl: f64,
    pub(crate) clip_fraction: f64,
}

/// What one decision adds to the losses, and the slope of the loss in its value.
#[derive(Debug, Clone, Copy, PartialEq)]
struct DecisionLoss {
    losses: Losses,
    value_slope: f32,
}

/// A decision as it was made, with its results.
#[derive(Debug, Clone, Copy)]
struct Sample {
    choice: usize,
    log_probability: f32,
    /// The advantage, normalised over the minibatch.
    advantage: f32,
    /// R, the sum of advantage and value.
    target_return: f32,
}

/// The working memory of a lane: the features of a chunk, the workspace of the network, and the
/// lane's sum of gradients.
struct Lane {
    observations: Rows,
    workspace: Workspace,
    gradient: Gradient,
    logit_slopes: Vec<f32>,
    value_slopes: Vec<f32>,
    losses: Losses,
}

/// The target of an update, and its settings.
pub(crate) struct Update<'a> {
    pub(crate) weights: &'a mut Weights,
    pub(crate) adam: &'a mut Adam,
    /// The seed of the order of the decisions.
    pub(crate) seed: u64,
    /// Adam's step size.
    pub(crate) learning_rate: f32,
}

/// The settings and the working memory of learning; the caller has the weights and moments.
pub(crate) struct Ppo {
    settings: PpoSettings,
    lanes: Vec<Lane>,
    order: Vec<usize>,
    advantages: Vec<f32>,
    returns: Vec<f32>,
}

impl Ppo {
    pub(crate) fn new(net: &nn::NeuralNetwork, vertiports: usize, settings: &PpoSettings) -> Self {
        let lane = || Lane {
            observations: Rows::new(net.architecture(), vertiports),
            workspace: net.workspace(CHUNK),
            gradient: net.gradient(),
            logit_slopes: vec![0.0; CHUNK * vertiports],
            value_slopes: vec![0.0; CHUNK],
            losses: Losses::default(),
        };
        Self {
            lanes: (0..LANES).map(|_| lane()).collect(),
            order: (0..settings.buffer_size()).collect(),
            advantages: vec![0.0; settings.buffer_size()],
            returns: vec![0.0; settings.buffer_size()],
            settings: settings.clone(),
        }
    }

    /// Makes one update on the decisions of a buffer. After every minibatch, `watch` is called with
    /// the share of the update that is done.
    ///
    /// # Errors
    /// Returns the error that `watch` returns; the weights then stay as they are, in the middle of
    /// the update.
    pub(crate) fn update(
        &mut self,
        net: &nn::NeuralNetwork,
        buffer: &Buffer,
        Update { weights, adam, seed, learning_rate }: Update<'_>,
        watch: &mut dyn FnMut(f64) -> Result<(), Stopped>,
    ) -> Result<Losses, Stopped> {
        self.estimate_advantages(buffer);
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        self.order.sort_unstable();
        let mut losses = Losses::default();
        for epoch in 0..self.settings.n_epochs {
            self.order.shuffle(&mut rng);
            losses = Losses::default();
            let batches = self.order.len().div_ceil(self.settings.batch_size);
            for batch in 0..batches {
                let found = self.batch_gradient(net, buffer, weights, batch);
                losses.add(&found, 1.0 / batches as f64);
                let gradient = net.finish(weights, &mut self.lanes[0].gradient);
                clip_norm(gradient, self.settings.max_grad_norm);
                net.update(weights, |params| adam.step(params, gradient, learning_rate));
                let done = f64::from(epoch) + (batch + 1) as f64 / batches as f64;
                watch(done / f64::from(self.settings.n_epochs))?;
            }
        }
        Ok(losses)
    }

    fn estimate_advantages(&mut self, buffer: &Buffer) {
        let n_steps = self.settings.n_steps;
        let days = buffer.groups.iter().flat_map(|group| {
            let experience = &group.experience;
            experience
                .last_values
                .iter()
                .enumerate()
                .map(move |(day, &last)| (experience, day, last))
        });
        let rows = self.advantages.chunks_mut(n_steps).zip(self.returns.chunks_mut(n_steps));
        for ((experience, day, last_value), (advantages, returns)) in days.zip(rows) {
            let span = day * n_steps..(day + 1) * n_steps;
            let values = &experience.values[span.clone()];
            advantage::estimate(
                &experience.rewards[span.clone()],
                values,
                &experience.day_ends[span],
                last_value,
                self.settings.gamma,
                self.settings.gae_lambda,
                advantages,
            );
            for ((target_return, advantage), value) in
                returns.iter_mut().zip(&*advantages).zip(values)
            {
                *target_return = advantage + value;
            }
        }
    }

    /// Leaves the gradient of one minibatch in the first lane. Returns the minibatch's mean losses.
    fn batch_gradient(
        &mut self,
        net: &nn::NeuralNetwork,
        buffer: &Buffer,
        weights: &Weights,
        batch: usize,
    ) -> Losses {
        let size = self.settings.batch_size;
        let decisions = &self.order[batch * size..self.order.len().min((batch + 1) * size)];
        let norm = AdvantageNorm::of(decisions, &self.advantages);
        let (settings, returns, advantages) = (&self.settings, &self.returns, &self.advantages);
        let sample = |decision: usize| {
            let (experience, row) = buffer.locate(decision);
            Sample {
                choice: usize::from(experience.choices[row]),
                log_probability: experience.log_probabilities[row],
                advantage: norm.apply(advantages[decision]),
                target_return: returns[decision],
            }
        };

        let used = decisions.len().div_ceil(CHUNK).min(LANES);
        self.lanes[..used].par_iter_mut().enumerate().for_each(|(at, lane)| {
            lane.gradient.clear();
            lane.losses = Losses::default();
            for chunk in decisions.chunks(CHUNK).skip(at).step_by(LANES) {
                let chunk = Chunk { decisions: chunk, batch_len: decisions.len() };
                lane.learn(net, weights, buffer, settings, chunk, &sample);
            }
        });
        let (first, rest) = self.lanes[..used].split_at_mut(1);
        add_up(first[0].gradient.sums_mut(), rest);
        for lane in rest {
            first[0].losses.add(&lane.losses, 1.0);
        }
        first[0].losses
    }
}

/// Adds the gradients of `lanes` to `total`, in the same order for every entry.
fn add_up(total: &mut [f32], lanes: &[Lane]) {
    const SPAN: usize = 1 << 16;
    total.par_chunks_mut(SPAN).enumerate().for_each(|(span, total)| {
        for lane in lanes {
            let part = &lane.gradient.sums()[span * SPAN..][..total.len()];
            for (sum, slope) in total.iter_mut().zip(part) {
                *sum += slope;
            }
        }
    });
}

/// A part of a minibatch that one lane works on at a time.
#[derive(Clone, Copy)]
struct Chunk<'a> {
    /// Positions in the buffer.
    decisions: &'a [usize],
    /// Decisions of the whole minibatch.
    batch_len: usize,
}

impl Lane {
    /// Adds the gradient of one chunk of a minibatch.
    fn learn(
        &mut self,
        net: &nn::NeuralNetwork,
        weights: &Weights,
        buffer: &Buffer,
        settings: &PpoSettings,
        chunk: Chunk<'_>,
        sample: &impl Fn(usize) -> Sample,
    ) {
        let Chunk { decisions, batch_len } = chunk;
        self.observations.clear();
        for &decision in decisions {
            let (experience, row) = buffer.locate(decision);
            self.observations.push_copy(&experience.observations, row);
        }
        let inputs = self.observations.inputs();
        net.forward(weights, inputs, &mut self.workspace);

        let vertiports = self.workspace.logits().len() / decisions.len();
        let weight = 1.0 / batch_len as f32;
        for (row, &decision) in decisions.iter().enumerate() {
            let logits = &self.workspace.logits()[row * vertiports..][..vertiports];
            let slopes = &mut self.logit_slopes[row * vertiports..][..vertiports];
            let value = self.workspace.values()[row];
            let found = decision_loss(logits, value, &sample(decision), settings, weight, slopes);
            self.value_slopes[row] = found.value_slope;
            self.losses.add(&found.losses, f64::from(weight));
        }
        let slopes = Slopes {
            logits: &self.logit_slopes[..decisions.len() * vertiports],
            values: &self.value_slopes[..decisions.len()],
        };
        net.backward(weights, inputs, slopes, &mut self.workspace, &mut self.gradient);
    }
}

/// The loss of one decision. `logit_slopes` receives its gradient times `weight` (one over the size
/// of the minibatch).
fn decision_loss(
    logits: &[f32],
    value: f32,
    made: &Sample,
    settings: &PpoSettings,
    weight: f32,
    logit_slopes: &mut [f32],
) -> DecisionLoss {
    let highest = nn::maximum(logits.iter().copied());
    let mut total = 0.0;
    for (slope, logit) in logit_slopes.iter_mut().zip(logits) {
        *slope = (logit - highest).exp();
        total += *slope;
    }
    let log_total = highest + total.ln();
    let log_of = |logit: f32| if logit == f32::NEG_INFINITY { 0.0 } else { logit - log_total };
    let entropy: f32 =
        -logit_slopes.iter().zip(logits).map(|(p, &logit)| p / total * log_of(logit)).sum::<f32>();

    let log_ratio = logits[made.choice] - log_total - made.log_probability;
    let ratio = log_ratio.exp();
    let clip = settings.clip_range;
    let plain = ratio * made.advantage;
    let clipped = ratio.clamp(1.0 - clip, 1.0 + clip) * made.advantage;
    // Where the clipped term is the smaller one, the loss is flat.
    let push = if plain <= clipped { -plain } else { 0.0 };

    for (at, (slope, &logit)) in logit_slopes.iter_mut().zip(logits).enumerate() {
        let probability = *slope / total;
        let chosen = if at == made.choice { 1.0 } else { 0.0 };
        let policy_slope = push * (chosen - probability);
        let entropy_slope = settings.ent_coef * probability * (log_of(logit) + entropy);
        *slope = weight * (policy_slope + entropy_slope);
    }
    let error = value - made.target_return;
    DecisionLoss {
        losses: Losses {
            policy_loss: f64::from(-plain.min(clipped)),
            value_loss: f64::from(error * error),
            entropy: f64::from(entropy),
            approx_kl: f64::from(ratio - 1.0 - log_ratio),
            clip_fraction: if (ratio - 1.0).abs() > clip { 1.0 } else { 0.0 },
        },
        value_slope: weight * settings.vf_coef * 2.0 * error,
    }
}

/// Mean and spread of a minibatch's advantages, which normalise them.
struct AdvantageNorm {
    mean: f32,
    spread: f32,
}

impl AdvantageNorm {
    fn of(decisions: &[usize], advantages: &[f32]) -> Self {
        let count = decisions.len() as f64;
        let mean = decisions.iter().map(|&at| f64::from(advantages[at])).sum::<f64>() / count;
        if decisions.len() < 2 {
            // As in stable-baselines3, a single decision is not normalised, because it has no
            // spread.
            return Self { mean: 0.0, spread: 1.0 };
        }
        let squares = decisions.iter().map(|&at| (f64::from(advantages[at]) - mean).powi(2));
        let variance = squares.sum::<f64>() / (count - 1.0);
        Self { mean: mean as f32, spread: variance.sqrt() as f32 + 1e-8 }
    }

    fn apply(&self, advantage: f32) -> f32 {
        (advantage - self.mean) / self.spread
    }
}

impl Losses {
    fn add(&mut self, other: &Self, weight: f64) {
        self.policy_loss += weight * other.policy_loss;
        self.value_loss += weight * other.value_loss;
        self.entropy += weight * other.entropy;
        self.approx_kl += weight * other.approx_kl;
        self.clip_fraction += weight * other.clip_fraction;
    }
}

#[cfg(test)]
mod tests {
    use super::{Sample, decision_loss};
    use crate::ppo::PpoSettings;

    fn loss(logits: &[f32], value: f32, made: &Sample, settings: &PpoSettings) -> f64 {
        let found =
            decision_loss(logits, value, made, settings, 1.0, &mut vec![0.0; logits.len()]).losses;
        found.policy_loss + f64::from(settings.vf_coef) * found.value_loss
            - f64::from(settings.ent_coef) * found.entropy
    }

    #[test]
    fn slopes_are_those_of_the_loss() {
        let mut settings = PpoSettings::tuned();
        settings.ent_coef = 0.3;
        let logits = [0.4, -1.2, f32::NEG_INFINITY, 0.9, 0.0];
        for (advantage, log_probability) in
            [(1.5, -1.0), (-0.7, -1.0), (1.5, -2.5), (-0.7, -2.5), (1.5, -0.2), (-0.7, -0.2)]
        {
            let made = Sample { choice: 3, log_probability, advantage, target_return: 0.7 };
            let mut slopes = [0.0; 5];
            let found = decision_loss(&logits, 0.2, &made, &settings, 1.0, &mut slopes);
            assert_eq!(slopes[2], 0.0, "a masked vertiport has no slope");
            let step = 1e-2;
            for at in [0, 1, 3, 4] {
                let (mut up, mut down) = (logits, logits);
                up[at] += step;
                down[at] -= step;
                let rise = loss(&up, 0.2, &made, &settings) - loss(&down, 0.2, &made, &settings);
                let expected = rise / f64::from(2.0 * step);
                assert!(
                    (f64::from(slopes[at]) - expected).abs() < 1e-3,
                    "{} is not {expected}",
                    slopes[at]
                );
            }
            let rise =
                loss(&logits, 0.21, &made, &settings) - loss(&logits, 0.19, &made, &settings);
            assert!((f64::from(found.value_slope) - rise / 0.02).abs() < 1e-3);
        }
    }
}
