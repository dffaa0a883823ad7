//! Warnings about passengers whom no fleet can carry.

use serde_json::{Value, json};
use vertifleet_core::{Network, Warning};

const PAPER: &str = include_str!("../../../../networks/paper.toml");
const NEW_YORK: &str = include_str!("../../../../networks/new-york.toml");

fn changed(text: &str, changes: &Value) -> Network {
    let network = Network::from_toml(text, "network").expect("a network");
    network.changed(changes.as_object().expect("changes")).expect("a network")
}

#[test]
fn shipped_networks_have_no_such_passengers() {
    for name in Network::shipped_names() {
        assert_eq!(Network::shipped(name).expect("it is shipped").warnings(), [], "{name}");
    }
}

#[test]
fn passengers_on_pairs_without_a_corridor_are_counted() {
    let ids = ["V1", "V2", "V3", "V4", "V5", "V6", "V7", "V8"];
    let all = ids.iter().flat_map(|from| ids.iter().map(move |to| (from, to)));
    let lacks = |from: &str, to: &str| (from, to) == ("V2", "V5");
    let corridors: Vec<Value> = all
        .filter(|(from, to)| from != to && !lacks(from, to))
        .map(|(from, to)| json!({"from": from, "to": to}))
        .collect();
    let network = changed(PAPER, &json!({"corridors": corridors}));
    let means = network.mean_demand();
    let (from, to) = (1, 4);
    let expected: f64 = means.iter().map(|table| table.cells()[from * table.size() + to]).sum();
    let all: f64 = means.iter().flat_map(|table| table.cells().iter()).sum();
    let [Warning::PairsOutOfReach { passengers, of_all, most }] = &network.warnings()[..] else {
        panic!("{:?}", network.warnings());
    };
    assert!((passengers - expected).abs() < 1e-9 && (of_all - all).abs() < 1e-6);
    assert_eq!(most, &("V2".to_owned(), "V5".to_owned()));
}

#[test]
fn passengers_outside_the_hours_of_operation_are_counted() {
    let later = changed(NEW_YORK, &json!({"operations.start": "09:00:00"}));
    let network = Network::from_toml(NEW_YORK, "network").expect("a network");
    let periods = network.draw(vertifleet_core::DaySeed::comparison(1).expect("a seed"));
    let nine = later.operations().start;
    let before =
        periods.periods.iter().zip(network.mean_demand()).filter(|(start, _)| **start < nine);
    let expected: f64 = before.flat_map(|(_, table)| table.cells().to_vec()).sum();
    let [Warning::OutsideOperations { passengers, .. }] = later.warnings()[..] else {
        panic!("{:?}", later.warnings());
    };
    assert!(expected > 0.0 && (passengers - expected).abs() < 1e-9, "{passengers}, {expected}");
}
