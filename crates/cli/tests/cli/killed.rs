//! Tests with `kill -9` at any moment: every file is complete, with either its old or its new
//! content. Unfinished files have names that begin with `.vertifleet-`, and no command reads them
//! as results.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::thread::sleep;
use std::time::Instant;

use crate::common::{folder, run, small_network, vertifleet};
use vertifleet_core::{Network, Scenario};
use vertifleet_learn::nn::Architecture;
use vertifleet_learn::{Curve, Model, TrainingRequest, TrainingSettings};
use vertifleet_sim::Trace;

/// Number of kills of each command; 25 in total.
const KILLS: u32 = 5;

/// The names in a folder, without those of unfinished files.
fn finished(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
    let names = entries.map(|entry| name(entry).to_string_lossy().into_owned());
    let mut names: Vec<String> = names.filter(|name| !name.starts_with(".vertifleet-")).collect();
    names.sort();
    names
}

/// Runs the command to its end once, and then kills it in five further runs, at moments spread over
/// the duration of the first run. `check` inspects the folder after each run. The moments are
/// always the same shares of that duration, but the program's state at each moment depends on the
/// machine.
fn kill_on_the_way(at: &Path, arguments: &str, mut check: impl FnMut(&Path)) {
    let begun = Instant::now();
    run(at, arguments);
    let whole = begun.elapsed();
    check(at);
    for kill in 0..KILLS {
        // Most of the writing happens late in a run.
        let share = [0.35, 0.7, 0.85, 0.95, 1.02][kill as usize];
        let mut command: Command = vertifleet(at, arguments);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = command.spawn().expect("the program runs");
        sleep(whole.mul_f64(share));
        // The program may have ended by now.
        let _ = child.kill();
        child.wait().expect("it ends");
        check(at);
    }
}

#[test]
fn days_are_whole_whenever_the_program_is_killed() {
    let folder = folder();
    small_network(folder.path());
    let draw = "scenario small.toml --seed 1 --days 40 -o days";
    kill_on_the_way(folder.path(), draw, |at| {
        let names = finished(&at.join("days"));
        assert_eq!(names.len(), 40, "{names:?}");
        for name in names {
            Scenario::read(at.join("days").join(name)).expect("a whole day");
        }
    });
    // An unfinished file must not count as one of the days to compare on.
    fs::write(folder.path().join("days/.vertifleet-abc123"), "{").expect("a file");
    run(folder.path(), "compare --days-from days --policies greedy");
}

#[test]
fn traces_are_whole_whenever_the_program_is_killed() {
    let folder = folder();
    let at = folder.path();
    small_network(at);
    run(at, "scenario small.toml --seed 1 -o day.json");
    let day = Scenario::read(at.join("day.json")).expect("a day");
    let check = |at: &Path| {
        Trace::read(&at.join("trace.csv"), &day).expect("a whole trace");
        assert_eq!(finished(at), ["day.json", "small.toml", "trace.csv"]);
    };
    kill_on_the_way(at, "simulate day.json --policy rolling --trace trace.csv", check);
    kill_on_the_way(at, "plan day.json --time-limit 0.3 --gap 0.5 -o trace.csv", check);
}

#[test]
fn a_report_is_whole_whenever_the_program_is_killed() {
    let folder = folder();
    small_network(folder.path());
    let mut expected: Option<Vec<String>> = None;
    let compare =
        "compare --network small.toml --policies greedy,prices --days 3 --seed 1 --report out";
    kill_on_the_way(folder.path(), compare, |at| {
        assert_eq!(finished(at), ["out", "small.toml"]);
        let names = finished(&at.join("out"));
        assert_eq!(*expected.get_or_insert_with(|| names.clone()), names, "nothing is missing");
        let read = |name: &str| fs::read_to_string(at.join("out").join(name)).expect("a file");
        let summary: serde_json::Value = serde_json::from_str(&read("summary.json")).expect("JSON");
        assert_eq!(summary["days"], 3);
        assert!(read("report.html").trim_end().ends_with("</html>"));
        assert_eq!(read("days.csv").lines().count(), 1 + 2 * 3);
        let paths = names.iter().map(|name| at.join("out").join(name));
        for path in paths.filter(|path| path.extension().is_some_and(|end| end == "png")) {
            let png = fs::read(&path).expect("a picture");
            assert!(png.ends_with(b"IEND\xaeB`\x82"), "{} has its end", path.display());
        }
    });
    // The files that the killed runs left must not prevent the next report.
    run(folder.path(), compare);
}

/// Settings of a short training.
const SETTINGS: [(&str, &str); 6] = [
    ("n_envs", "4"),
    ("n_steps", "25"),
    ("batch_size", "100"),
    ("n_epochs", "1"),
    ("eval_days", "1"),
    ("eval_every", "2"),
];

/// The training that `--steps 800` with these settings requests.
fn small_training(at: &Path) -> TrainingRequest {
    let policy = Architecture::named("mlp").expect("a policy with sizes");
    let mut settings = TrainingSettings::preset(&policy, "default").expect("a preset");
    settings.set(SETTINGS.into_iter().chain([("total_steps", "800")])).expect("good settings");
    let network = Arc::new(Network::read(at.join("small.toml")).expect("our network"));
    TrainingRequest {
        world: network.into(),
        policy,
        settings,
        seed: 1,
        begin_with: None,
        commit: String::new(),
    }
}

#[test]
fn a_training_is_whole_whenever_the_program_is_killed() {
    let folder = folder();
    small_network(folder.path());
    let set: Vec<String> =
        SETTINGS.iter().map(|(name, value)| format!("--set {name}={value}")).collect();
    let train = format!(
        "train --network small.toml --policy mlp --steps 800 {} --threads 1",
        set.join(" ")
    );
    let first = "--steps 400";
    run(folder.path(), &format!("{} --out run", train.replace("--steps 800", first)));
    // Each run is a new one, and its files replace those of the run before. The checkpoint is the
    // exception: it has to be removed by hand.
    let train = format!("{train} --out run");
    fs::remove_file(folder.path().join("run/mlp-checkpoint.safetensors")).expect("a checkpoint");
    kill_on_the_way(folder.path(), &train, |at| {
        let weights = at.join("run/mlp.safetensors");
        Model::read(&weights).expect("whole weights");
        let curves = Curve::read_beside(&weights).expect("a whole curve");
        assert!(!curves[0].is_empty());
        let checkpoint = at.join("run/mlp-checkpoint.safetensors");
        if checkpoint.exists() {
            let resumed = small_training(at).resume(&checkpoint);
            assert!(resumed.is_ok(), "{}", resumed.err().expect("an error"));
            fs::remove_file(&checkpoint).expect("our own file");
        }
        assert_eq!(finished(&at.join("run")), ["mlp-curve.csv", "mlp.safetensors", "tensorboard"]);
    });
}

#[test]
fn files_of_a_killed_program_stop_no_other_command() {
    let folder = folder();
    let at = folder.path();
    small_network(at);
    fs::write(at.join(".vertifleet-abc123"), "half a f").expect("a file");
    fs::create_dir_all(at.join(".vertifleet-def456/new")).expect("a folder");
    run(at, "scenario small.toml --seed 1 -o day.json");
    let compare = "compare --network small.toml --policies greedy --days 2 --seed 1 --report out";
    run(at, compare);
    run(at, compare);
    assert_eq!(finished(at), ["day.json", "out", "small.toml"]);
    assert!(at.join(".vertifleet-def456/new").exists(), "it may be another program's, at work");
}
