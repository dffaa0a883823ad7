//! One pass of imitation over the dataset, which moves probability to the choices with the highest
//! mean worth.
//!
//! With p the softmax of worth over logits (of the logits alone, for a policy that decides without
//! prices), and A the value of each choice by roll-outs, the loss of a decision is
//!
//! ```text
//! L = -sum over j of p_j A_j  -  entropy_weight H(p)
//! ```
//!
//! Noise in A does not change the mean of this loss, and the loss weights a decision by the amount
//! at stake in it. A minibatch is cut into chunks of one number of vertiports each. A fixed number
//! of lanes process the chunks, so the resulting weights do not depend on the number of threads.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::{IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator};
use vertifleet_observe::{LOGITS_A_UNIT, Observation};

use crate::adam::{Adam, clip_norm};
use crate::imitation::dataset::{Dataset, Samples};
use crate::nn::{self, Architecture, Gradient, Slopes, Weights, Workspace};
use crate::rows::Rows;

/// Vertiports per forward and backward pass: as many as fit in the second-level cache. The graph of
/// the aircraft is not counted, so that the steps of a run do not depend on whether there is one.
const CHUNK_NODES: usize = 1_024;
/// Chunks per step of Adam.
const CHUNKS_A_STEP: usize = 8;
/// Number of gradients that are filled in parallel and then added up.
const LANES: usize = 4;
/// Largest Euclidean norm of the gradient of a step.
const MAX_NORM: f32 = 0.5;

/// The state and the working memory of learning.
pub(crate) struct Optimiser {
    architecture: Architecture,
    /// The network whose products are derived and whose gradient is completed; neither depends on
    /// the number of vertiports.
    net: nn::NeuralNetwork,
    pub(crate) weights: Weights,
    pub(crate) adam: Adam,
    lanes: Vec<Lane>,
}

/// Means over decisions.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Fit {
    /// Sum of p A, in units: the advantage of a choice drawn from p over the mean of the list.
    pub(crate) expected: f64,
    /// Advantage of the choice with the highest p over the best at the prices, in units.
    pub(crate) lift: f64,
    /// Advantage of the best choice of the list over the best at the prices, in units.
    pub(crate) most: f64,
    /// Share of decisions in which the choice with the highest p has the highest A.
    pub(crate) agreement: f64,
}

struct Lane {
    /// For the number of vertiports of the latest chunk.
    sized: Option<(nn::NeuralNetwork, Workspace, Rows)>,
    gradient: Gradient,
    slopes: Vec<f32>,
    no_slopes: Vec<f32>,
    fit: Fit,
}

/// Rows of samples with one number of vertiports.
struct Chunk {
    vertiports: usize,
    rows: Vec<usize>,
}

/// The settings of one step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pace {
    pub(crate) learning_rate: f32,
    /// The weight of the entropy, with A measured in logits.
    pub(crate) entropy_weight: f32,
}

impl Optimiser {
    /// The learner of a policy that fits this number of vertiports, or any.
    pub(crate) fn new(
        architecture: Architecture,
        vertiports: usize,
        params: Vec<f32>,
        adam: Adam,
    ) -> Self {
        let net = architecture.network(vertiports);
        let lane = || Lane {
            sized: None,
            gradient: net.gradient(),
            slopes: Vec::new(),
            no_slopes: Vec::new(),
            fit: Fit::default(),
        };
        let lanes = (0..LANES).map(|_| lane()).collect();
        Self { adam, weights: net.weights(params), architecture, net, lanes }
    }

    /// Makes one pass over the dataset, in an order that follows from the seed. Returns the means,
    /// with each decision measured before the step that learns from it.
    pub(crate) fn pass(
        &mut self,
        dataset: &Dataset,
        seed: u64,
        mut pace: impl FnMut(f64) -> Pace,
    ) -> Fit {
        let mut chunks = chunks(dataset);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        for chunk in &mut chunks {
            chunk.rows.shuffle(&mut random);
        }
        let mut chunks = cut(&chunks);
        chunks.shuffle(&mut random);
        let mut all = Fit::default();
        let steps = chunks.len().div_ceil(CHUNKS_A_STEP);
        for (step, chunks) in chunks.chunks(CHUNKS_A_STEP).enumerate() {
            let pace = pace(step as f64 / steps as f64);
            all.add(&self.step(dataset, chunks, pace));
        }
        all.over(dataset.len().max(1) as f64)
    }

    fn step(&mut self, dataset: &Dataset, chunks: &[Chunk], pace: Pace) -> Fit {
        let decisions: usize = chunks.iter().map(|chunk| chunk.rows.len()).sum();
        let weight = 1.0 / decisions as f32;
        let (architecture, weights) = (&self.architecture, &self.weights);
        self.lanes.par_iter_mut().enumerate().for_each(|(at, lane)| {
            lane.gradient.clear();
            lane.fit = Fit::default();
            for chunk in chunks.iter().skip(at).step_by(LANES) {
                let samples = &dataset.0[&chunk.vertiports];
                lane.work(architecture, weights, samples, &chunk.rows, pace.entropy_weight, weight);
            }
        });
        let (first, rest) = self.lanes.split_first_mut().expect("there are lanes");
        let mut fit = first.fit;
        for lane in rest {
            fit.add(&lane.fit);
            let sums = first.gradient.sums_mut().iter_mut();
            sums.zip(lane.gradient.sums()).for_each(|(sum, slope)| *sum += slope);
        }
        let gradient = self.net.finish(&self.weights, &mut first.gradient);
        clip_norm(gradient, MAX_NORM);
        let adam = &mut self.adam;
        let step = |params: &mut [f32]| adam.step(params, gradient, pace.learning_rate);
        self.net.update(&mut self.weights, step);
        fit
    }
}

impl Lane {
    fn work(
        &mut self,
        architecture: &Architecture,
        model_weights: &Weights,
        samples: &Samples,
        rows: &[usize],
        entropy_weight: f32,
        weight: f32,
    ) {
        let Self { sized, gradient, slopes, no_slopes, fit } = self;
        let vertiports = samples.rows.vertiports();
        if sized.as_ref().is_none_or(|(_, _, rows)| rows.vertiports() != vertiports) {
            let net = architecture.network(vertiports);
            let workspace = net.workspace(chunk_rows(vertiports));
            let rows = Rows::new(architecture, vertiports);
            *sized = Some((net, workspace, rows));
        }
        let (net, workspace, chosen) = sized.as_mut().expect("made above");
        chosen.clear();
        for &row in rows {
            chosen.push_copy(&samples.rows, row);
        }
        let inputs = chosen.inputs();
        net.forward(model_weights, inputs, workspace);
        slopes.clear();
        slopes.resize(rows.len() * vertiports, 0.0);
        no_slopes.clear();
        no_slopes.resize(rows.len(), 0.0);
        let priced_weight = priced_weight(architecture);
        let logits = workspace.logits().chunks_exact(vertiports);
        for ((logits, slopes), &row) in logits.zip(slopes.chunks_exact_mut(vertiports)).zip(rows) {
            let span = row * vertiports..(row + 1) * vertiports;
            let (priced, values) = (&samples.priced[span.clone()], &samples.values[span]);
            let judged = Advice { priced, values, priced_weight };
            fit.add(&decision_loss(logits, judged, slopes, entropy_weight, weight));
        }
        let slopes = Slopes { logits: slopes, values: no_slopes };
        net.backward(model_weights, inputs, slopes, workspace, gradient);
    }
}

/// The teacher's labels of the choices of a decision.
#[derive(Clone, Copy)]
struct Advice<'a> {
    priced: &'a [f32],
    values: &'a [f32],
    /// The factor of worth at the prices in a logit: 0 for a policy that decides without prices.
    priced_weight: f32,
}

/// The factor of worth at the prices in a logit when this policy decides.
fn priced_weight(policy: &Architecture) -> f32 {
    match policy.observation() {
        Observation::Priced { .. } => LOGITS_A_UNIT as f32,
        Observation::Paper | Observation::Full { .. } => 0.0,
    }
}

/// Sets the slopes of a decision's loss, times `weight`. Returns the fit of the decision.
fn decision_loss(
    logits: &[f32],
    Advice { priced, values, priced_weight }: Advice<'_>,
    slopes: &mut [f32],
    entropy_weight: f32,
    weight: f32,
) -> Fit {
    let unit = LOGITS_A_UNIT as f32;
    // This is minus infinity for a vertiport that is not on the list.
    let whole = |at: usize| logits[at] + priced_weight * priced[at];
    let highest = nn::maximum((0..logits.len()).map(whole));
    let total: f32 = (0..logits.len()).map(|at| (whole(at) - highest).exp()).sum();
    let log_total = highest + total.ln();
    let listed = || (0..logits.len()).filter(|&at| logits[at] > f32::NEG_INFINITY);
    let probability = |at: usize| (whole(at) - log_total).exp();
    let expected: f32 = listed().map(|at| probability(at) * values[at]).sum();
    let entropy: f32 = -listed().map(|at| probability(at) * (whole(at) - log_total)).sum::<f32>();
    for at in listed() {
        let advantage = unit * (values[at] - expected);
        let information = log_total - whole(at) - entropy;
        slopes[at] = -weight * probability(at) * (advantage + entropy_weight * information);
    }
    let pick = |score: &dyn Fn(usize) -> f32| {
        listed().fold((f32::NEG_INFINITY, 0), |best, at| {
            if score(at) > best.0 { (score(at), at) } else { best }
        })
    };
    let chosen = pick(&whole).1;
    let first = pick(&|at| priced[at]).1;
    let best = pick(&|at| values[at]).1;
    Fit {
        expected: f64::from(expected),
        lift: f64::from(values[chosen] - values[first]),
        most: f64::from(values[best] - values[first]),
        agreement: f64::from(u8::from(chosen == best)),
    }
}

fn chunk_rows(vertiports: usize) -> usize {
    (CHUNK_NODES / vertiports).max(1)
}

/// One chunk for each number of vertiports, with all of its rows.
fn chunks(dataset: &Dataset) -> Vec<Chunk> {
    let all = dataset.0.iter();
    all.map(|(&vertiports, samples)| Chunk { vertiports, rows: (0..samples.rows.len()).collect() })
        .collect()
}

/// Splits the chunks until each is small enough for a pass.
fn cut(chunks: &[Chunk]) -> Vec<Chunk> {
    let cut = chunks.iter().flat_map(|chunk| {
        let rows = chunk.rows.chunks(chunk_rows(chunk.vertiports));
        rows.map(|rows| Chunk { vertiports: chunk.vertiports, rows: rows.to_vec() })
    });
    cut.collect()
}

impl Fit {
    fn add(&mut self, other: &Self) {
        self.expected += other.expected;
        self.lift += other.lift;
        self.most += other.most;
        self.agreement += other.agreement;
    }

    fn over(self, count: f64) -> Self {
        Self {
            expected: self.expected / count,
            lift: self.lift / count,
            most: self.most / count,
            agreement: self.agreement / count,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Advice, LOGITS_A_UNIT, decision_loss};

    const ENTROPY_WEIGHT: f32 = 0.7;
    const PRICED: [f32; 4] = [0.0, -0.05, 0.0, -0.2];
    const VALUES: [f32; 4] = [0.04, -0.03, 0.0, -0.01];

    /// The loss of the module's equation in double precision, with A measured in logits; the third
    /// vertiport is not on the list.
    fn loss(logits: &[f32; 4]) -> f64 {
        let whole =
            [0, 1, 3].map(|at| f64::from(logits[at]) + LOGITS_A_UNIT * f64::from(PRICED[at]));
        let total: f64 = whole.iter().map(|whole| whole.exp()).sum();
        let terms = whole.iter().zip([0, 1, 3]).map(|(whole, at)| {
            let p = whole.exp() / total;
            -p * LOGITS_A_UNIT * f64::from(VALUES[at]) + f64::from(ENTROPY_WEIGHT) * p * p.ln()
        });
        terms.sum()
    }

    #[test]
    fn slopes_are_those_of_the_loss() {
        let logits = [0.3, -0.2, f32::NEG_INFINITY, 1.1];
        let mut slopes = [0.0; 4];
        let advice =
            Advice { priced: &PRICED, values: &VALUES, priced_weight: LOGITS_A_UNIT as f32 };
        let fit = decision_loss(&logits, advice, &mut slopes, ENTROPY_WEIGHT, 1.0);
        assert_eq!(slopes[2], 0.0, "what is not on the list moves nothing");
        for at in [0, 1, 3] {
            let moved = |by: f32| {
                let mut logits = logits;
                logits[at] += by;
                loss(&logits)
            };
            let slope = (moved(0.01) - moved(-0.01)) / 0.02;
            assert!((slope - f64::from(slopes[at])).abs() < 1e-4, "{at}: {slope}, {slopes:?}");
        }
        assert!(
            fit.agreement == 1.0 && fit.lift == 0.0,
            "the first is best by prices and by worth"
        );
    }
}
