//! `vertifleet sweep` as users run it: killed again and again, it ends with the same bytes as
//! without kills.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::cargo::cargo_bin;

const KILLS: usize = 20;
/// Time limit for a process's next cell.
const PATIENCE: Duration = Duration::from_mins(1);

fn sweep(folder: &Path) -> Command {
    let mut command = Command::new(cargo_bin!("vertifleet"));
    command
        .args(["sweep", "paper", "--policies", "prices,greedy", "--days", "2", "--seed", "3"])
        .args(["--vary", "fleet.0.count=30..40/1", "--vary", "tariffs.fare_level=0.85..1.1/0.05"])
        .args(["--out".as_ref(), folder.as_os_str()])
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command
}

/// The files of a folder by name, without those that a killed process may leave.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry"));
    entries
        .map(|entry| (entry.file_name().into_string().expect("a plain name"), entry.path()))
        .filter(|(name, _)| !name.starts_with(".vertifleet-"))
        .map(|(name, path)| (name, fs::read(path).expect("a file")))
        .collect()
}

#[test]
fn twenty_kills_change_no_byte() {
    let above = tempfile::tempdir().expect("a folder");
    // The reports name their command, so both sweeps have a folder of the same name.
    let (one, other) = (above.path().join("one"), above.path().join("other"));
    for folder in [&one, &other] {
        fs::create_dir(folder).expect("a folder");
    }
    let run = |at: &Path| sweep(Path::new("out")).current_dir(at).status().expect("it runs");
    assert!(run(&one).success());
    let kept = || {
        let journal = fs::read_to_string(other.join("out/cells.jsonl")).unwrap_or_default();
        // A kill may leave the last line torn, and the next process removes it.
        journal.matches('\n').count().saturating_sub(1)
    };
    for kill in 0..KILLS {
        let before = kept();
        let mut child = sweep(Path::new("out")).current_dir(&other).spawn().expect("it runs");
        let begun = Instant::now();
        while kept() == before {
            assert!(child.try_wait().expect("a child").is_none(), "it was done after {kill} kills");
            assert!(begun.elapsed() < PATIENCE, "no cell is finished");
            std::thread::sleep(Duration::from_millis(1));
        }
        // Some processes are killed just after a cell, others at any time of the next one.
        std::thread::sleep(Duration::from_millis(kill as u64 % 5));
        child.kill().expect("it is ours");
        child.wait().expect("it has ended");
        assert!(kept() > before, "what was finished is kept");
    }
    assert!(run(&other).success());
    assert!(files(&one.join("out")) == files(&other.join("out")), "after {KILLS} kills");
}
