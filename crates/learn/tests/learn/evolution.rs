//! Properties of a run by evolution, and of runs that begin with weights of another run.

use std::sync::Arc;

use crate::support::{finished, interrupted, on_mornings, remains};
use vertifleet_core::{Coded, Network, Stop, World};
use vertifleet_learn::nn::{Architecture, GcapsSettings, MlpSettings};
use vertifleet_learn::{Error, Model, TrainingRequest, TrainingRun, TrainingSettings};

fn small_mlp() -> Architecture {
    Architecture::Mlp(MlpSettings { width: 16, layers: 2, value_width: 8 })
}

fn small_gcaps_full() -> Architecture {
    Architecture::GcapsFull(GcapsSettings::of_sizes(8, 2))
}

fn shipped(network: &str) -> World {
    Arc::new(Network::shipped(network).expect("a shipped network")).into()
}

/// A short run by evolution, with these settings changed.
fn plan(policy: Architecture, changes: &[(&str, &str)]) -> TrainingRequest {
    let mut settings = TrainingSettings::preset(&policy, "evolution").expect("a preset");
    let short = [
        ("generations", "3"),
        ("pairs", "2"),
        ("days", "2"),
        ("random_share", "0"),
        ("eval_every", "2"),
        ("validation_days", "1"),
    ];
    settings.set(short.iter().chain(changes).copied()).expect("settings within their bounds");
    TrainingRequest {
        world: shipped("paper"),
        policy,
        settings,
        seed: 3,
        begin_with: None,
        commit: "test".to_owned(),
    }
}

/// The gains over prices that a run measured.
fn gains(run: &dyn TrainingRun) -> Vec<f64> {
    run.curve().measured("gain").into_iter().map(|(_, gain)| gain).collect()
}

#[test]
fn threads_and_interruptions_change_nothing() {
    let gcaps_x = Architecture::GcapsX(GcapsSettings::of_sizes(8, 2));
    for plan in [
        plan(small_mlp(), &[]),
        plan(small_gcaps_full(), &[]),
        // Days of several sizes, and a policy that caches the prices of one day at a time.
        plan(small_gcaps_full(), &[("random_share", "0.7"), ("generations", "1"), ("pairs", "1")]),
        plan(gcaps_x, &[("generations", "2"), ("pairs", "1")]),
    ]
    .map(on_mornings)
    {
        let mut run = interrupted(&plan);
        if !run.is_done() {
            let before = remains(run.as_ref());
            let stop = Stop::default();
            stop.request();
            assert!(matches!(run.advance(&stop, &|_| ()), Err(Error::Stopped)));
            assert!(remains(run.as_ref()) == before, "a stop undoes nothing and does nothing");
        }
    }
}

#[test]
fn weights_go_where_days_earn_more() {
    let longer = [
        ("generations", "12"),
        ("pairs", "8"),
        ("days", "4"),
        ("noise", "0.05"),
        ("learning_rate", "0.05"),
        ("eval_every", "4"),
        ("validation_days", "10"),
    ];
    let asked = plan(small_mlp(), &longer);
    let begun = asked.clone().start().expect("a plan").model();
    let run = finished(asked.clone().start().expect("a plan"));
    let gains = gains(run.as_ref());
    assert!(gains[2] > gains[0] && gains[0] > -1.0, "gains over prices: {gains:?}");
    assert_ne!(run.model().params(), begun.params());
}

#[test]
fn weights_that_are_not_improved_are_kept() {
    let mut asked = plan(small_mlp(), &[("learning_rate", "0")]);
    let begun = asked.clone().start().expect("a plan").model();
    assert_eq!(finished(asked.clone().start().expect("a plan")).model().params(), begun.params());
    asked.begin_with = Some(
        Model::new(begun.header().clone(), vec![0.25; begun.params().len()]).expect("weights"),
    );
    let run = finished(asked.start().expect("a plan"));
    assert!(run.model().params().iter().all(|&weight| weight == 0.25));
}

#[test]
fn every_way_to_learn_begins_with_given_weights() {
    let begun = plan(small_mlp(), &[]).start().expect("a plan").model();
    let given =
        Model::new(begun.header().clone(), vec![0.125; begun.params().len()]).expect("weights");
    for preset in ["default", "paper", "imitation", "evolution"] {
        let mut settings = TrainingSettings::preset(&small_mlp(), preset).expect("a preset");
        // A run first measures the weights that it begins with on validation days; one day keeps
        // the test fast.
        let days =
            if matches!(preset, "default" | "paper") { "eval_days" } else { "validation_days" };
        settings.set([(days, "1")]).expect("settings within their bounds");
        let run =
            TrainingRequest { settings, begin_with: Some(given.clone()), ..plan(small_mlp(), &[]) };
        let model = run.start().expect("a plan").model();
        assert_eq!(model.params(), given.params(), "{preset}");
        assert_eq!(model.header().begun_with, Some(given.sha256()), "{preset}");
        let read = Model::from_bytes(&model.to_bytes(), "again").expect("its own bytes");
        assert_eq!(read.header(), model.header(), "{preset}");
    }
}

#[test]
fn weights_that_do_not_fit_the_run_are_refused() {
    let begun = plan(small_mlp(), &[]).start().expect("a plan").model();
    let refused = |plan: TrainingRequest| {
        let error = plan.start().err().expect("no such run");
        assert_eq!(error.code().to_string(), "V303");
        error.to_string()
    };
    let wider = Architecture::Mlp(MlpSettings { width: 32, layers: 2, value_width: 8 });
    let other = TrainingRequest { begin_with: Some(begun.clone()), ..plan(wider, &[]) };
    assert!(refused(other).contains("same policy with the same sizes"));
    for (network, rule) in [("new-york", "as many vertiports"), ("as-coded", "feature_scales")] {
        let begin_with = Some(begun.clone());
        let other =
            TrainingRequest { world: shipped(network), begin_with, ..plan(small_mlp(), &[]) };
        assert!(refused(other).contains(rule), "{network}");
    }
}

#[test]
fn a_run_resumes_only_with_its_initial_weights() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint");
    let fresh = plan(small_mlp(), &[]);
    let begun = fresh.clone().start().expect("a plan").model();
    let asked = TrainingRequest { begin_with: Some(begun), ..fresh.clone() };
    asked.clone().start().expect("a plan").write_checkpoint(&path).expect("a file");
    let error = fresh.resume(&path).err().expect("another run");
    assert_eq!(error.code().to_string(), "V306");
    assert!(error.to_string().contains("begin_with"), "{error}");
    assert!(asked.resume(&path).is_ok());
}
