//! What `gcaps-x` promises, whatever its weights.

use std::sync::Arc;

use rayon::ThreadPoolBuilder;
use vertifleet_core::{DaySeed, Matrix, Network, Purpose, Scenario, VertiportIx, random_network};
use vertifleet_policy::{DayPrices, Policy, Priced, Shortlist, TryOut, play};
use vertifleet_sim::{Simulation, Trace, check::check};

use crate::nn::{Architecture, GcapsSettings, Inputs};
use crate::relative::features::{AIRCRAFT_FEATURES, NODE_FEATURES, Rows, Scene};
use crate::relative::judge::network;
use crate::relative::weights::Source;
use crate::relative::{AnyModel, Course, GcapsX, Plan, Study};

fn small() -> Architecture {
    Architecture::GcapsX(GcapsSettings { width: 8, heads: 2 })
}

fn course() -> Course {
    let expert = TryOut { horizon_s: 900, courses: 2, ..Course::default().expert };
    let small = Course { rounds: 2, days: 2, passes: 2, validation_days: 1, ..Course::default() };
    Course { expert, random_share: 0.5, ..small }
}

fn source() -> Source {
    Source { network: String::new(), course: course(), seed: 0, commit: String::new() }
}

/// First weights, the last layer's made large enough to change choices.
fn opinionated(seed: u64) -> Arc<AnyModel> {
    let net = network(&small(), 2);
    let mut params = net.init(seed);
    let pointer = net.layout().tensors().iter().find(|one| one.name == "decoder.pointer.weight");
    let pointer = pointer.expect("a network with a pointer");
    for weight in &mut params[pointer.offset..][..pointer.len()] {
        *weight *= 300.0;
    }
    Arc::new(AnyModel::new(small(), params, source(), 0))
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

fn played(day: &Arc<Scenario>, policy: &mut dyn Policy) -> Trace {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut trace = Trace::default();
    play(&mut simulation, policy, |row| trace.rows.push(*row)).expect("the policy plays the day");
    trace
}

#[test]
fn weights_of_zeros_decide_as_prices_do() {
    let zeros = vec![0.0; network(&small(), 2).layout().len()];
    let model = Arc::new(AnyModel::new(small(), zeros, source(), 0));
    let mut policy = GcapsX::new(model);
    for day in days() {
        assert_eq!(played(&day, &mut policy), played(&day, &mut Priced::default()));
    }
}

#[test]
fn the_less_is_at_stake_the_less_weights_add() {
    let paper = &days()[0];
    // How much a flight's worth may change for the strongest opinion about it, where so many of the day's passengers are left.
    let addition_usd = |one_in: u32| {
        let mut day = Scenario::clone(paper).into_day();
        day.demand.iter_mut().flat_map(Matrix::cells_mut).for_each(|cell| *cell /= one_in);
        let day = Arc::new(day.check("a thin day").expect("a day within the rules"));
        let mut simulation = Simulation::new(Arc::clone(&day));
        let decision = simulation.next_decision().expect("a decision");
        let view = simulation.view();
        let prices = DayPrices::of(view, decision.time);
        let scene = Scene::of(view, &decision, &prices);
        (scene.addition_usd(), scene.unit_usd)
    };
    let (full_usd, unit_usd) = addition_usd(1);
    assert_eq!(full_usd, unit_usd, "where flights are full, a share of a full flight");
    let (thin_usd, unit_usd) = addition_usd(40);
    assert!(0.0 < thin_usd && thin_usd < 0.1 * unit_usd, "{thin_usd}, {unit_usd}");
    assert_eq!(addition_usd(u32::MAX).0, 0.0, "nobody wants to fly");
}

#[test]
fn any_weights_keep_every_rule_on_networks_of_any_size() {
    let model = opinionated(1);
    for day in days() {
        let trace = played(&day, &mut GcapsX::new(Arc::clone(&model)));
        let report = check(&day, &trace);
        assert!(report.is_valid(), "{report}");
        assert_ne!(trace, played(&day, &mut Priced::default()), "the weights have a say");
    }
}

#[test]
fn roll_outs_keep_every_rule_and_have_one_outcome() {
    let paper = &days()[0];
    let mut policy = GcapsX::with_rollouts(opinionated(2), 3);
    let trace = played(paper, &mut policy);
    let report = check(paper, &trace);
    assert!(report.is_valid(), "{report}");
    assert_eq!(played(paper, &mut policy), trace);
}

#[test]
fn vertiports_in_another_order_get_their_logits_in_that_order() {
    let count = 7;
    let net = network(&small(), count);
    let model = opinionated(3);
    let number = |at: usize| ((at * 7919) % 1000) as f32 / 500.0 - 1.0;
    let nodes: Vec<f32> = (0..count * NODE_FEATURES).map(number).collect();
    let aircraft: Vec<f32> = (0..AIRCRAFT_FEATURES).map(number).collect();
    let order = [3, 0, 6, 2, 5, 1, 4];
    let moved: Vec<f32> = order
        .iter()
        .flat_map(|at| &nodes[at * NODE_FEATURES..][..NODE_FEATURES])
        .copied()
        .collect();
    let logits = |nodes: &[f32]| {
        let inputs = Inputs { batch: 1, nodes, aircraft: &aircraft, mask: &[1; 7], clock: &[0.0] };
        let mut workspace = net.workspace(1);
        net.forward(model.params(), &model.prepared(), inputs, &mut workspace);
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
        let mut rows = Rows::new(day.vertiports.len());
        let (mut shortlist, mut prices) = (Shortlist::default(), None);
        while let Some(decision) = simulation.next_decision() {
            let view = simulation.view();
            let prices = prices.get_or_insert_with(|| DayPrices::of(view, decision.time));
            let listed = shortlist.rank(prices, view, &decision);
            rows.push(Scene::of(view, &decision, prices), listed);
            let choice: VertiportIx = listed[0].1;
            simulation.apply(choice).expect("a choice from the mask");
        }
        let Inputs { nodes, aircraft, .. } = rows.inputs();
        for feature in nodes.iter().chain(aircraft) {
            assert!(feature.abs() <= 3.0, "{}: {feature}", day.name);
        }
    }
}

#[test]
fn a_weight_file_reads_as_it_was_written_and_knows_no_number_of_vertiports() {
    let model = opinionated(4);
    let read = AnyModel::from_bytes(&model.to_bytes(), "memory").expect("a weight file");
    assert_eq!((read.header(), read.params()), (model.header(), model.params()));
    let header = serde_json::to_string(read.header()).expect("plain data");
    assert!(!header.contains("\"vertiports\""), "{header}");
}

fn plan() -> Plan {
    let network = Arc::new(Network::shipped("paper").expect("a shipped network"));
    Plan { network, policy: small(), course: course(), seed: 5, commit: String::new() }
}

/// The weights when all rounds are done.
fn learned(mut study: Study) -> Vec<u8> {
    while !study.is_done() {
        study.round(&|| true).expect("days enough").expect("nobody stops it");
    }
    study.model().to_bytes()
}

#[test]
fn a_run_that_is_cut_off_goes_on_to_the_same_weights_and_rounds() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint");
    let mut cut = Study::start(plan()).expect("settings within their bounds");
    cut.round(&|| true).expect("days enough").expect("nobody stops it");
    cut.write_checkpoint(&path).expect("a file");
    assert!(cut.round(&|| false).expect("days enough").is_none(), "the second round is given up");

    let resumed = Study::resume(plan(), &path).expect("a checkpoint of this run");
    assert_eq!(resumed.rounds(), cut.rounds());
    let whole = Study::start(plan()).expect("settings within their bounds");
    assert!(learned(resumed) == learned(whole), "the same weights");
}

#[test]
fn a_checkpoint_of_another_run_or_damaged_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint");
    let mut study = Study::start(plan()).expect("settings within their bounds");
    study.round(&|| true).expect("days enough").expect("nobody stops it");
    study.write_checkpoint(&path).expect("a file");
    let refused = |plan: Plan| {
        let error = Study::resume(plan, &path).err().expect("another run");
        assert_eq!(error.code().to_string(), "V306");
        error.to_string()
    };
    assert!(refused(Plan { seed: 6, ..plan() }).contains("with seed 5, but 6 is asked for"));
    let course = Course { passes: 3, ..course() };
    assert!(refused(Plan { course, ..plan() }).contains("with setting passes 2, but 3"));
    let network = Arc::new(Network::shipped("new-york").expect("a shipped network"));
    assert!(refused(Plan { network, ..plan() }).contains("with network paper"));
    let policy = Architecture::GcapsX(GcapsSettings { width: 16, heads: 2 });
    assert!(refused(Plan { policy, ..plan() }).contains("with policy"));

    let whole = std::fs::read(&path).expect("the checkpoint");
    let text = |bytes: &[u8], from: &str, to: &str| {
        let at = bytes.windows(from.len()).position(|window| window == from.as_bytes());
        let mut bytes = bytes.to_vec();
        bytes[at.expect("a part of it")..][..to.len()].copy_from_slice(to.as_bytes());
        bytes
    };
    let not_finite = [&whole[..whole.len() - 4], &f32::NAN.to_le_bytes()].concat();
    for (bytes, rule) in [
        (whole[..whole.len() / 2].to_vec(), ""),
        (text(&whole, "lessons.8.nodes", "lessons.8.modes"), "lessons.8.nodes"),
        (text(&whole, "\\\"vertiports\\\":[8", "\\\"vertiports\\\":[0"), "1 to 256 vertiports"),
        (not_finite, "not finite"),
    ] {
        std::fs::write(&path, bytes).expect("a file");
        assert!(refused(plan()).contains(rule), "{rule}");
    }
}

#[test]
fn a_run_has_one_outcome_on_any_number_of_threads() {
    let run = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| learned(Study::start(plan()).expect("settings within their bounds")))
    };
    assert!(run(1) == run(3));
}
