//! Properties that the networks have with any weights: the rows of a batch do not mix, masks hold,
//! vertiports differ only by their features, and gradients of chunks add up.

use vertifleet_learn::nn::{
    Architecture, GcapsSettings, GraphSettings, Inputs, Laplacian, MlpSettings, NeuralNetwork,
    Shape, Slopes,
};

const SHAPE: Shape = Shape { vertiports: 8, node_features: 20, aircraft_features: 18 };

fn networks() -> [NeuralNetwork; 2] {
    ["gcaps", "mlp"].map(|name| {
        let architecture = Architecture::named(name).expect("a policy");
        NeuralNetwork::new(architecture, SHAPE).expect("default sizes fit")
    })
}

/// Numbers in [-1, 1) without an obvious pattern.
fn spread(len: usize, pace: f32) -> Vec<f32> {
    (0..len).map(|at| (at as f32 * pace).fract() * 2.0 - 1.0).collect()
}

struct Decisions {
    nodes: Vec<f32>,
    aircraft: Vec<f32>,
    mask: Vec<u8>,
    clock: Vec<f32>,
}

impl Decisions {
    fn new(count: usize) -> Self {
        let Shape { vertiports, node_features, aircraft_features } = SHAPE;
        Self {
            nodes: spread(count * vertiports * node_features, 0.618_034),
            aircraft: spread(count * aircraft_features, 0.414_214),
            mask: (0..count * vertiports).map(|at| u8::from(at % 3 != 1)).collect(),
            clock: spread(count, 0.732_051),
        }
    }

    fn inputs(&self, first: usize, batch: usize) -> Inputs<'_> {
        let Shape { vertiports, node_features, aircraft_features } = SHAPE;
        let node_entries = vertiports * node_features;
        Inputs {
            batch,
            nodes: &self.nodes[first * node_entries..][..batch * node_entries],
            aircraft: &self.aircraft[first * aircraft_features..][..batch * aircraft_features],
            mask: &self.mask[first * vertiports..][..batch * vertiports],
            edges: &[],
            clock: &self.clock[first..][..batch],
        }
    }
}

/// Initial weights, with those of the logits enlarged so that differences between vertiports show.
fn weights(net: &NeuralNetwork) -> Vec<f32> {
    let mut params = net.init(3);
    for tensor in net.layout().tensors() {
        if ["decoder.pointer.weight", "logits.weight"].contains(&tensor.name.as_str()) {
            params[tensor.offset..][..tensor.len()].iter_mut().for_each(|param| *param *= 100.0);
        }
    }
    params
}

/// The logits and the values.
fn answers(net: &NeuralNetwork, params: &[f32], inputs: Inputs<'_>) -> (Vec<f32>, Vec<f32>) {
    let mut workspace = net.workspace(inputs.batch);
    net.forward(&net.weights(params.to_vec()), inputs, &mut workspace);
    (workspace.logits().to_vec(), workspace.values().to_vec())
}

fn assert_close(found: &[f32], expected: &[f32], tolerance: f32) {
    assert_eq!(found.len(), expected.len(), "as many numbers");
    for (found, expected) in found.iter().zip(expected) {
        let close = found.to_bits() == expected.to_bits()
            || (found - expected).abs() < tolerance * expected.abs().max(1.0);
        assert!(close, "{found} is not {expected}");
    }
}

/// A batch of one uses other kernels of the matrix product than larger batches do, and these add up
/// in another order. So the answers agree to rounding, not to the bit, and the rounding error grows
/// with the logits.
#[test]
fn a_decision_in_a_batch_is_answered_as_if_alone() {
    let decisions = Decisions::new(64);
    for net in networks() {
        for (params, tolerance) in [(net.init(3), 1e-6), (weights(&net), 3e-6)] {
            let (logits, values) = answers(&net, &params, decisions.inputs(0, 64));
            for at in 0..64 {
                let (alone, value) = answers(&net, &params, decisions.inputs(at, 1));
                assert_close(&alone, &logits[at * 8..][..8], tolerance);
                assert_close(&value, &values[at..=at], tolerance);
            }
        }
    }
}

#[test]
fn masked_vertiports_have_a_logit_of_minus_infinity_and_move_nothing() {
    let decisions = Decisions::new(5);
    for net in networks() {
        let params = weights(&net);
        let inputs = decisions.inputs(0, 5);
        let (logits, values) = answers(&net, &params, inputs);
        for (logit, &open) in logits.iter().zip(inputs.mask) {
            assert_eq!(*logit == f32::NEG_INFINITY, open == 0);
        }
        let mask = [1; 40];
        let (open_logits, open_values) = answers(&net, &params, Inputs { mask: &mask, ..inputs });
        assert_eq!(values, open_values);
        for ((logit, open_logit), &open) in logits.iter().zip(&open_logits).zip(inputs.mask) {
            assert!(
                open == 0 || logit.to_bits() == open_logit.to_bits(),
                "{logit} is not {open_logit}"
            );
        }
        let mut slopes = spread(40, 0.3);
        let gradient = |slopes: &[f32]| gradient(&net, &params, &decisions, 5, slopes);
        let before = gradient(&slopes);
        slopes
            .iter_mut()
            .zip(inputs.mask)
            .filter(|(_, open)| **open == 0)
            .for_each(|(s, _)| *s = f32::NAN);
        assert_eq!(before, gradient(&slopes), "slopes at masked vertiports are ignored");
    }
}

#[test]
fn relabelled_vertiports_have_relabelled_logits_in_gcaps() {
    let [gcaps, _] = networks();
    let params = weights(&gcaps);
    let decisions = Decisions::new(1);
    let mask = [1; 8];
    let inputs = Inputs { mask: &mask, ..decisions.inputs(0, 1) };
    let (logits, value) = answers(&gcaps, &params, inputs);
    let order = [3, 0, 7, 5, 1, 2, 6, 4];
    let nodes: Vec<f32> =
        order.iter().flat_map(|&at| &decisions.nodes[at * 20..][..20]).copied().collect();
    let (relabelled, same_value) = answers(&gcaps, &params, Inputs { nodes: &nodes, ..inputs });
    let expected: Vec<f32> = order.iter().map(|&at| logits[at]).collect();
    assert_close(&relabelled, &expected, 1e-5);
    assert_close(&same_value, &value, 1e-5);
    let highest = logits.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    assert!(logits.iter().any(|logit| highest - logit > 1e-2), "logits that tell vertiports apart");
}

/// The gradient of at most 12 decisions, computed `chunk` at a time.
fn gradient(
    net: &NeuralNetwork,
    params: &[f32],
    decisions: &Decisions,
    chunk: usize,
    logit_slopes: &[f32],
) -> Vec<f32> {
    let count = logit_slopes.len() / 8;
    let value_slopes = spread(count, 0.236_068);
    let (weights, mut workspace) = (net.weights(params.to_vec()), net.workspace(12));
    let mut gradient = net.gradient();
    gradient.sums_mut().fill(7.0);
    gradient.clear();
    for first in (0..count).step_by(chunk) {
        let inputs = decisions.inputs(first, chunk.min(count - first));
        net.forward(&weights, inputs, &mut workspace);
        let of_logits = &logit_slopes[first * 8..][..inputs.batch * 8];
        let slopes = Slopes { logits: of_logits, values: &value_slopes[first..][..inputs.batch] };
        net.backward(&weights, inputs, slopes, &mut workspace, &mut gradient);
    }
    net.finish(&weights, &mut gradient).to_vec()
}

#[test]
fn gradients_of_chunks_add_up() {
    let decisions = Decisions::new(12);
    let slopes = spread(12 * 8, 0.414_214);
    for net in networks() {
        let params = weights(&net);
        let whole = gradient(&net, &params, &decisions, 12, &slopes);
        let chunks = gradient(&net, &params, &decisions, 5, &slopes);
        let scale = whole.iter().fold(0.0_f32, |most, slope| most.max(slope.abs()));
        let error = whole.iter().zip(&chunks).fold(0.0_f32, |most, (a, b)| most.max((a - b).abs()));
        assert!(error < 1e-5 * scale, "off by {error} of {scale}");
        assert_eq!(
            chunks,
            gradient(&net, &params, &decisions, 5, &slopes),
            "the same bits every time"
        );
    }
}

#[test]
fn the_first_policy_is_nearly_uniform_and_the_first_values_small() {
    let decisions = Decisions::new(64);
    for net in networks() {
        let (logits, values) = answers(&net, &net.init(1), decisions.inputs(0, 64));
        for decision in logits.chunks(8) {
            let open: Vec<f32> =
                decision.iter().copied().filter(|logit| logit.is_finite()).collect();
            let highest = open.iter().copied().fold(f32::NEG_INFINITY, f32::max);
            assert!(open.iter().all(|logit| highest - logit < 0.2), "{open:?}");
        }
        assert!(values.iter().all(|value| value.abs() < 1.0), "{values:?}");
    }
}

#[test]
fn both_networks_have_about_a_million_weights() {
    let [gcaps, mlp] = networks().map(|net| net.layout().len());
    assert_eq!(gcaps, 995_585);
    assert_eq!(mlp, 995_977);
}

#[test]
fn tensors_fill_the_layout_and_have_unique_names() {
    for net in networks() {
        let mut end = 0;
        let mut names = std::collections::BTreeSet::new();
        for tensor in net.layout().tensors() {
            assert_eq!(tensor.offset, end, "{} follows the one before", tensor.name);
            assert!(names.insert(&tensor.name), "{} is there twice", tensor.name);
            end += tensor.len();
        }
        assert_eq!(end, net.layout().len());
    }
}

#[test]
fn sizes_that_do_not_fit_are_refused() {
    let gcaps = |width, heads| Architecture::Gcaps(GcapsSettings::of_sizes(width, heads));
    let mlp = |width, layers| Architecture::Mlp(MlpSettings { width, layers, value_width: 8 });
    for (architecture, shape, word) in [
        (gcaps(30, 4), SHAPE, "multiple"),
        (gcaps(0, 1), SHAPE, "width"),
        (gcaps(16, 0), SHAPE, "heads"),
        (gcaps(usize::MAX, 1), SHAPE, "width"),
        (mlp(16, 0), SHAPE, "layers"),
        (mlp(16, 1 << 20), SHAPE, "layers"),
        (gcaps(16, 4), Shape { vertiports: 0, ..SHAPE }, "vertiports"),
        (mlp(16, 2), Shape { node_features: 1 << 40, ..SHAPE }, "node_features"),
    ] {
        let rule = NeuralNetwork::new(architecture, shape).expect_err("sizes that do not fit");
        assert!(rule.contains(word), "{rule:?} does not name {word}");
    }
}

#[test]
fn an_architecture_is_written_and_read_back() {
    for (name, written) in [
        ("gcaps", r#"{"kind":"gcaps","width":256,"heads":8}"#),
        ("mlp", r#"{"kind":"mlp","width":800,"layers":2,"value_width":256}"#),
    ] {
        let architecture = Architecture::named(name).expect("a policy");
        assert_eq!(serde_json::to_string(&architecture).expect("plain data"), written);
        assert_eq!(
            serde_json::from_str::<Architecture>(written).expect("what was written"),
            architecture
        );
        assert_eq!(architecture.name(), name);
    }
    serde_json::from_str::<Architecture>(r#"{"kind":"gcaps","width":256,"heads":8,"depth":2}"#)
        .expect_err("an unknown member");
    assert_eq!(Architecture::named("greedy"), None);
}

/// On the complete graph of N vertiports, I - D^-1 A is N / (N - 1) times (D - A) / N. So weights
/// that compensate for this factor give the same logits in two encoders that share no code.
#[test]
fn the_encoder_of_any_graph_is_that_of_the_paper_on_the_complete_graph() {
    let settings = GcapsSettings::of_sizes(32, 4);
    let general = GraphSettings { laplacian: Laplacian::Normalised, ..GraphSettings::default() };
    let general = GcapsSettings { graph: general, ..settings.clone() };
    let [paper, general] = [settings, general]
        .map(|settings| NeuralNetwork::new(Architecture::Gcaps(settings), SHAPE).expect("sizes"));
    let of_paper = weights(&paper);
    let mut of_general = vec![0.0; general.layout().len()];
    let shrink = (SHAPE.vertiports - 1) as f32 / SHAPE.vertiports as f32;
    for tensor in general.layout().tensors() {
        let same = paper.layout().tensors().iter().find(|same| same.name == tensor.name);
        let from = &of_paper[same.expect("the same tensors").offset..][..tensor.len()];
        let hops = tensor
            .name
            .split_once(".hop_")
            .map_or(0, |(_, rest)| rest[..1].parse::<i32>().expect("a number of hops"));
        let to = &mut of_general[tensor.offset..][..tensor.len()];
        to.iter_mut().zip(from).for_each(|(to, from)| *to = from * shrink.powi(hops));
    }
    let decisions = Decisions::new(5);
    let (logits, values) = answers(&paper, &of_paper, decisions.inputs(0, 5));
    let (same_logits, same_values) = answers(&general, &of_general, decisions.inputs(0, 5));
    assert_close(&same_logits, &logits, 1e-4);
    assert_close(&same_values, &values, 1e-4);
}
