//! `compare --days-from`: the user's own days instead of drawn ones.

use std::fs;
use std::path::Path;

use crate::common::{folder, run, small_network};
use serde_json::Value;

fn compared(at: &Path, arguments: &str) -> Value {
    let output = run(at, &format!("compare --policies random,greedy,prices --json {arguments}"));
    let mut results: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    for policy in results["policies"].as_array_mut().expect("a list") {
        policy["decision_ns"].take();
    }
    results
}

#[test]
fn files_of_drawn_days_earn_the_same_and_count_as_the_users_days() {
    let folder = folder();
    let at = folder.path();
    run(at, "scenario paper --seed 0 --days 2 -o days");
    let drawn = compared(at, "--network paper --seed 0 --days 2");
    let own = compared(at, "--days-from days --report out");
    for member in ["policies", "comparisons", "network", "days"] {
        assert_eq!(own[member], drawn[member], "{member}");
    }
    assert_eq!((&own["days_from"], &drawn["days_from"]), (&"days".into(), &Value::Null));
    assert_eq!((&own["seed"], &own["day_seeds"]), (&Value::Null, &Value::Null));
    assert_eq!(own["network_origin"], "shipped");
    let published = |results: &Value| results["published"].as_array().expect("a list").len();
    assert_eq!((published(&own), published(&drawn)), (0, 3));
    let page = fs::read_to_string(at.join("out/report.html")).expect("a page");
    assert!(page.contains("2 days from days") && !page.contains("of the paper."));
    let text = run(at, "compare --policies greedy --days-from days/paper-1.json days/paper-0.json");
    let text = String::from_utf8(text.stdout).expect("text");
    assert!(text.starts_with("network paper, 2 days of one's own from days\n"), "{text}");
}

#[test]
fn days_that_differ_in_all_but_their_vertiports_are_compared_and_bounded() {
    let folder = folder();
    let at = folder.path();
    small_network(at);
    run(at, "scenario small.toml --seed 1 --days 2 -o days");
    let day = fs::read_to_string(at.join("days/paper-1.json")).expect("a day");
    let richer = day.replace("\"name\": \"paper-1\"", "\"name\": \"with more stands\"");
    let richer = richer.replace("\"stands\": 6", "\"stands\": 9");
    assert_ne!(richer, day);
    fs::write(at.join("days/richer.json"), richer).expect("a file");
    let results = compared(at, "--days-from days --bound --step 30 --report out");
    assert_eq!((&results["network"], &results["days"]), (&"days".into(), &3.into()));
    assert_eq!(results["network_origin"], "own");
    assert!(results["bound"]["upper_bound_usd"]["mean"].is_number());
    let days = fs::read_to_string(at.join("out/days.csv")).expect("a table");
    assert!(days.contains("with more stands"));
}

#[test]
fn every_command_that_draws_days_prints_the_warnings_of_the_network() {
    let folder = folder();
    let at = folder.path();
    small_network(at);
    let small = fs::read_to_string(at.join("small.toml")).expect("a network");
    let weak = small.replace("battery_kwh = 110", "battery_kwh = 1");
    assert_ne!(weak, small);
    fs::write(at.join("weak.toml"), weak).expect("a file");
    for arguments in [
        "scenario weak.toml --seed 1",
        "compare --network weak.toml --policies greedy --days 2 --seed 1",
        "train --network weak.toml --policy mlp --steps 20 --set n_envs=1 --set n_steps=20 --set batch_size=20 \
         --set n_epochs=1 --set eval_days=1 --out run",
    ] {
        let said = String::from_utf8(run(at, arguments).stderr).expect("text");
        let warnings = said.matches("warning[V1").count();
        assert!((1..=10).contains(&warnings), "{arguments}: {said}");
        assert!(warnings < 10 || said.contains("more such warnings"), "{arguments}: {said}");
    }
}
