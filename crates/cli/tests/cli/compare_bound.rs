//! `compare` with upper bounds and the planner, as a user runs it.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;

/// A folder that contains a network with short days and few aircraft, so that planning is fast.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let paper = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../networks/paper.toml");
    let paper = fs::read_to_string(paper).expect("the shipped network");
    let small = paper.replace("end = \"18:00:00\"", "end = \"06:45:00\"");
    assert_ne!(small, paper);
    fs::write(folder.path().join("small.toml"), small).expect("a file");
    folder
}

fn compare(folder: &Path, arguments: &str) -> Command {
    let mut command = cargo_bin_cmd!("vertifleet");
    command.current_dir(folder).env("XDG_CACHE_HOME", folder.join("kept"));
    command.args(["compare", "--network", "small.toml"]).args(arguments.split_whitespace());
    command
}

fn stdout(mut command: Command) -> String {
    let output = command.assert().success().get_output().stdout.clone();
    String::from_utf8(output).expect("text")
}

/// The results without the times and the command, because only these may differ between two runs.
fn results(text: &str) -> Value {
    let mut results: Value = serde_json::from_str(text).expect("JSON");
    results["command"].take();
    for policy in results["policies"].as_array_mut().expect("a list") {
        if policy["decision_ns"].is_object() {
            policy["decision_ns"] = "measured".into();
        }
    }
    results
}

#[test]
fn every_policy_has_its_share_of_the_bound_and_the_plan_is_marked() {
    let folder = folder();
    let at = folder.path();
    let asked = "--policies greedy,plan,rolling --days 3 --seed 1 --bound --step 15";
    let first = results(&stdout(compare(at, &format!("{asked} --json --report out"))));
    assert_eq!(first["bound"]["step_s"], 900);
    let policies = first["policies"].as_array().expect("a list");
    assert_eq!(policies.len(), 3);
    for policy in policies {
        let share = policy["bound_share"]["mean"].as_f64().expect("a share");
        assert!(share > 0.0 && share <= 1.0, "{policy}");
        assert_eq!(policy["decision_ns"].is_null(), policy["name"] == "plan");
    }
    for kind in ["svg", "png"] {
        assert!(at.join(format!("out/figure-bound-share.{kind}")).exists());
    }
    assert_eq!(fs::read_dir(at.join("kept/vertifleet")).expect("kept bounds").count(), 3);

    let again = results(&stdout(compare(at, &format!("{asked} --json --threads 1"))));
    assert_eq!(first, again, "kept bounds are the same, and threads change nothing");
    let people = stdout(compare(at, asked));
    assert!(people.contains("of bound, %") && people.contains("plan     whole day"), "{people}");
}

#[test]
fn bounds_are_proven_without_a_cache() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("kept"), "no folder").expect("a file");
    let asked = "--policies greedy --days 1 --seed 1 --bound --step 60";
    assert!(stdout(compare(at, asked)).contains("of bound, %"));
}

#[test]
fn a_step_without_a_bound_and_an_invalid_step_are_refused() {
    let folder = folder();
    compare(folder.path(), "--policies greedy --days 1 --seed 1 --step 3").assert().code(2);
    let refused = compare(folder.path(), "--policies greedy --days 1 --seed 1 --bound --step 0")
        .assert()
        .code(2);
    let said = String::from_utf8(refused.get_output().stderr.clone()).expect("text");
    assert!(said.starts_with("error[V501]"), "{said}");
}
