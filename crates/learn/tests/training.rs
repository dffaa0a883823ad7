//! What a training run promises: the same weights on any number of threads, and after any interruption.

use std::sync::Arc;

use rayon::ThreadPoolBuilder;
use vertifleet_core::{DaySeed, Network, Purpose};
use vertifleet_learn::nn::{Architecture, GcapsSettings, MlpSettings};
use vertifleet_learn::{Checkpoint, Model, Plan, Reward, Settings, Training};

fn plan(policy: Architecture, reward: Reward) -> Plan {
    let mut settings = Settings::tuned();
    settings.total_steps = 4 * 40 * 30;
    settings.n_envs = 40;
    settings.n_steps = 30;
    settings.batch_size = 500;
    settings.n_epochs = 2;
    settings.eval_every = 2;
    settings.eval_days = 3;
    settings.reward = reward;
    Plan {
        network: Arc::new(Network::shipped("paper").expect("a shipped network")),
        policy,
        settings,
        seed: 3,
        commit: "test".to_owned(),
    }
}

fn small_gcaps() -> Architecture {
    Architecture::Gcaps(GcapsSettings { width: 16, heads: 4 })
}

fn small_mlp() -> Architecture {
    Architecture::Mlp(MlpSettings { width: 16, layers: 2, value_width: 8 })
}

fn finish(mut training: Training) -> Training {
    while !training.is_done() {
        training.update(&|_| true).expect("training days are left");
    }
    training
}

/// Everything a run leaves, to the bit.
fn remains(training: &Training) -> (Checkpoint, Vec<u8>) {
    (training.checkpoint(), training.best_model().to_bytes())
}

#[test]
fn the_same_seed_gives_the_same_weights_on_any_number_of_threads() {
    for policy in [small_gcaps(), small_mlp()] {
        let on = |threads| {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let plan = plan(policy.clone(), Reward::Dense);
            pool.install(|| remains(&finish(Training::start(plan).expect("a plan"))))
        };
        let one = on(1);
        assert!(one == on(2) && one == on(3));
    }
}

#[test]
fn a_run_that_was_interrupted_ends_as_if_it_had_not_been() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint.safetensors");
    let plan = plan(small_gcaps(), Reward::Terminal);
    let whole = finish(Training::start(plan.clone()).expect("a plan"));

    let mut first = Training::start(plan.clone()).expect("a plan");
    first.update(&|_| true).expect("an update");
    first.checkpoint().write(&path).expect("a folder to write to");
    drop(first);
    let rest =
        Training::resume(plan, Checkpoint::read(&path).expect("a checkpoint")).expect("its run");
    assert!(remains(&finish(rest)) == remains(&whole));
}

#[test]
fn an_update_that_is_abandoned_leaves_the_checkpoint_before_it_good() {
    let plan = plan(small_gcaps(), Reward::Dense);
    let whole = finish(Training::start(plan.clone()).expect("a plan"));

    let mut first = Training::start(plan.clone()).expect("a plan");
    first.update(&|_| true).expect("an update");
    let before = first.checkpoint();
    let abandoned = first.update(&|done| done < 0.4).expect("an update");
    assert!(abandoned.is_none());
    let rest = Training::resume(plan, before).expect("its run");
    assert!(remains(&finish(rest)) == remains(&whole));
}

#[test]
fn a_network_that_has_changed_does_not_go_on() {
    let run = plan(small_gcaps(), Reward::Dense);
    let checkpoint = Training::start(run.clone()).expect("a plan").checkpoint();
    let text = include_str!("../../../networks/paper.toml")
        .replace("stands = 6\nbusy = true", "stands = 7\nbusy = true");
    let mut changed = run;
    changed.network = Arc::new(Network::from_toml(&text, "changed").expect("a network"));
    let error = Training::resume(changed, checkpoint).err().expect("another network");
    assert!(error.to_string().contains("has changed"), "{error}");
}

#[test]
fn another_seed_gives_other_weights() {
    let mut other = plan(small_gcaps(), Reward::Dense);
    other.seed = 4;
    let one = Training::start(plan(small_gcaps(), Reward::Dense)).expect("a plan");
    let two = Training::start(other).expect("a plan");
    assert_ne!(one.best_model().params(), two.best_model().params());
}

#[test]
fn a_checkpoint_of_another_run_is_refused() {
    let run = plan(small_gcaps(), Reward::Dense);
    let checkpoint = || Training::start(run.clone()).expect("a plan").checkpoint();
    let refused = |change: fn(&mut Plan)| {
        let mut other = run.clone();
        change(&mut other);
        let error = Training::resume(other, checkpoint()).err().expect("another run");
        assert_eq!(error.code().to_string(), "V306");
        error.to_string()
    };
    assert!(refused(|plan| plan.seed = 9).contains("seed"));
    assert!(refused(|plan| plan.settings.gamma = 0.5).contains("setting gamma"));
    assert!(refused(|plan| plan.policy = small_mlp()).contains("policy"));
    assert!(Training::resume(run.clone(), checkpoint()).is_ok());
}

#[test]
fn weights_read_as_they_were_written() {
    let training = Training::start(plan(small_mlp(), Reward::Dense)).expect("a plan");
    let model = training.best_model();
    let again = Model::from_bytes(&model.to_bytes(), "again").expect("weights");
    assert_eq!(again.header(), model.header());
    assert_eq!(again.params(), model.params());
}

#[test]
fn damaged_weights_are_refused_and_never_a_panic() {
    let training = Training::start(plan(small_mlp(), Reward::Dense)).expect("a plan");
    let bytes = training.best_model().to_bytes();
    for len in [0, 7, 8, 100, bytes.len() / 2, bytes.len() - 1] {
        let error = Model::from_bytes(&bytes[..len], "cut").expect_err("cut weights");
        assert_eq!(error.code().to_string(), "V304", "{error}");
    }
    for at in (0..3000).step_by(7) {
        let mut changed = bytes.clone();
        changed[at] ^= 0x15;
        // Some members of the header may take another value; what matters is that nothing panics.
        let _ = Model::from_bytes(&changed, "changed");
    }
}

#[test]
fn a_shape_that_no_network_has_is_refused() {
    let training = Training::start(plan(small_mlp(), Reward::Dense)).expect("a plan");
    let bytes = training.best_model().to_bytes();
    let (length, rest) = bytes.split_at(8);
    let length = u64::from_le_bytes(length.try_into().expect("eight bytes"));
    let (header, tensors) = rest.split_at(usize::try_from(length).expect("small"));
    let header = str::from_utf8(header).expect("JSON");
    for vertiports in [0, 3, 4_097, u64::MAX] {
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
    let mut plan = plan(small_gcaps(), Reward::Dense);
    plan.settings.total_steps = 60 * 40 * 30;
    plan.settings.eval_every = 10;
    plan.settings.n_epochs = 4;
    plan.settings.learning_rate = 3e-3;
    let training = finish(Training::start(plan).expect("a plan"));
    let curve = training.curve();
    let reward_at = |row: usize| curve[row].mean_reward.expect("days are over by then");
    let (first, last) = (reward_at(15), reward_at(curve.len() - 1));
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
