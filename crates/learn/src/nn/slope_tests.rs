//! Checks slopes against finite differences: each layer alone, then both networks as a whole.
//!
//! A layer is checked with the loss `sum of outputs times fixed numbers`, entry by entry, by
//! central differences. Single precision leaves about three digits. That is enough: an error in a
//! derivative is rarely so small, and the comparison with PyTorch's stored values checks the whole
//! networks to five digits.

use crate::nn::batch::{Inputs, Slopes};
use crate::nn::gcaps::reads::Reads;
use crate::nn::init::{Init, draw};
use crate::nn::layer_norm::{LayerNorm, Normalised};
use crate::nn::layout::{Layout, Tensors};
use crate::nn::linear::Linear;
use crate::nn::network::NeuralNetwork;
use crate::nn::product::{Matrix, MatrixMut, Write, multiply};
use crate::nn::value_head::ValueHead;
use crate::nn::{Architecture, GcapsSettings, MlpSettings, Shape, relu};

const STEP: f32 = 4e-3;

pub(crate) fn numbers(len: usize, seed: u64) -> Vec<f32> {
    let mut layout = Layout::starting_at(0);
    layout.vector("numbers", len, Init::Uniform { inputs: 3, gain: 1.0 });
    draw(&layout, seed)
}

pub(crate) fn weighted(outputs: &[f32], weights: &[f32]) -> f64 {
    assert_eq!(outputs.len(), weights.len(), "a weight for every output");
    outputs
        .iter()
        .zip(weights)
        .map(|(output, weight)| f64::from(*output) * f64::from(*weight))
        .sum()
}

/// Checks the slopes of a loss in every `stride`-th entry of `at`. An entry that moves a rectifier
/// across its kink has different slopes on its two sides; such entries are left out, and must be
/// few.
pub(crate) fn check(
    what: &str,
    at: &[f32],
    slopes: &[f32],
    stride: usize,
    loss: impl Fn(&[f32]) -> f64,
) {
    assert_eq!(at.len(), slopes.len(), "{what}: a slope for every entry");
    let here = loss(at);
    let mut moved = at.to_vec();
    let (mut checked, mut kinks) = (0, 0);
    for entry in (0..at.len()).step_by(stride) {
        let mut rise = |step: f32| {
            moved[entry] = at[entry] + step;
            let slope = (loss(&moved) - here) / f64::from(moved[entry] - at[entry]);
            moved[entry] = at[entry];
            slope
        };
        let (right, left) = (rise(STEP), rise(-STEP));
        let (nearer_right, nearer_left) = (rise(STEP / 2.0), rise(-STEP / 2.0));
        let expected = f64::midpoint(nearer_right, nearer_left);
        let slope = f64::from(slopes[entry]);
        let tolerance = 2e-3 * expected.abs().max(1.0);
        checked += 1;
        // Where the loss is smooth, halving the step halves the difference of the two sides, and
        // their mean stays.
        let bend = (right - left) - 2.0 * (nearer_right - nearer_left);
        let drift = f64::midpoint(right, left) - expected;
        if bend.abs().max(drift.abs()) > tolerance {
            kinks += 1;
            continue;
        }
        assert!(
            (slope - expected).abs() < tolerance,
            "{what}, entry {entry}: {slope} is not {expected}"
        );
    }
    assert!(kinks * 2 <= checked, "{what}: {kinks} kinks among {checked} entries");
}

fn tensors(params: &[f32]) -> Tensors<'_> {
    Tensors { params, derived: &[] }
}

#[test]
fn linear_layer() {
    let mut layout = Layout::starting_at(0);
    let layer = Linear::new(&mut layout, "layer", (7, 4), 1.0);
    let params = numbers(layout.len(), 1);
    let (from, weights) = (numbers(3 * 7, 2), numbers(3 * 4, 3));
    let loss = |params: &[f32], from: &[f32]| {
        let mut to = [0.0; 12];
        layer.forward(tensors(params), from, &mut to);
        weighted(&to, &weights)
    };
    let (mut gradient, mut from_slopes) = (vec![0.0; params.len()], [0.0; 21]);
    layer.backward(&from, &weights, &mut gradient);
    layer.input_slopes(tensors(&params), &weights, Write::Set, &mut from_slopes);
    check("weights", &params, &gradient, 1, |params| loss(params, &from));
    check("input", &from, &from_slopes, 1, |from| loss(&params, from));
}

#[test]
fn rectifier() {
    let (from, weights) = (numbers(40, 1), numbers(40, 2));
    let forward = |from: &[f32]| {
        let mut to = from.to_vec();
        relu::forward(&mut to);
        to
    };
    let mut slopes = weights.clone();
    relu::backward(&forward(&from), &mut slopes);
    check("input", &from, &slopes, 1, |from| weighted(&forward(from), &weights));
}

#[test]
fn layer_normalisation() {
    let mut layout = Layout::starting_at(0);
    let layer = LayerNorm::new(&mut layout, "norm", 9);
    let params = numbers(layout.len(), 1);
    let (from, weights) = (numbers(2 * 9, 2), numbers(2 * 9, 3));
    let loss = |params: &[f32], from: &[f32]| {
        let (mut kept, mut to) = (Normalised::new(2, 9), [0.0; 18]);
        layer.forward(tensors(params), from, &mut kept, &mut to);
        weighted(&to, &weights)
    };
    let (mut kept, mut to) = (Normalised::new(2, 9), [0.0; 18]);
    layer.forward(tensors(&params), &from, &mut kept, &mut to);
    let (mut gradient, mut slopes) = (vec![0.0; params.len()], weights.clone());
    layer.backward(tensors(&params), &kept, &mut slopes, &mut gradient);
    check("weights", &params, &gradient, 1, |params| loss(params, &from));
    check("input", &from, &slopes, 1, |from| loss(&params, from));
}

#[test]
fn value_head() {
    let mut layout = Layout::starting_at(0);
    let head = ValueHead::new(&mut layout, 3, 4, 6);
    let params = numbers(layout.len(), 1);
    let (sums, clock, weights) = (numbers(5 * 6, 2), numbers(5, 3), numbers(5, 4));
    let forward = |params: &[f32], sums: &[f32]| {
        let (mut hidden, mut values) = (sums.to_vec(), [0.0; 5]);
        head.forward(tensors(params), &clock, &mut hidden, &mut values);
        (hidden, values)
    };
    let (hidden, _) = forward(&params, &sums);
    let (mut gradient, mut slopes) = (vec![0.0; params.len()], vec![0.0; sums.len()]);
    head.backward(tensors(&params), &clock, &hidden, &weights, &mut slopes, &mut gradient);
    check("sums", &sums, &slopes, 1, |sums| weighted(&forward(&params, sums).1, &weights));
    // The rows for features and the bias act on the sums, which the caller computes, so their
    // slopes are the caller's.
    for slot in [head.features(), head.hidden_bias] {
        assert!(
            slot.part(&gradient).iter().all(|slope| *slope == 0.0),
            "the caller's slopes are left alone"
        );
    }
    let own = head.hidden_bias.offset + head.hidden_bias.columns;
    let clock_row = head.features().offset + 3 * 6;
    for span in [clock_row..clock_row + 6, own..params.len()] {
        check("weights", &params[span.clone()], &gradient[span.clone()], 1, |part| {
            let mut params = params.clone();
            params[span.clone()].copy_from_slice(part);
            weighted(&forward(&params, &sums).1, &weights)
        });
    }
}

/// Queries, pointers, what is collected, means and logits are all checked as functions of capsules
/// and queries.
#[test]
fn attention_pointer_and_means() {
    let reads = Reads {
        vertiports: 5,
        heads: 2,
        width: 6,
        score_scale: 0.7,
        logit_scale: 0.4,
        attention: true,
    };
    let (batch, block) = (2, 6);
    let capsules = numbers(batch * 5 * block, 1);
    // Each sample has two queries, a pointer, and a shift of its logits.
    let queries = numbers(batch * 3 * block, 2);
    let (of_collected, of_means) = (numbers(batch * 2 * block, 3), numbers(batch * block, 4));
    let (of_logits, shifts) = (numbers(batch * 5, 5), numbers(batch, 6));
    let mask = [1, 0, 1, 1, 1, 1, 1, 1, 0, 0];
    let forward = |capsules: &[f32], queries: &[f32], shifts: &[f32]| {
        let mut space = reads.space(batch);
        let one = [1.0];
        for row in 0..3 {
            let to = if row < 2 {
                reads.query(&mut space, batch, row)
            } else {
                reads.pointer(&mut space, batch)
            };
            let rows = Matrix::new(queries, batch, 3 * block).columns(row * block, block);
            let identity = identity(batch);
            let identity = Matrix::new(&identity, batch, batch);
            multiply(to, Write::Set, identity, rows);
        }
        let unit = Matrix::new(&one, 1, 1);
        let shifts = Matrix::new(shifts, batch, 1);
        multiply(space.logit_shifts(batch), Write::Set, shifts, unit);
        let mut logits = vec![0.0; batch * 5];
        reads.attend(capsules, &mut space);
        reads.point(capsules, &mask, &space, &mut logits);
        (space, logits)
    };
    let loss = |capsules: &[f32], queries: &[f32], shifts: &[f32]| {
        let (space, mut logits) = forward(capsules, queries, shifts);
        for (logit, open) in logits.iter_mut().zip(mask) {
            assert_eq!(*logit == f32::NEG_INFINITY, open == 0, "masked and no other");
            *logit = if open == 0 { 0.0 } else { *logit };
        }
        weighted(&space.collected, &of_collected)
            + weighted(&space.means, &of_means)
            + weighted(&logits, &of_logits)
    };

    let (mut space, _) = forward(&capsules, &queries, &shifts);
    let identity = identity(batch);
    let identity = Matrix::new(&identity, batch, batch);
    for head in 0..2 {
        let slopes = Matrix::new(&of_collected, batch, 2 * block).columns(head * block, block);
        multiply(reads.collected_slopes(&mut space, batch, head), Write::Set, identity, slopes);
    }
    let slopes = Matrix::new(&of_means, batch, block);
    multiply(reads.mean_slopes(&mut space, batch), Write::Set, identity, slopes);
    reads.point_backward(&capsules, &mask, &of_logits, &mut space);
    let mut capsule_slopes = vec![0.0; capsules.len()];
    reads.attend_backward(&capsules, &mut space, &mut capsule_slopes);
    let (mut query_slopes, mut shift_slopes) = (vec![0.0; queries.len()], vec![0.0; batch]);
    for row in 0..3 {
        let to = MatrixMut::new(&mut query_slopes, batch, 3 * block).columns(row * block, block);
        multiply(to, Write::Set, identity, reads.query_slopes(&space, batch, row));
    }
    let to = MatrixMut::new(&mut shift_slopes, batch, 1);
    multiply(to, Write::Set, identity, space.shift_slopes(batch));
    check("capsules", &capsules, &capsule_slopes, 1, |capsules| loss(capsules, &queries, &shifts));
    check("queries", &queries, &query_slopes, 1, |queries| loss(&capsules, queries, &shifts));
    check("shifts", &shifts, &shift_slopes, 1, |shifts| loss(&capsules, &queries, shifts));
}

fn identity(size: usize) -> Vec<f32> {
    (0..size * size).map(|at| if at % (size + 1) == 0 { 1.0 } else { 0.0 }).collect()
}

/// Checks a whole network with weights of a size: 1 for weights that keep signals on one scale.
pub(crate) fn check_network(architecture: Architecture, seed: u64, size: f32) {
    let shape = Shape { vertiports: 5, node_features: 14, aircraft_features: 12 };
    let batch = 2;
    let net = NeuralNetwork::new(architecture, shape).expect("sizes that fit");
    // The first weights of logits and value are small on purpose; here they are enlarged so that
    // all of them matter.
    let mut params = net.init(seed);
    for tensor in net.layout().tensors() {
        let part = &mut params[tensor.offset..][..tensor.len()];
        let reach = size * (3.0 / tensor.shape[0] as f32).sqrt();
        for (param, noise) in part.iter_mut().zip(numbers(tensor.len(), seed + 1)) {
            *param = if tensor.init == Init::One { 1.0 } else { 0.0 } + reach * noise;
        }
    }
    let (nodes, aircraft) = (numbers(batch * 5 * 14, seed + 2), numbers(batch * 12, seed + 3));
    let clock = numbers(batch, seed + 4);
    let draws = numbers(batch * 5, seed + 5);
    let mask: Vec<u8> =
        draws.iter().enumerate().map(|(at, x)| u8::from(*x > -0.2 || at % 5 == 0)).collect();
    let edges: Vec<f32> =
        numbers(batch * 5 * 5, seed + 8).iter().map(|weight| weight.max(0.0)).collect();
    let inputs = Inputs {
        batch,
        nodes: &nodes,
        aircraft: &aircraft,
        mask: &mask,
        edges: &edges,
        clock: &clock,
    };
    let (of_logits, of_values) = (numbers(batch * 5, seed + 6), numbers(batch, seed + 7));

    let loss = |params: &[f32]| {
        let mut workspace = net.workspace(batch);
        net.forward(&net.weights(params.to_vec()), inputs, &mut workspace);
        let open = |(logit, &open): (&f32, &u8)| if open == 0 { 0.0 } else { *logit };
        let logits: Vec<f32> = workspace.logits().iter().zip(&mask).map(open).collect();
        weighted(&logits, &of_logits) + weighted(workspace.values(), &of_values)
    };
    let (weights, mut workspace) = (net.weights(params.clone()), net.workspace(batch));
    net.forward(&weights, inputs, &mut workspace);
    let mut gradient = net.gradient();
    let slopes = Slopes { logits: &of_logits, values: &of_values };
    net.backward(&weights, inputs, slopes, &mut workspace, &mut gradient);
    let gradient = net.finish(&weights, &mut gradient);
    for tensor in net.layout().tensors() {
        let span = tensor.offset..tensor.offset + tensor.len();
        check(
            &tensor.name,
            &params[span.clone()],
            &gradient[span.clone()],
            1 + tensor.len() / 40,
            |part| {
                let mut params = params.clone();
                params[span.clone()].copy_from_slice(part);
                loss(&params)
            },
        );
    }
}

#[test]
fn gcaps_whole() {
    // With seed 30, half of the biases move a rectifier across its kink, so the limit on left-out
    // entries would depend on the machine.
    for seed in [10, 20, 50] {
        check_network(Architecture::Gcaps(GcapsSettings::of_sizes(16, 4)), seed, 1.0);
    }
}

#[test]
fn mlp_whole() {
    for seed in [10, 20, 30] {
        check_network(
            Architecture::Mlp(MlpSettings { width: 16, layers: 3, value_width: 8 }),
            seed,
            1.0,
        );
    }
}
