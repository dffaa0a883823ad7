//! Properties of a training run by any way to learn: the weights are the same on any number of
//! threads and after any interruption.

use std::path::Path;
use std::sync::Arc;

use crate::support::{advance, finished, interrupted, on_mornings, remains};
use vertifleet_core::{Coded, DaySeed, Network, Purpose, Stop, World};
use vertifleet_learn::nn::{Adjacency, Architecture, GcapsSettings, GraphSettings, MlpSettings};
use vertifleet_learn::{Error, Model, TrainingRequest, TrainingSettings};

fn paper() -> Arc<Network> {
    Arc::new(Network::shipped("paper").expect("a shipped network"))
}

fn small_gcaps() -> Architecture {
    Architecture::Gcaps(GcapsSettings::of_sizes(16, 4))
}

fn small_mlp() -> Architecture {
    Architecture::Mlp(MlpSettings { width: 16, layers: 2, value_width: 8 })
}

fn small_gcaps_x() -> Architecture {
    Architecture::GcapsX(GcapsSettings::of_sizes(8, 2))
}

/// A policy of the full observation, which contains edges too.
fn small_gcaps_full() -> Architecture {
    full_with(GraphSettings { adjacency: Adjacency::Profit, ..GraphSettings::default() })
}

fn full_with(graph: GraphSettings) -> Architecture {
    Architecture::GcapsFull(GcapsSettings { graph, ..GcapsSettings::of_sizes(8, 2) })
}

fn small_mlp_full() -> Architecture {
    Architecture::MlpFull(MlpSettings { width: 16, layers: 2, value_width: 8 })
}

/// A short run of a policy, with these settings changed.
fn plan_with(policy: Architecture, changes: &[(&str, &str)]) -> TrainingRequest {
    short(policy, "default", changes)
}

/// A short run of a policy from a preset, with these settings changed.
fn short(policy: Architecture, preset: &str, changes: &[(&str, &str)]) -> TrainingRequest {
    let mut settings = TrainingSettings::preset(&policy, preset).expect("a preset");
    let short: &[(&str, &str)] = if matches!(settings, TrainingSettings::Imitation(_)) {
        &[
            ("rounds", "2"),
            ("days", "2"),
            ("passes", "1"),
            ("rollouts", "2"),
            ("horizon_s", "900"),
            // Days of random networks, which may be large, take a hundred times as long.
            ("random_share", "0"),
            ("validation_days", "1"),
        ]
    } else {
        &[
            ("total_steps", "2400"),
            ("n_envs", "20"),
            ("n_steps", "30"),
            ("batch_size", "250"),
            ("n_epochs", "2"),
            ("eval_every", "2"),
            ("eval_days", "2"),
        ]
    };
    settings.set(short.iter().chain(changes).copied()).expect("settings within their bounds");
    TrainingRequest {
        world: paper().into(),
        policy,
        settings,
        seed: 3,
        begin_with: None,
        commit: "test".to_owned(),
    }
}

fn plan(policy: Architecture) -> TrainingRequest {
    plan_with(policy, &[])
}

#[test]
fn threads_and_interruptions_change_nothing_by_ppo() {
    let terminal = plan_with(small_gcaps(), &[("reward", "terminal")]);
    let mornings = [plan(small_gcaps()), plan(small_mlp()), terminal].map(on_mornings);
    let new_places = [small_gcaps_full(), small_mlp_full(), small_mlp()]
        .map(|policy| TrainingRequest { world: World::RandomPlaces(5), ..plan(policy) });
    for plan in mornings.into_iter().chain(new_places) {
        interrupted(&plan);
    }
}

#[test]
fn threads_and_interruptions_change_nothing_by_imitation() {
    let any_network = plan_with(small_gcaps_x(), &[("random_share", "0.5")]);
    let by_themselves = [small_gcaps_full(), small_gcaps_x()]
        .map(|policy| plan_with(policy, &[("own_rounds", "1"), ("samples", "40")]));
    let papers = [small_gcaps(), small_mlp()].map(|policy| short(policy, "imitation", &[]));
    let plans = [plan(small_gcaps_x()), plan(small_gcaps_full()), any_network];
    for plan in plans.into_iter().chain(by_themselves).chain(papers) {
        interrupted(&on_mornings(plan));
    }
}

#[test]
fn a_stopped_run_has_its_former_state_and_continues() {
    for plan in [plan(small_gcaps()), plan(small_gcaps_x())].map(on_mornings) {
        let whole = finished(plan.clone().start().expect("a plan"));
        let mut run = plan.clone().start().expect("a plan");
        advance(run.as_mut());
        let before = remains(run.as_ref());
        let stop = Stop::default();
        let stopped = run.advance(&stop, &|_| {
            stop.request();
        });
        assert!(matches!(stopped, Err(Error::Stopped)), "{plan:?}");
        assert!(remains(run.as_ref()) == before, "{plan:?}");
        assert!(remains(finished(run).as_ref()) == remains(whole.as_ref()), "{plan:?}");
    }
}

fn refused(plan: TrainingRequest, checkpoint: &Path) -> String {
    let error = plan.resume(checkpoint).err().expect("another run");
    assert_eq!(error.code().to_string(), "V306", "{error}");
    error.to_string()
}

#[test]
fn a_checkpoint_of_another_run_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint.safetensors");
    for (policy, other, setting) in [
        (small_gcaps(), small_mlp(), ("gamma", "0.5")),
        (small_gcaps_x(), Architecture::GcapsX(GcapsSettings::of_sizes(16, 2)), ("passes", "3")),
    ] {
        let asked = plan(policy.clone());
        asked.clone().start().expect("a plan").write_checkpoint(&path).expect("a file");
        assert!(
            refused(TrainingRequest { seed: 9, ..asked.clone() }, &path).contains("seed 3, not 9")
        );
        assert!(refused(plan_with(policy, &[setting]), &path).contains(setting.0));
        assert!(
            refused(TrainingRequest { policy: other, ..asked.clone() }, &path).contains("policy")
        );
        let text = include_str!("../../../../networks/paper.toml")
            .replace("stands = 6\nbusy = true", "stands = 7\nbusy = true");
        let network = Arc::new(Network::from_toml(&text, "changed").expect("a network"));
        assert!(
            refused(TrainingRequest { world: network.into(), ..asked.clone() }, &path)
                .contains("has changed")
        );
        let network = Arc::new(Network::shipped("new-york").expect("a shipped network"));
        assert!(
            refused(TrainingRequest { world: network.into(), ..asked.clone() }, &path)
                .contains("network paper")
        );
        assert!(asked.resume(&path).is_ok());
    }
}

/// A file with a part of its text replaced by another text of the same length.
fn replaced(bytes: &[u8], from: &str, to: &str) -> Vec<u8> {
    let at = bytes.windows(from.len()).position(|window| window == from.as_bytes());
    let mut bytes = bytes.to_vec();
    bytes[at.expect("a part of it")..][..to.len()].copy_from_slice(to.as_bytes());
    bytes
}

#[test]
fn files_of_a_run_begin_with_their_format() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint");
    for policy in [small_mlp(), small_gcaps_x()] {
        let run = plan(policy).start().expect("a plan");
        run.write_checkpoint(&path).expect("a file");
        let checkpoint = std::fs::read(&path).expect("the checkpoint");
        for (file, format) in [(checkpoint, "checkpoint/2"), (run.model().to_bytes(), "weights/2")]
        {
            let opening =
                format!(r#"{{"__metadata__":{{"vertifleet":"{{\"format\":\"vertifleet-{format}"#);
            assert!(file[8..].starts_with(opening.as_bytes()), "{format}");
        }
    }
}

#[test]
fn a_damaged_checkpoint_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint");
    let asked = plan(small_gcaps_x());
    let mut run = asked.clone().start().expect("a plan");
    advance(run.as_mut());
    run.write_checkpoint(&path).expect("a file");
    let whole = std::fs::read(&path).expect("the checkpoint");
    let not_finite = [&whole[..whole.len() - 4], &f32::NAN.to_le_bytes()].concat();
    for (bytes, rule) in [
        (whole[..whole.len() / 2].to_vec(), ""),
        (replaced(&whole, "lessons.8.nodes", "lessons.8.modes"), "lessons.8.nodes"),
        (replaced(&whole, "\\\"vertiports\\\":[8", "\\\"vertiports\\\":[0"), "1 to 256 vertiports"),
        (replaced(&whole, "vertifleet-checkpoint/2", "vertifleet-checkpoint/9"), "format must be"),
        (not_finite, "not finite"),
    ] {
        std::fs::write(&path, bytes).expect("a file");
        assert!(refused(asked.clone(), &path).contains(rule), "{rule}");
    }
}

#[test]
fn another_seed_gives_other_weights() {
    let other = TrainingRequest { seed: 4, ..plan(small_gcaps()) };
    let [one, two] = [plan(small_gcaps()), other].map(|plan| plan.start().expect("a plan").model());
    assert_ne!(one.params(), two.params());
}

#[test]
fn a_run_may_keep_a_share_of_the_weights_it_began_with() {
    let first = plan(small_gcaps_x()).start().expect("a plan").model();
    let from = |kept: &str| {
        let asked = plan_with(small_gcaps_x(), &[("kept", kept)]);
        let asked = TrainingRequest { begin_with: Some(first.clone()), ..on_mornings(asked) };
        finished(asked.start().expect("a plan")).model()
    };
    let (learned, mixed) = (from("0"), from("0.25"));
    assert_ne!(learned.params(), first.params());
    let expected = learned.params().iter().zip(first.params()).map(|(l, f)| 0.75 * l + 0.25 * f);
    assert!(mixed.params().iter().zip(expected).all(|(mixed, mean)| (mixed - mean).abs() < 1e-6));
}

#[test]
fn settings_of_another_way_to_learn_are_refused() {
    let by_ppo = TrainingRequest { settings: plan(small_mlp()).settings, ..plan(small_gcaps_x()) };
    // The logits of the paper's policies are in no unit of money, so they cannot perturb roll-outs.
    let by_itself = short(small_gcaps(), "imitation", &[("own_rounds", "1")]);
    let keeps_fresh_weights = plan_with(small_gcaps_x(), &[("kept", "0.5")]);
    for run in [by_ppo, by_itself, keeps_fresh_weights] {
        let error = run.start().err().expect("no such run");
        assert_eq!(error.code().to_string(), "V303");
    }
}

#[test]
fn weights_read_as_they_were_written() {
    for policy in [small_mlp(), small_gcaps_x()] {
        let model = plan(policy).start().expect("a plan").model();
        let again = Model::from_bytes(&model.to_bytes(), "again").expect("weights");
        assert_eq!((again.header(), again.params()), (model.header(), model.params()));
    }
}

#[test]
fn damaged_weights_are_refused_and_never_a_panic() {
    let bytes = plan(small_mlp()).start().expect("a plan").model().to_bytes();
    for len in [0, 7, 8, 100, bytes.len() / 2, bytes.len() - 1] {
        let error = Model::from_bytes(&bytes[..len], "cut").expect_err("cut weights");
        assert_eq!(error.code().to_string(), "V304", "{error}");
    }
    for at in (0..3000).step_by(7) {
        let mut changed = bytes.clone();
        changed[at] ^= 0x15;
        // Some members of the header may take another value; the test only checks that nothing
        // panics.
        let _ = Model::from_bytes(&changed, "changed");
    }
}

#[test]
fn a_shape_that_no_network_has_is_refused() {
    let bytes = plan(small_mlp()).start().expect("a plan").model().to_bytes();
    let (length, rest) = bytes.split_at(8);
    let length = u64::from_le_bytes(length.try_into().expect("eight bytes"));
    let (header, tensors) = rest.split_at(usize::try_from(length).expect("small"));
    let header = str::from_utf8(header).expect("JSON");
    for vertiports in ["0", "3", "4097", "18446744073709551615", "null"] {
        let changed = header.replace(r#"vertiports\":8"#, &format!(r#"vertiports\":{vertiports}"#));
        assert_ne!(changed, header);
        let length = u64::try_from(changed.len()).expect("small").to_le_bytes();
        let changed = [&length, changed.as_bytes(), tensors].concat();
        let error = Model::from_bytes(&changed, "changed").expect_err("another shape");
        assert_eq!(error.code().to_string(), "V304", "{error}");
    }
}

#[test]
fn learning_raises_the_reward() {
    let longer = [
        ("total_steps", "72000"),
        ("eval_every", "10"),
        ("n_epochs", "4"),
        ("learning_rate", "0.003"),
    ];
    let run = finished(plan_with(small_gcaps(), &longer).start().expect("a plan"));
    let curve = run.curve().training_rewards();
    let (first, last) = (curve[15].1, curve[curve.len() - 1].1);
    assert!(last > 1.03 * first, "mean reward went from {first} to {last}");
}

#[test]
fn training_validation_and_comparison_never_share_a_day() {
    let seeds = [
        (DaySeed::comparison(7), Purpose::Comparison),
        (DaySeed::validation(7), Purpose::Validation),
        (DaySeed::training(7, 7), Purpose::Training),
    ];
    for (seed, purpose) in seeds {
        assert_eq!(seed.expect("a seed in range").purpose(), purpose);
    }
}

#[test]
fn graphs_and_worlds_that_do_not_fit_a_policy_are_refused_before_training() {
    let refused = |plan: TrainingRequest| plan.start().err().expect("no such run").to_string();
    let world = World::Random;
    let of_all_sizes = TrainingRequest { world: world.clone(), ..plan(small_mlp_full()) };
    assert!(refused(of_all_sizes).contains("learns on networks of one size"));
    assert!(refused(TrainingRequest { world, ..plan(small_mlp()) }).contains("of one size"));
    let share = plan_with(small_mlp_full(), &[("random_share", "0.5")]);
    assert!(refused(share).contains("random_share"));
    let graph = GraphSettings { adjacency: Adjacency::Reachable, ..GraphSettings::default() };
    let sizes = GcapsSettings { graph, ..GcapsSettings::of_sizes(8, 2) };
    for policy in [Architecture::Gcaps(sizes.clone()), Architecture::GcapsX(sizes)] {
        assert!(refused(plan(policy)).contains("shows no flights between two other vertiports"));
    }
}
