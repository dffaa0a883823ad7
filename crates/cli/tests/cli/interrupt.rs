//! Tests of Ctrl-C: a training ends cleanly, and the resumed run goes on as if it had not been
//! interrupted; a comparison and a proof end at once and leave no incomplete files.
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::thread::sleep;
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;

/// A run of many short updates, so that it never ends before a signal arrives.
const TRAIN: &str = "train --network paper --policy mlp --seed 5 --steps 6000 --set n_envs=4 --set n_steps=25 \
                     --set batch_size=100 --set n_epochs=1 --set eval_days=1 --set eval_every=20 --threads 1";

/// The program, with signals enabled even if this test process was started with signals ignored, as
/// in the background of a script. Children inherit ignored signals, but not handled ones, so this
/// process registers handlers.
fn vertifleet(folder: &Path, arguments: &str) -> Command {
    let end = Arc::new(AtomicBool::new(true));
    for signal in [SIGINT, SIGTERM, SIGHUP] {
        flag::register_conditional_shutdown(signal, 130, Arc::clone(&end)).expect("a signal");
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_vertifleet"));
    command.current_dir(folder).args(arguments.split_whitespace());
    command.env("XDG_CACHE_HOME", folder.join("kept"));
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn train(folder: &Path, more: &str) -> Command {
    vertifleet(folder, &format!("{TRAIN} {more}"))
}

/// Sends the signal that Ctrl-C sends.
fn press_ctrl_c(child: &Child) {
    send("INT", child);
}

fn send(signal: &str, child: &Child) {
    let signal = format!("kill -{signal} {}", child.id());
    assert!(Command::new("sh").args(["-c", &signal]).status().expect("a shell").success());
}

/// Checks that Ctrl-C ends a program whose work would take many minutes, with the exit code of an
/// interrupted program and nothing on stdout.
fn ends_at_once(child: Child) {
    press_ctrl_c(&child);
    let pressed = Instant::now();
    let Output { status, stdout, stderr } = child.wait_with_output().expect("the program ends");
    let said = String::from_utf8_lossy(&stderr);
    assert_eq!(status.code(), Some(130), "{said}");
    assert!(stdout.is_empty() && said.contains("stopped"), "{said}");
    assert!(pressed.elapsed() < Duration::from_mins(1), "{:?}", pressed.elapsed());
}

fn names(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
    entries.map(|entry| name(entry).to_string_lossy().into_owned()).collect()
}

/// The event files of the run in `out`.
fn event_files(out: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(out.join("tensorboard/mlp")) else { return Vec::new() };
    entries.map(|entry| entry.expect("an entry").path()).collect()
}

/// Waits until the run has logged its first update. By then it has been listening for signals for a
/// while.
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
fn a_training_ended_by_ctrl_c_resumes_to_the_same_weights() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let whole = train(at, "--out whole").output().expect("the program runs");
    assert!(whole.status.success(), "{whole:?}");

    let mut child = train(at, "--out cut").spawn().expect("the program runs");
    wait_for_first_update(&mut child, &at.join("cut"));
    press_ctrl_c(&child);
    let cut = child.wait_with_output().expect("the program ends");
    let said = String::from_utf8_lossy(&cut.stderr);
    assert_eq!(cut.status.code(), Some(0), "{said}");
    assert!(said.contains("stopping") && said.contains("stopped early"), "{said}");
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

#[test]
fn a_training_of_gcaps_x_ended_by_ctrl_c_resumes_to_the_same_weights() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let train = |more: &str| {
        let course = "--set rounds=2 --set days=3 --set random_share=0 --set passes=1 --set validation_days=1 --set rollouts=1 --set horizon_s=600";
        vertifleet(at, &format!("train --network paper --policy gcaps-x --seed 5 {course} {more}"))
    };
    let whole = train("--out whole").output().expect("the program runs");
    assert!(whole.status.success(), "{whole:?}");

    let mut child = train("--out cut").spawn().expect("the program runs");
    // When the checkpoint of the first round exists, the second round has begun.
    while !at.join("cut/gcaps-x-checkpoint.safetensors").exists() {
        assert!(child.try_wait().expect("a child").is_none(), "the run ended before it began");
        sleep(Duration::from_millis(1));
    }
    press_ctrl_c(&child);
    let cut = child.wait_with_output().expect("the program ends");
    let said = String::from_utf8_lossy(&cut.stderr);
    assert_eq!(cut.status.code(), Some(0), "{said}");
    assert!(said.contains("stopping") && said.contains("stopped early"), "{said}");
    let file = |name: &str| fs::read(at.join(name)).expect("a file of the run");
    assert!(file("cut/gcaps-x-curve.csv") != file("whole/gcaps-x-curve.csv"), "it was cut short");

    let refused = train("--out cut").output().expect("the program runs");
    assert_eq!(refused.status.code(), Some(2), "an earlier run is not written over");
    let resumed = train("--out cut --resume").output().expect("the program runs");
    assert!(resumed.status.success(), "{resumed:?}");
    for name in ["gcaps-x.safetensors", "gcaps-x-curve.csv", "gcaps-x-checkpoint.safetensors"] {
        assert!(file(&format!("cut/{name}")) == file(&format!("whole/{name}")), "{name}");
    }
}

#[test]
fn a_comparison_ended_by_ctrl_c_leaves_whole_bounds_and_no_report() {
    let folder = tempfile::tempdir().expect("a folder");
    let kept = folder.path().join("kept/vertifleet");
    let asked = "compare --network paper --policies rolling --days 400 --seed 1 --bound --step 60";
    let compare = |report: &str| vertifleet(folder.path(), &format!("{asked} --report {report}"));
    let mut child = compare("new/report").spawn().expect("the program runs");
    // When some of the bounds exist, the command is still computing the others, and has been
    // listening for signals for a while.
    while names(&kept).iter().filter(|name| name.starts_with("bound-")).count() < 5 {
        assert!(child.try_wait().expect("a child").is_none(), "it ended before it began");
        sleep(Duration::from_millis(1));
    }
    ends_at_once(child);
    assert_eq!(names(folder.path()), ["kept"], "no folder for a report that there is none of");
    for name in names(&kept) {
        let text = fs::read_to_string(kept.join(&name)).expect("a kept bound");
        assert!(name.starts_with("bound-") && text.ends_with('}'), "{name} is half a file");
    }
}

/// Runs a command that reads a file called `pipe`, and writes this text into that pipe. When the
/// command has read the text, it listens for signals and begins to work.
fn begin(folder: &Path, arguments: &str, text: &[u8]) -> Child {
    let pipe = folder.join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("a command").success());
    let mut child = vertifleet(folder, arguments).spawn().expect("the program runs");
    fs::write(&pipe, text).expect("a reader");
    sleep(Duration::from_millis(300));
    assert!(child.try_wait().expect("a child").is_none(), "it is at work");
    child
}

#[test]
fn policies_and_plans_at_work_are_ended_by_ctrl_c() {
    let paper = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../networks/paper.toml");
    let paper = fs::read(paper).expect("the shipped network");
    for policy in ["rolling", "plan"] {
        let folder = tempfile::tempdir().expect("a folder");
        let compare = format!("compare --network pipe --policies {policy} --days 400 --seed 1");
        ends_at_once(begin(folder.path(), &compare, &paper));
    }
}

#[test]
fn a_proof_ended_by_ctrl_c_prints_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawn = vertifleet(folder.path(), "scenario paper --seed 1").output();
    let day = drawn.expect("the program runs").stdout;
    ends_at_once(begin(folder.path(), "bound pipe --step 1", &day));
}

/// Some signals are ignored at the start of the program, as they are under `nohup`, or in the
/// background of a shell without job control.
#[cfg(target_os = "linux")]
#[test]
fn signals_ignored_at_the_start_stay_ignored() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let begin =
        format!("trap '' INT HUP; exec {} {TRAIN} --out run", env!("CARGO_BIN_EXE_vertifleet"));
    let mut child = Command::new("sh");
    child.current_dir(at).args(["-c", &begin]).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = child.spawn().expect("a shell");
    wait_for_first_update(&mut child, &at.join("run"));
    send("INT", &child);
    send("HUP", &child);
    sleep(Duration::from_millis(300));
    assert!(child.try_wait().expect("a child").is_none(), "it goes on");
    send("TERM", &child);
    let ended = child.wait_with_output().expect("the program ends");
    let said = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(0), "{said}");
    assert_eq!(said.matches("stopping").count(), 1, "it heard the last signal alone: {said}");
}
