//! Helpers for tests of all ways to learn.

use std::sync::Arc;

use rayon::ThreadPoolBuilder;
use vertifleet_core::{Network, Stop};
use vertifleet_learn::{Curve, TrainingRequest, TrainingRun};

/// The same run on days of the `paper` network that last two hours, for properties that hold for
/// days of any length.
pub(crate) fn on_mornings(asked: TrainingRequest) -> TrainingRequest {
    let paper = Network::shipped("paper").expect("a shipped network");
    let end = ("operations.end".to_owned(), "08:00:00".into());
    let morning = paper.changed([(&end.0, &end.1)]).expect("a network");
    TrainingRequest { world: Arc::new(morning).into(), ..asked }
}

pub(crate) fn advance(run: &mut dyn TrainingRun) {
    run.advance(&Stop::default(), &|_| ()).expect("training days are left");
}

/// A run that has learned everything that was requested.
pub(crate) fn finished(mut run: Box<dyn TrainingRun>) -> Box<dyn TrainingRun> {
    while !run.is_done() {
        advance(run.as_mut());
    }
    run
}

/// All files and weights of a run, to be compared bit for bit.
pub(crate) fn remains(run: &dyn TrainingRun) -> (Vec<u8>, Vec<u8>, Curve) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint");
    run.write_checkpoint(&path).expect("a folder to write to");
    (std::fs::read(path).expect("the checkpoint"), run.model().to_bytes(), run.curve())
}

/// Asserts that a run that is interrupted on three threads ends as one that is not, on one thread.
/// Returns the run as it was at the interruption.
pub(crate) fn interrupted(plan: &TrainingRequest) -> Box<dyn TrainingRun> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint.safetensors");
    let on = |threads| ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let start = || plan.clone().start().expect("a plan");
    let whole = on(1).install(|| remains(finished(start()).as_ref()));
    on(3).install(|| {
        let mut first = start();
        advance(first.as_mut());
        first.write_checkpoint(&path).expect("a folder to write to");
        let rest = plan.clone().resume(&path).expect("its run");
        assert_eq!((rest.curve(), rest.work()), (first.curve(), first.work()));
        assert!(remains(finished(rest).as_ref()) == whole, "{plan:?}");
        first
    })
}
