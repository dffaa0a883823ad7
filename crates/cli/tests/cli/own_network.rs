//! Tests of a user's own network, with its own table of demand and its own costs, from the network
//! file to the plan, and of the messages about a file of the wrong kind and a vertiport out of
//! reach.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;

const NEW_YORK: &str = include_str!("../../../../networks/new-york.toml");

fn vertifleet(folder: &Path, arguments: &str) -> Command {
    let mut command = cargo_bin_cmd!("vertifleet");
    command.current_dir(folder).args(arguments.split_whitespace());
    command
}

fn json(folder: &Path, arguments: &str) -> Value {
    let output = vertifleet(folder, arguments).assert().success().get_output().stdout.clone();
    serde_json::from_slice(&output).expect("JSON")
}

/// The stderr of a command that ends with the exit code `code`.
fn said(folder: &Path, arguments: &str, code: i32) -> String {
    let assert = vertifleet(folder, arguments).assert().code(code);
    String::from_utf8(assert.get_output().stderr.clone()).expect("text")
}

/// Writes a network with the demand of two pairs from a table, and with flight costs.
fn own_network(folder: &Path) {
    let begin = NEW_YORK.find("[daily_demand]").expect("a demand model");
    let end = NEW_YORK.find("[disturbances.forecast_error]").expect("what follows it");
    let costs = "[tariffs]\nboarding_fee_usd = 10\nflight_cost_usd = 30\n\
                 flight_cost_usd_per_mi = 0.5\naircraft_cost_usd_per_day = 40\n";
    let periods = NEW_YORK.find("periods = [").expect("periods");
    let periods = &NEW_YORK[periods..][..NEW_YORK[periods..].find("\n]").expect("their end") + 2];
    let hourly = format!("[hourly_demand]\n{periods}\ntable = \"demand.csv\"\n\n");
    let text = format!("{}{hourly}{}", &NEW_YORK[..begin], &NEW_YORK[end..]);
    let text = text.replacen("[tariffs]\n", costs, 1).replace("\"new-york\"", "\"own\"");
    fs::write(folder.join("own.toml"), text).expect("a free folder");
    let ids: Vec<&str> = NEW_YORK.lines().filter_map(|line| line.strip_prefix("id = \"")).collect();
    let id = |at: usize| ids[at].split('"').next().expect("an id");
    let table = format!(
        "\u{feff}period,from,to,passengers\r\n6:00:00,{0},{1},40\r\n12:00:00,{1},{0},60.5\r\n",
        id(0),
        id(1)
    );
    fs::write(folder.join("demand.csv"), table).expect("a free folder");
}

#[test]
fn a_day_of_a_network_with_a_table_and_costs_is_played_checked_bounded_and_planned() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    own_network(at);
    said(at, "scenario own.toml --seed 3 -o day.json", 0);
    let played = json(at, "simulate day.json --policy greedy --trace day.csv --json");
    // A trace that this program wrote is replaced without `--force`, even if it has the column of
    // flight costs.
    json(at, "simulate day.json --policy greedy --trace day.csv --json");
    let report = json(at, "check day.json day.csv --json");
    assert_eq!(report["valid"], true, "{report}");
    let number = |value: &Value, member: &str| value[member].as_f64().expect("a number");
    assert!(number(&played, "flight_cost_usd") > 0.0 && number(&played, "aircraft_cost_usd") > 0.0);
    for member in ["profit_usd", "flight_cost_usd", "aircraft_cost_usd"] {
        let found = number(&report["totals"], member);
        assert!((found - number(&played, member)).abs() < 1e-6, "{member}: {found}");
    }
    let bound = number(&json(at, "bound day.json --step 15 --json"), "upper_bound_usd");
    let plan = json(at, "plan day.json --time-limit 1 -o plan.csv --json");
    for pair in plan["passenger_shadow_price_usd"].as_array().expect("a list") {
        assert_ne!(pair["from"], pair["to"], "no passenger flies from a vertiport to itself");
    }
    assert!(number(&plan, "profit_usd") >= number(&played, "profit_usd"));
    assert!(number(&plan, "profit_usd") <= bound, "{plan}: {bound}");
    assert_eq!(json(at, "check day.json plan.csv --json")["valid"], true);
}

#[test]
fn no_output_replaces_the_table_of_a_network() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    own_network(at);
    let table = fs::read(at.join("demand.csv")).expect("the table");
    for arguments in [
        "scenario own.toml --seed 3 -o demand.csv --force",
        "compare --network own.toml --policies greedy --days 1 --seed 1 --report demand.csv --force",
    ] {
        assert!(said(at, arguments, 2).contains("V141"), "{arguments}");
    }
    assert!(fs::read(at.join("demand.csv")).expect("the table") == table);
}

#[test]
fn the_error_for_a_file_of_the_other_kind_names_that_kind() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    own_network(at);
    said(at, "scenario own.toml --seed 3 -o day.json", 0);
    for (command, kind) in [
        ("simulate own.toml --policy greedy", "this is a network file (TOML)"),
        ("bound own.toml", "this is a network file (TOML)"),
        ("scenario day.json --seed 1", "this is a scenario file (JSON)"),
        (
            "compare --network day.json --policies greedy --days 1 --seed 1",
            "this is a scenario file (JSON)",
        ),
    ] {
        let said = said(at, command, 2);
        assert!(said.contains("V130") && said.contains(kind), "{command}: {said}");
    }
}

#[test]
fn every_command_that_draws_days_warns_of_a_vertiport_out_of_reach() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let slipped = NEW_YORK.replacen("longitude = -", "longitude = ", 1);
    fs::write(at.join("slipped.toml"), slipped).expect("a free folder");
    for command in [
        "scenario slipped.toml --seed 1 -o day.json",
        "compare --network slipped.toml --policies greedy --days 1 --seed 1",
        "simulate day.json --policy greedy",
    ] {
        let said = said(at, command, 0);
        assert_eq!(said.matches("V135").count(), 1, "{command}: {said}");
        assert!(said.contains("it would be within reach"), "{command}: {said}");
    }
    assert!(!said(at, "scenario new-york --seed 1 -o day.json", 0).contains("V135"));
}
