//! Compares the networks with PyTorch: outputs and gradients of an independent model, written
//! literally from Eq. 18-21.
//!
//! `reference/make_reference.py` regenerates the stored values; weights and inputs come from a
//! formula on whole numbers that is implemented both there and here.

use serde_json::Value;
use vertifleet_learn::nn::{Architecture, Inputs, NeuralNetwork, Shape, Slopes, Tensor};

/// Numbers in [-1, 1) that follow from a name and their index.
fn noise(name: &str, len: usize) -> Vec<f32> {
    let start = name
        .bytes()
        .fold(2_166_136_261_u32, |start, byte| (start ^ u32::from(byte)).wrapping_mul(16_777_619));
    (0..)
        .take(len)
        .map(|at: u32| {
            let mut x = start.wrapping_add(at).wrapping_mul(2_654_435_761);
            x ^= x >> 15;
            x = x.wrapping_mul(2_246_822_519);
            x ^= x >> 13;
            (x >> 8) as f32 / (1 << 23) as f32 - 1.0
        })
        .collect()
}

fn weight(tensor: &Tensor) -> Vec<f32> {
    let (base, reach) = match tensor.shape.as_slice() {
        &[inputs, _] => (0.0, (2.0 / inputs as f32).sqrt()),
        _ if tensor.name.rsplit('.').next() == Some("scale") => (1.0, 0.25),
        _ => (0.0, 0.25),
    };
    noise(&tensor.name, tensor.len()).iter().map(|noise| base + reach * noise).collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("an array").iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// Checks that a number agrees within `tolerance` of the larger of 1 and the reference.
fn assert_close(what: &str, found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs() / expected.abs().max(1.0);
    assert!(error < tolerance, "{what}: {found} is not {expected}");
}

fn norm(slopes: impl IntoIterator<Item = f64>) -> f64 {
    slopes.into_iter().map(|slope| slope * slope).sum::<f64>().sqrt()
}

fn check(kind: &str, stored: &str) {
    let cases: Value = serde_json::from_str(stored).expect("stored values are JSON");
    for case in cases.as_array().expect("cases") {
        let mut sizes = case["sizes"].clone();
        let members = sizes.as_object_mut().expect("sizes");
        let vertiports = members.remove("vertiports").and_then(|n| n.as_u64()).expect("a number");
        let vertiports = usize::try_from(vertiports).expect("a small number");
        members.insert("kind".to_owned(), kind.into());
        let architecture: Architecture = serde_json::from_value(sizes).expect("sizes of this kind");
        let (node_features, aircraft_features) = match kind {
            "gcaps-full" => (37, 11),
            _ => (2 * vertiports + 4, 2 * vertiports + 2),
        };
        let shape = Shape { vertiports, node_features, aircraft_features };
        check_case(&NeuralNetwork::new(architecture, shape).expect("sizes that fit"), case);
    }
}

fn check_case(net: &NeuralNetwork, case: &Value) {
    let Shape { vertiports, node_features, aircraft_features } = net.shape();
    let batch =
        case["batch"].as_u64().and_then(|batch| usize::try_from(batch).ok()).expect("a number");
    let logits: Vec<Option<f64>> =
        case["logits"].as_array().expect("logits").iter().map(Value::as_f64).collect();
    let mask: Vec<u8> = logits.iter().map(|logit| u8::from(logit.is_some())).collect();
    let edges = edges(net, batch);
    let inputs = Inputs {
        batch,
        nodes: &noise("nodes", batch * vertiports * node_features),
        aircraft: &noise("aircraft", batch * aircraft_features),
        mask: &mask,
        edges: &edges,
        clock: &noise("clock", batch),
    };
    let params: Vec<f32> = net.layout().tensors().iter().flat_map(weight).collect();
    let weights = net.weights(params);
    let mut workspace = net.workspace(batch);
    net.forward(&weights, inputs, &mut workspace);
    for (found, expected) in workspace.logits().iter().zip(&logits) {
        match expected {
            Some(expected) => assert_close("logit", f64::from(*found), *expected, 2e-5),
            None => assert!(found.is_infinite() && *found < 0.0, "a masked logit: {found}"),
        }
    }
    for (found, expected) in workspace.values().iter().zip(numbers(&case["values"])) {
        assert_close("value", f64::from(*found), expected, 2e-5);
    }

    let logit_slopes = noise("logit_slopes", batch * vertiports);
    let value_slopes = noise("value_slopes", batch);
    let mut gradient = net.gradient();
    let slopes = Slopes { logits: &logit_slopes, values: &value_slopes };
    net.backward(&weights, inputs, slopes, &mut workspace, &mut gradient);
    let gradient = net.finish(&weights, &mut gradient);
    let stored = case["slopes"].as_object().expect("slopes by tensor");
    assert_eq!(stored.len(), net.layout().tensors().len(), "the same tensors");
    for tensor in net.layout().tensors() {
        let slopes = &gradient[tensor.offset..][..tensor.len()];
        check_slopes(tensor, slopes, &stored[&tensor.name]);
    }
}

/// Weights of edges: half of them are 0, and the first vertiport has no neighbours.
fn edges(net: &NeuralNetwork, batch: usize) -> Vec<f32> {
    let count = net.shape().vertiports;
    if net.architecture().edges().is_none() {
        return Vec::new();
    }
    let mut edges = noise("edges", batch * count * count);
    for decision in edges.chunks_exact_mut(count * count) {
        decision[..count].fill(0.0);
    }
    edges.iter().map(|weight| weight.max(0.0)).collect()
}

fn check_slopes(tensor: &Tensor, slopes: &[f32], stored: &Value) {
    let name = &tensor.name;
    let slopes = slopes.iter().map(|&slope| f64::from(slope));
    if let Some(all) = stored.get("all") {
        let expected = numbers(all);
        let scale = norm(expected.iter().copied());
        let error = norm(slopes.zip(expected).map(|(found, expected)| found - expected));
        assert!(error < 1e-5 * scale, "{name}: slopes are off by {error} of {scale}");
        return;
    }
    let scale = stored["norm"].as_f64().expect("a number");
    if scale == 0.0 {
        assert_eq!(norm(slopes), 0.0, "{name} is not used");
        return;
    }
    assert_close(name, norm(slopes.clone()) / scale, 1.0, 1e-5);
    let directions = noise(&format!("{name} projection"), tensor.len());
    let projection: f64 =
        slopes.clone().zip(directions).map(|(slope, noise)| slope * f64::from(noise)).sum();
    assert_close(
        name,
        projection / scale,
        stored["projection"].as_f64().expect("a number") / scale,
        1e-5,
    );
    for (found, expected) in slopes.zip(numbers(&stored["first"])) {
        assert_close(name, found / scale, expected / scale, 1e-5);
    }
}

#[test]
fn gcaps_is_the_papers_network() {
    check("gcaps", include_str!("../reference/gcaps.json"));
}

#[test]
fn gcaps_on_other_graphs_equals_its_equations() {
    check("gcaps-full", include_str!("../reference/graphs.json"));
}

#[test]
fn mlp_is_plain_layers() {
    check("mlp", include_str!("../reference/mlp.json"));
}
