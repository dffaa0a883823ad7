//! No reader drops an entry of a list: each list of a network or scenario file is refused with an
//! entry more than it may have.

use serde_json::Value as Json;
use toml::Value as Toml;
use vertifleet_core::{Coded, DaySeed, Network, Scenario};

const SHIPPED: [&str; 5] = [
    include_str!("../data/full.toml"),
    include_str!("../../../../networks/paper.toml"),
    include_str!("../../../../networks/disrupted.toml"),
    include_str!("../../../../networks/new-york-quick.toml"),
    include_str!("../../../../networks/san-francisco.toml"),
];
/// Members that no shipped network has, at the beginning of `full.toml`.
const OPTIONAL: &str = r#"start_charge = [0.2, 0.5]
start_stands = [2, 1]
corridors = [{ from = "A", to = "B", both_ways = true, length_mi = 35 }]
closures = [{ start = "00:00:00", end = "07:00:00", vertiports = ["B"], routes = [{ from = "A", to = "B" }] }]
"#;
/// A text, which no list of numbers takes, and which is no id, no time and no object.
const MORE: &str = "one entry more";

/// The paths of all lists below a value, with the number of entries of each.
fn lists(value: &Toml, path: &[String], found: &mut Vec<Vec<String>>) {
    let inside = |name: String| [path, &[name]].concat();
    match value {
        Toml::Table(members) => {
            for (name, member) in members {
                lists(member, &inside(name.clone()), found);
            }
        }
        Toml::Array(entries) => {
            found.push(path.to_vec());
            for (at, entry) in entries.iter().enumerate() {
                lists(entry, &inside(at.to_string()), found);
            }
        }
        _ => {}
    }
}

/// The file with an entry more in the list at a path.
fn with_one_more(file: &Toml, path: &[String]) -> String {
    let mut file = file.clone();
    let mut at = &mut file;
    for name in path {
        at = match at {
            Toml::Array(entries) => &mut entries[name.parse::<usize>().expect("a position")],
            other => other.get_mut(name.as_str()).expect("a member"),
        };
    }
    at.as_array_mut().expect("a list").push(MORE.into());
    toml::to_string(&file).expect("TOML")
}

#[test]
fn no_network_drops_an_entry_of_a_list() {
    let full = format!("{OPTIONAL}{}", SHIPPED[0]);
    let mut tried = Vec::new();
    for text in SHIPPED.into_iter().chain([full.as_str()]) {
        let file: Toml = toml::from_str(text).expect("TOML");
        Network::from_toml(text, "whole").expect("a network");
        let mut found = Vec::new();
        lists(&file, &[], &mut found);
        for path in found {
            let text = with_one_more(&file, &path);
            let error = Network::from_toml(&text, "more").map(|_| ()).expect_err(&path.join("."));
            assert!(error.code().to_string().starts_with("V1"), "{path:?}: {error}");
            tried.push(path.join("."));
        }
    }
    for list in ["start_charge", "aircraft_types.0.charge_curve.1", "closures.0.routes"] {
        assert!(tried.iter().any(|path| path == list), "{list} is not among {tried:?}");
    }
}

#[test]
fn a_list_with_an_entry_too_many_is_named_with_its_place() {
    let quick = SHIPPED[3];
    for (line, other, message) in [
        (
            "start_positions = \"random\"",
            "start_positions = \"random\"\nstart_charge = [0.2, 0.5, 0.8]",
            "start_charge: expected a list of 2 entries, found 3",
        ),
        (
            "[[0, 170], [0.8, 170], [1, 42.5]]",
            "[[0, 170, 1], [0.8, 170], [1, 42.5]]",
            "aircraft_types[0].charge_curve[0]: expected a list of 2 entries, found 3",
        ),
    ] {
        assert!(quick.contains(line), "{line}");
        let error = Network::from_toml(&quick.replacen(line, other, 1), "quick.toml");
        let error = error.expect_err("an entry too many");
        assert_eq!(error.code().to_string(), "V106");
        assert!(error.to_string().ends_with(message), "{error}");
        assert!(error.to_string().starts_with("quick.toml: line "), "{error}");
    }
}

#[test]
fn no_scenario_drops_an_entry_of_a_list() {
    let network = Network::from_toml(SHIPPED[3], "quick.toml").expect("a network");
    let day = network.draw(DaySeed::validation(1).expect("a seed")).to_json();
    let file: Json = serde_json::from_str(&day).expect("JSON");
    let curve = file["aircraft_types"]
        .as_array()
        .expect("types")
        .iter()
        .position(|kind| kind["charge_curve"].is_array())
        .expect("a curve");
    let paths = [
        "/vertiports".to_owned(),
        "/distance_mi/0".to_owned(),
        "/periods".to_owned(),
        "/demand/0/0".to_owned(),
        format!("/aircraft_types/{curve}/charge_curve"),
        format!("/aircraft_types/{curve}/charge_curve/1"),
    ];
    for path in paths {
        let mut file = file.clone();
        let list = file.pointer_mut(&path).and_then(Json::as_array_mut).expect(&path);
        list.push(MORE.into());
        let error = Scenario::from_json(file.to_string().as_bytes(), "more").expect_err(&path);
        assert_eq!(error.code().to_string(), "V106", "{path}: {error}");
    }
}
