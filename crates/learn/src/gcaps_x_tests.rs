//! The properties that `gcaps-x` has with any weights.

use std::sync::Arc;

use vertifleet_core::{DaySeed, Matrix, Network, Purpose, Scenario, VertiportIx, random_network};
use vertifleet_policy::{BidPricePolicy, DayPrices, Policy, Shortlist, play};
use vertifleet_sim::{Simulation, Trace, check::check};

use vertifleet_observe::PricedDecision;

use crate::GcapsX;
use crate::nn::{Architecture, GcapsSettings, Inputs, Shape, Weights};
use crate::rows::Rows;
use crate::scorer::Scorer;

fn small() -> Architecture {
    Architecture::GcapsX(GcapsSettings::of_sizes(8, 2))
}

fn policy(weights: Arc<Weights>, most_rolled_out: usize) -> GcapsX {
    GcapsX::of(Scorer::new(&small(), None, weights), most_rolled_out)
}

fn opinionated(seed: u64) -> Arc<Weights> {
    with_opinions(&small(), seed)
}

/// Initial weights with a last layer that is large enough to change choices.
pub(crate) fn with_opinions(policy: &Architecture, seed: u64) -> Arc<Weights> {
    let net = policy.network(2);
    let mut params = net.init(seed);
    let pointer = net.layout().tensors().iter().find(|one| one.name == "decoder.pointer.weight");
    let pointer = pointer.expect("a network with a pointer");
    for weight in &mut params[pointer.offset..][..pointer.len()] {
        *weight *= 300.0;
    }
    Arc::new(net.weights(params))
}

/// A day of `paper`, two of random networks, and one of `paper` with a curfew and a fog.
fn days() -> Vec<Arc<Scenario>> {
    let seed = DaySeed::validation(3).expect("a seed");
    let paper = Network::shipped("paper").expect("a shipped network");
    let closures = "[[closures]]\nstart = \"14:00:00\"\nend = \"30:00:00\"\nvertiports = [\"V1\"]\n\
                    [[closures]]\nstart = \"07:00:00\"\nend = \"09:00:00\"\nvertiports = [\"V6\"]\n\
                    known = false\n[feature_scales]";
    let closed = Network::from_toml(&paper.toml().replace("[feature_scales]", closures), "closed")
        .expect("a good network");
    let random = [2, 7].map(|number| random_network(Purpose::Validation, number));
    let networks = [paper].into_iter().chain(random).chain([closed]);
    networks.map(|network| Arc::new(network.draw(seed))).collect()
}

pub(crate) fn played(day: &Arc<Scenario>, policy: &mut dyn Policy) -> Trace {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut trace = Trace::default();
    play(&mut simulation, policy, |row| trace.rows.push(*row)).expect("the policy plays the day");
    trace
}

#[test]
fn weights_of_zeros_decide_as_prices_do() {
    let net = small().network(2);
    let zeros = Arc::new(net.weights(vec![0.0; net.layout().len()]));
    let mut policy = policy(zeros, 1);
    for day in days() {
        assert_eq!(played(&day, &mut policy), played(&day, &mut BidPricePolicy::default()));
    }
}

#[test]
fn the_less_is_at_stake_the_less_weights_add() {
    let paper = &days()[0];
    // The size of the network's additions on a day with only this share of the passengers.
    let addition_usd = |one_in: u32| {
        let mut day = Scenario::clone(paper).into_day();
        day.demand.iter_mut().flat_map(Matrix::cells_mut).for_each(|cell| *cell /= one_in);
        let day = Arc::new(day.check("a thin day").expect("a day within the rules"));
        let mut simulation = Simulation::new(Arc::clone(&day));
        let decision = simulation.next_decision().expect("a decision");
        let view = simulation.view();
        let prices = DayPrices::of(view, decision.time);
        let scene = PricedDecision::of(view, &decision, &prices);
        (scene.addition_usd(), scene.unit_usd)
    };
    let (full_usd, unit_usd) = addition_usd(1);
    assert_eq!(full_usd, unit_usd, "where flights are full, a share of a full flight");
    let (thin_usd, unit_usd) = addition_usd(40);
    assert!(0.0 < thin_usd && thin_usd < 0.1 * unit_usd, "{thin_usd}, {unit_usd}");
    assert_eq!(addition_usd(u32::MAX).0, 0.0, "no passenger wants to fly");
}

#[test]
fn any_weights_keep_every_rule_on_networks_of_any_size() {
    let weights = opinionated(1);
    for day in days() {
        let trace = played(&day, &mut policy(Arc::clone(&weights), 1));
        let report = check(&day, &trace);
        assert!(report.is_valid(), "{report}");
        assert_ne!(trace, played(&day, &mut BidPricePolicy::default()), "the weights have a say");
    }
}

#[test]
fn roll_outs_keep_every_rule_and_have_one_outcome() {
    let paper = &days()[0];
    let mut policy = policy(opinionated(2), 3);
    let trace = played(paper, &mut policy);
    let report = check(paper, &trace);
    assert!(report.is_valid(), "{report}");
    assert_eq!(played(paper, &mut policy), trace);
}

#[test]
fn vertiports_in_another_order_get_their_logits_in_that_order() {
    let count = 7;
    let net = small().network(count);
    let Shape { node_features, aircraft_features, .. } = net.shape();
    let weights = opinionated(3);
    let number = |at: usize| ((at * 7919) % 1000) as f32 / 500.0 - 1.0;
    let nodes: Vec<f32> = (0..count * node_features).map(number).collect();
    let aircraft: Vec<f32> = (0..aircraft_features).map(number).collect();
    let order = [3, 0, 6, 2, 5, 1, 4];
    let moved: Vec<f32> = order
        .iter()
        .flat_map(|at| &nodes[at * node_features..][..node_features])
        .copied()
        .collect();
    let logits = |nodes: &[f32]| {
        let inputs = Inputs {
            batch: 1,
            nodes,
            aircraft: &aircraft,
            mask: &[1; 7],
            edges: &[],
            clock: &[0.0],
        };
        let mut workspace = net.workspace(1);
        net.forward(&weights, inputs, &mut workspace);
        workspace.logits().to_vec()
    };
    let (plain, moved) = (logits(&nodes), logits(&moved));
    for (&at, found) in order.iter().zip(moved) {
        assert!((plain[at] - found).abs() < 1e-4 * plain[at].abs().max(1.0));
    }
}

#[test]
fn features_are_bounded_on_every_network() {
    for day in days() {
        let mut simulation = Simulation::new(Arc::clone(&day));
        let mut rows = Rows::new(&small(), day.vertiports.len());
        let mut writer = small().writer(None);
        let (mut shortlist, mut prices) = (Shortlist::default(), None);
        while let Some(decision) = simulation.next_decision() {
            let view = simulation.view();
            let prices = prices.get_or_insert_with(|| DayPrices::of(view, decision.time));
            let listed = shortlist.rank(prices, view, &decision);
            rows.push(|row| writer.write(view, &decision, Some((prices, listed)), row));
            let choice: VertiportIx = listed[0].to;
            simulation.apply(choice).expect("a choice from the mask");
        }
        let Inputs { nodes, aircraft, .. } = rows.inputs();
        for feature in nodes.iter().chain(aircraft) {
            assert!(feature.abs() <= 3.0, "{}: {feature}", day.name);
        }
    }
}
