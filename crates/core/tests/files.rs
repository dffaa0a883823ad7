//! Scenario files: what is written reads back the same, a write is whole or not at all, warnings are found.

use std::fs;

use vertifleet_core::{Code, DaySeed, Network, Scenario, Warning, write_atomically};

const SMALL: &str = include_str!("data/small.json");

fn small() -> Scenario {
    Scenario::from_json(SMALL.as_bytes(), "small.json").expect("the good scenario")
}

#[test]
fn a_scenario_is_written_the_way_people_write_it() {
    assert_eq!(small().to_json(), SMALL);
}

#[test]
fn a_written_scenario_reads_back_the_same_to_the_last_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("day.json");
    let network = Network::shipped("paper").expect("shipped");
    for seed in 0..20 {
        let scenario = network.draw(DaySeed::comparison(seed).expect("a small seed"));
        scenario.write(&path).expect("a free folder");
        let again = Scenario::read(&path).expect("a valid file");
        assert_eq!(again, scenario);
        assert_eq!(again.to_json(), scenario.to_json());
    }
    let left = fs::read_dir(folder.path()).expect("the folder").count();
    assert_eq!(left, 1, "a write leaves nothing but the file");
}

#[test]
fn names_in_any_script_and_with_quotes_survive() {
    let mut day = small().into_day();
    day.name = "день \"1\" \\ 🚁".to_owned();
    day.vertiports[0].id = "Zürich \u{2028} HB".to_owned();
    let scenario = day.check("day").expect("allowed names");
    let again = Scenario::from_json(scenario.to_json().as_bytes(), "day").expect("valid text");
    assert_eq!(again, scenario);
}

#[test]
fn the_smallest_network_of_one_vertiport_is_a_scenario() {
    let mut day = small().into_day();
    day.vertiports.truncate(1);
    day.aircraft.truncate(1);
    let table = |cell| vertifleet_core::Matrix::from_fn(1, |_, _| cell);
    day.distance_mi = table(0.0);
    day.fare_usd = table(0.0).into();
    day.passenger_cost_usd = table(0.0);
    day.demand = vec![vertifleet_core::Matrix::from_fn(1, |_, _| 0); 2];
    let scenario = day.check("day").expect("one vertiport is enough");
    assert_eq!(scenario.warnings().len(), 1, "there is nowhere to fly");
    let again = Scenario::from_json(scenario.to_json().as_bytes(), "day").expect("valid text");
    assert_eq!(again, scenario);
}

#[test]
fn a_failed_write_leaves_what_was_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("taken");
    fs::create_dir(&path).expect("a folder inside");
    let error = write_atomically(&path, b"text").expect_err("a folder is in the way");
    assert_eq!(error.code(), Code(102));
    assert!(path.is_dir());
}

#[cfg(unix)]
#[test]
fn a_write_follows_links_and_keeps_permissions() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = tempfile::tempdir().expect("a folder");
    let (file, link) = (folder.path().join("file"), folder.path().join("link"));
    fs::write(&file, "before").expect("a free folder");
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).expect("our own file");
    symlink(&file, &link).expect("a free name");
    write_atomically(&link, b"after").expect("a free folder");
    assert_eq!(fs::read_to_string(&file).expect("the file"), "after");
    assert!(link.is_symlink());
    let mode = fs::metadata(&file).expect("the file").permissions().mode();
    assert_eq!(mode & 0o777, 0o640);
}

/// From C the glider reaches A, 40 miles: 16 kWh, and 1.75 h of flight lose 17.5 % of the battery's capacity.
#[test]
fn an_aircraft_that_reaches_no_other_vertiport_is_warned_about() {
    let with_battery = |kwh| {
        let mut day = small().into_day();
        day.aircraft_types[1].battery_kwh = kwh;
        day.check("day").expect("a valid day").warnings()
    };
    assert_eq!(with_battery(16.0 / 0.825 + 0.01), []);
    let (aircraft, kind, at) = ("A03".to_owned(), "glider".to_owned(), "C".to_owned());
    let warning = Warning::NoDestination { aircraft, kind, at };
    assert_eq!(
        warning.to_string(),
        r#"aircraft "A03" of type "glider" reaches no other vertiport from "C": it stands there all day"#
    );
    assert_eq!(with_battery(16.0 / 0.825 - 0.01), [warning]);
}
