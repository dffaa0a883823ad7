//! What tests of all ways to learn do with a run.

use vertifleet_core::Stop;
use vertifleet_learn::{Curve, TrainingRun};

pub(crate) fn advance(run: &mut dyn TrainingRun) {
    run.advance(&Stop::default(), &|_| ()).expect("training days are left");
}

/// A run that has learned everything that was asked for.
pub(crate) fn finished(mut run: Box<dyn TrainingRun>) -> Box<dyn TrainingRun> {
    while !run.is_done() {
        advance(run.as_mut());
    }
    run
}

/// Everything that a run leaves, to be compared bit for bit.
pub(crate) fn remains(run: &dyn TrainingRun) -> (Vec<u8>, Vec<u8>, Curve) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint");
    run.write_checkpoint(&path).expect("a folder to write to");
    (std::fs::read(path).expect("the checkpoint"), run.model().to_bytes(), run.curve())
}
