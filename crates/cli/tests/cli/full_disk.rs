//! Tests with a full disk: a command that cannot write ends with V102, the earlier files are
//! unchanged, and no incomplete file is left.
//!
//! Two kinds of full disk are tried: a limit on the length of files, which every Unix has and which
//! stops writing in the middle of a file, and a small file system, if this user may mount one.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::common::{folder, run, small_network, vertifleet};
use crate::contents::contents;

const REPORT: &str = "compare --network small.toml --policies greedy,prices --days 3 --report out";

/// A folder in which every command has written its files once.
fn prepared() -> tempfile::TempDir {
    let folder = folder();
    let at = folder.path();
    small_network(at);
    run(at, "scenario small.toml --seed 1 -o day.json");
    run(at, "simulate day.json --policy greedy --trace trace.csv");
    run(at, &format!("{REPORT} --seed 1"));
    run(at, &train("old"));
    std::fs::remove_file(at.join("old/mlp-checkpoint.safetensors")).expect("a checkpoint");
    folder
}

fn train(out: &str) -> String {
    format!(
        "train --network small.toml --policy mlp --steps 200 --set n_envs=2 --set n_steps=50 --set batch_size=100 \
         --set n_epochs=1 --set eval_days=1 --threads 1 --out {out}"
    )
}

/// Runs the program with a limit on the length of files: `blocks` blocks of 512 bytes, or of 1,024
/// bytes in some shells.
fn with_short_files(at: &Path, blocks: u32, arguments: &str) -> Output {
    let program = env!("CARGO_BIN_EXE_vertifleet");
    let script = format!("ulimit -f {blocks}; exec {program} {arguments}");
    let mut command = Command::new("sh");
    command.current_dir(at).env("XDG_CACHE_HOME", at.join("kept")).args(["-c", &script]);
    command.output().expect("a shell")
}

fn refuses(output: &Output, arguments: &str) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{arguments}: {said}");
    assert!(said.contains("error[V102]"), "{arguments}: {said}");
    assert!(said.contains("is still there, unchanged"), "{arguments}: {said}");
    assert!(!said.contains("panicked"), "{arguments}: {said}");
}

/// All files except TensorBoard's event files. These grow during a run, and a run goes on if they
/// cannot be written, so they do not count as results.
fn results(at: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let events = |path: &Path| path.components().any(|part| part.as_os_str() == "tensorboard");
    contents(at).into_iter().filter(|(path, _)| !events(path)).collect()
}

#[test]
fn a_limit_on_file_sizes_leaves_all_files_unchanged() {
    let folder = prepared();
    let at = folder.path();
    let before = results(at);
    for (blocks, arguments) in [
        (2, "scenario small.toml --seed 2 -o day.json".to_owned()),
        (2, "scenario small.toml --seed 2 -o new.json".to_owned()),
        (1, "simulate day.json --policy prices --trace trace.csv".to_owned()),
        (1, "plan day.json --time-limit 0 -o trace.csv".to_owned()),
        // The first file of the report fits, but the pictures do not.
        (8, format!("{REPORT} --seed 2")),
        (8, format!("{REPORT} --seed 2").replace("out", "above/new")),
    ] {
        refuses(&with_short_files(at, blocks, &arguments), &arguments);
        assert!(results(at) == before, "{arguments} changed something");
    }
}

#[test]
fn a_training_whose_checkpoint_cannot_be_written_keeps_the_weights_of_the_one_before() {
    let folder = prepared();
    let at = folder.path();
    let weights = |at: &Path| std::fs::read(at.join("old/mlp.safetensors")).expect("weights");
    let before = weights(at);
    let arguments = train("old").replace("--out", "--seed 2 --out");
    refuses(&with_short_files(at, 64, &arguments), &arguments);
    assert!(weights(at) == before);
    let left = results(&at.join("old"));
    assert!(left.iter().all(|(path, _)| !path.to_string_lossy().contains(".vertifleet-")));
}

#[test]
fn a_failed_write_to_stdout_is_a_failure() {
    if !Path::new("/dev/full").exists() {
        println!("skipped: this system has no /dev/full");
        return;
    }
    let folder = prepared();
    for arguments in [
        "scenario small.toml --seed 1",
        "simulate day.json --policy greedy --json",
        "compare --network small.toml --policies greedy --days 1 --seed 1",
    ] {
        let full = std::fs::File::options().write(true).open("/dev/full").expect("a device");
        let mut command = vertifleet(folder.path(), arguments);
        let output = command.stdout(full).output().expect("the program runs");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments}: {said}");
        assert!(said.contains("cannot write to stdout"), "{arguments}: {said}");
    }
}

/// The room of a small disk: enough for one report with its replay, and not for two.
const DISK_KIB: u32 = 2_048;

/// A small file system that is mounted at this path until the value is dropped.
struct SmallDisk(PathBuf);

impl SmallDisk {
    fn mount(at: &Path, kib: u32) -> Option<Self> {
        std::fs::create_dir(at).expect("a free name");
        let mut mount = Command::new("mount");
        let size = format!("size={kib}k");
        mount.args(["-t", "tmpfs", "-o", &size, "vertifleet-test"]).arg(at);
        let mounted = mount.output().is_ok_and(|output| output.status.success());
        mounted.then(|| Self(at.to_owned()))
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let unmounted = Command::new("umount").arg(&self.0).status();
        assert!(unmounted.is_ok_and(|status| status.success()), "{} stays", self.0.display());
    }
}

#[test]
fn a_full_disk_leaves_all_files_unchanged() {
    let folder = prepared();
    let at = folder.path();
    let Some(disk) = SmallDisk::mount(&at.join("disk"), DISK_KIB) else {
        println!("skipped: this user may mount nothing");
        return;
    };
    let report = |seed: u32| REPORT.replace("out", "disk/out") + &format!(" --seed {seed}");
    run(at, &report(1));
    run(at, "scenario small.toml --seed 1 -o disk/day.json");
    // The remaining room is enough for some of a report's files, but not for a day.
    let used: usize =
        contents(&disk.0).values().map(|bytes| bytes.len().div_ceil(4096) * 4096).sum();
    let room: usize = ((DISK_KIB as usize) << 10) - used;
    assert!(room > 8192, "the disk takes one report and a day: {used} bytes");
    std::fs::write(disk.0.join("filling"), vec![1; room - 8192]).expect("room");
    let before = contents(&disk.0);
    for arguments in [
        report(2),
        report(2).replace("disk/out", "disk/new"),
        "scenario small.toml --seed 2 --days 3 -o disk/days".to_owned(),
    ] {
        refuses(&vertifleet(at, &arguments).output().expect("the program runs"), &arguments);
        if !arguments.contains("--days 3 -o") {
            assert!(contents(&disk.0) == before, "{arguments} changed something");
        }
    }
}
