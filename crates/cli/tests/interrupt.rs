//! Ctrl-C of a training: it ends cleanly, and the run goes on as if nothing had happened.
#![cfg(unix)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use vertifleet_learn::Checkpoint;

/// A run of many short updates, so that a signal never finds it at its end.
const TRAIN: &str = "train --network paper --policy mlp --seed 5 --steps 6000 --set n_envs=4 --set n_steps=25 \
                     --set batch_size=100 --set n_epochs=1 --set eval_days=1 --set eval_every=20 --threads 1";

fn train(folder: &Path, more: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vertifleet"));
    command.current_dir(folder).args(TRAIN.split_whitespace()).args(more.split_whitespace());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// The event files of the run in `out`.
fn event_files(out: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(out.join("tensorboard/mlp")) else { return Vec::new() };
    entries.map(|entry| entry.expect("an entry").path()).collect()
}

/// Waits until the run has told of its first update: then it has long listened for signals.
fn wait_for_first_update(child: &mut Child, out: &Path) {
    let told = || {
        let files = event_files(out);
        files.iter().any(|file| {
            let bytes = fs::read(file).expect("an event file");
            bytes.windows(16).any(|window| window == b"train/value_loss")
        })
    };
    while !told() {
        assert!(child.try_wait().expect("a child").is_none(), "the run ended before it began");
        sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_training_ended_by_ctrl_c_goes_on_to_the_same_weights() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let whole = train(at, "--out whole").output().expect("the program runs");
    assert!(whole.status.success(), "{whole:?}");

    let mut child = train(at, "--out cut").spawn().expect("the program runs");
    wait_for_first_update(&mut child, &at.join("cut"));
    let signal = format!("kill -INT {}", child.id());
    assert!(Command::new("sh").args(["-c", &signal]).status().expect("a shell").success());
    let cut = child.wait_with_output().expect("the program ends");
    let said = String::from_utf8_lossy(&cut.stderr);
    assert_eq!(cut.status.code(), Some(0), "{said}");
    assert!(said.contains("stopping") && said.contains("stopped early"), "{said}");
    Checkpoint::read(&at.join("cut/mlp-checkpoint.safetensors")).expect("a whole checkpoint");
    let file = |name: &str| fs::read(at.join(name)).expect("a file of the run");
    let curve = |name: &str| fs::read_to_string(at.join(name)).expect("a learning curve");
    let (all, some) = (curve("whole/mlp-curve.csv"), curve("cut/mlp-curve.csv"));
    assert!(some.lines().count() > 1 && all.len() > some.len(), "it was cut short on its way");

    let resumed = train(at, "--out cut --resume").output().expect("the program runs");
    assert!(resumed.status.success(), "{resumed:?}");
    assert!(file("cut/mlp.safetensors") == file("whole/mlp.safetensors"), "the same weights");
    assert!(curve("cut/mlp-curve.csv") == all, "the same curve");
    assert_eq!(event_files(&at.join("cut")).len(), 1, "each step is in TensorBoard's files once");
}
