//! `generalise` and random networks by number, as a user runs them.

use std::path::Path;

use assert_cmd::Command;
use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;

fn vertifleet(folder: &Path, arguments: &str) -> Command {
    let mut command = cargo_bin_cmd!("vertifleet");
    command.current_dir(folder).env("XDG_CACHE_HOME", folder.join("kept"));
    command.args(arguments.split_whitespace());
    command
}

fn stdout(mut command: Command) -> String {
    let output = command.assert().success().get_output().stdout.clone();
    String::from_utf8(output).expect("text")
}

fn json(command: Command) -> Value {
    serde_json::from_str(&stdout(command)).expect("JSON")
}

#[test]
fn shares_are_those_of_the_networks_days_and_threads_change_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let asked = "generalise --networks 3 --policies greedy,random --step 60";
    let results = json(vertifleet(at, &format!("{asked} --json --report out")));
    let networks = results["networks"].as_array().expect("a list");
    assert_eq!(networks.len(), 3);
    assert!(at.join("out/report.html").exists() && at.join("out/networks.csv").exists());

    std::fs::write(at.join("day.json"), stdout(vertifleet(at, "scenario random:2 --seed 2")))
        .expect("a file");
    let bound = json(vertifleet(at, "bound day.json --step 60 --json"));
    assert_eq!(networks[2]["upper_bound_usd"], bound["upper_bound_usd"]);
    let greedy = json(vertifleet(at, "simulate day.json --policy greedy --json"));
    assert_eq!(networks[2]["results"][0]["profit_usd"], greedy["profit_usd"]);

    let mut again = json(vertifleet(at, &format!("{asked} --json --threads 1")));
    again["command"] = results["command"].clone();
    assert_eq!(again, results);
    let people = stdout(vertifleet(at, asked));
    assert!(people.starts_with("3 random networks, a day of each"), "{people}");
    assert!(people.contains("above greedy"), "{people}");
}

#[test]
fn policies_of_one_size_cannot_take_part() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = vertifleet(folder.path(), "generalise --networks 2 --policies greedy,gcaps");
    let said = command.assert().code(2).get_output().stderr.clone();
    let said = String::from_utf8(said).expect("text");
    assert!(said.starts_with("error[V307]"), "{said}");
}
