//! Scenario files: what is written reads back the same, a write is whole or not at all, warnings
//! are found.

use std::fs;

use vertifleet_core::{
    Code, Coded, DaySeed, Degrees, Network, Scenario, Warning, write_atomically,
};

const SMALL: &str = include_str!("../data/small.json");
const NETWORK: &str = include_str!("../data/small.toml");

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
    day.flight_cost_usd = table(0.0);
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

/// The glider flies the 40 miles from C to A with 16 kWh, and loses 17.5 % of the battery's
/// capacity in 1.75 h of flight.
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

#[test]
fn a_fleet_that_fills_every_stand_is_warned_about() {
    let paper = Network::shipped("paper").expect("a shipped network");
    let with_fleet = |count: usize| {
        let text = paper.toml().replace("count = 40", &format!("count = {count}"));
        let network = Network::from_toml(&text, "paper").expect("as many aircraft as stands");
        let day = network.draw(DaySeed::comparison(1).expect("a seed"));
        assert_eq!(network.warnings(), day.warnings());
        network.warnings()
    };
    assert_eq!(with_fleet(47), []);
    assert_eq!(with_fleet(48), [Warning::NoStandFree { aircraft: 48 }]);
}

#[test]
fn costs_and_places_survive_and_are_not_written_where_there_are_none() {
    let mut day = small().into_day();
    day.flight_cost_usd.cells_mut()[1] = 12.5;
    day.aircraft_cost_usd = 300.0;
    day.vertiports[0].degrees = Some(Degrees { latitude: 40.7, longitude: -74.0 });
    let scenario = day.check("day").expect("a valid day");
    let text = scenario.to_json();
    for member in
        ["\"flight_cost\": [", "\"aircraft_cost\": 300", "\"latitude\": 40.7, \"longitude\": -74}"]
    {
        assert!(text.contains(member), "{member}: {text}");
    }
    assert_eq!(Scenario::from_json(text.as_bytes(), "day").expect("valid text"), scenario);
    for member in ["flight_cost", "aircraft_cost", "latitude"] {
        assert!(!small().to_json().contains(member), "{member}");
    }
}

/// Notepad, PowerShell and Excel begin UTF-8 with a mark, and end lines with CR LF.
#[test]
fn files_from_windows_are_read() {
    let windows = |text: &str| format!("\u{feff}{}", text.replace('\n', "\r\n"));
    let twice = format!("\u{feff}{}", windows(SMALL));
    for text in [windows(SMALL), twice] {
        assert_eq!(Scenario::from_json(text.as_bytes(), "day").expect("a scenario"), small());
    }
    let seed = DaySeed::comparison(1).expect("a small seed");
    let network = Network::from_toml(&windows(NETWORK), "net").expect("a network");
    let plain = Network::from_toml(NETWORK, "net").expect("a network");
    assert_eq!(network.draw(seed), plain.draw(seed));
    let again = Network::from_toml(network.toml(), "net").expect("its own text");
    assert_eq!(again.toml(), network.toml());
}

/// Many programs write null for a member that has no value.
#[test]
fn null_is_the_same_as_an_optional_member_that_is_left_out() {
    let mut file: serde_json::Value = serde_json::from_str(SMALL).expect("JSON");
    let null = |part: &mut serde_json::Value, members: &[&str]| {
        for &member in members {
            assert!(part.get(member).is_none(), "{member}");
            part[member] = serde_json::Value::Null;
        }
    };
    null(&mut file["operations"], &["passenger_wait_s", "charging"]);
    let of_vertiport =
        ["chargers", "charger_kw", "latitude", "longitude", "stand_cost", "charger_cost"];
    null(&mut file["vertiports"][0], &of_vertiport);
    null(&mut file["aircraft_types"][0], &["reserve_kwh", "turnaround_s", "charge_curve"]);
    null(&mut file["aircraft"][0], &["start_charge_kwh"]);
    let of_day = ["flight_cost", "aircraft_cost", "forecast", "takeoff_delays", "outages"];
    null(&mut file, &of_day);
    let mut with_routes = file.clone();
    null(&mut file, &["corridors", "closures"]);
    let read = |file: &serde_json::Value| Scenario::from_json(file.to_string().as_bytes(), "day");
    assert_eq!(read(&file).expect("a scenario"), small());

    let route = |rest: &str| format!(r#"{{"from": "A", "to": "B"{rest}}}"#);
    let closed = r#", "both_ways": null, "known": null, "start": "07:00:00", "end": "08:00:00""#;
    let json = |text: String| serde_json::from_str::<serde_json::Value>(&text).expect("JSON");
    with_routes["closures"] = json(format!("[{}]", route(closed)));
    with_routes["corridors"] = json(format!(
        r#"[{}, {{"from": "A", "to": "C", "both_ways": true}}]"#,
        route(r#", "both_ways": null"#)
    ));
    let day = read(&with_routes).expect("a scenario");
    assert!(!day.disturbances.closures[0].route.both_ways && !day.disturbances.closures[0].known);

    let mut required = file.clone();
    required["operations"]["hold_s"] = serde_json::Value::Null;
    let refused = read(&required).expect_err("a required member").to_string();
    assert!(refused.contains("operations.hold_s: invalid type: null"), "{refused}");
    file["unknown"] = serde_json::Value::Null;
    let refused = read(&file).expect_err("an unknown member").to_string();
    assert!(refused.contains("unknown field `unknown`"), "{refused}");
}

#[test]
fn an_hour_of_one_digit_is_read_and_written_with_two() {
    let text = SMALL.replace("\"06:00:00\"", "\"6:00:00\"");
    assert_eq!(Scenario::from_json(text.as_bytes(), "day").expect("a scenario").to_json(), SMALL);
}

/// The small network with vertiports at these latitudes and longitudes.
fn at(places: [(f64, f64); 3]) -> Network {
    let begin = NETWORK.find("[[vertiports]]").expect("vertiports");
    let end = NETWORK.find("[[aircraft_types]]").expect("what follows them");
    let vertiport = |(at, (latitude, longitude)): (usize, &(f64, f64))| {
        format!(
            "[[vertiports]]\nid = \"V{at}\"\nlatitude = {latitude}\nlongitude = {longitude}\nstands = 2\nbusy = true\n\n"
        )
    };
    let places: String = places.iter().enumerate().map(vertiport).collect();
    let text = format!("{}{places}{}", &NETWORK[..begin], &NETWORK[end..]);
    Network::from_toml(&text, "net.toml").expect("a valid network")
}

#[test]
fn a_vertiport_out_of_reach_is_named_with_the_likely_cause() {
    let near = [(40.7, -74.0), (40.6, -73.8)];
    let warnings = |place| -> Vec<String> {
        let network = at([near[0], near[1], place]);
        network.warnings().iter().map(|warning| format!("{} {warning}", warning.code())).collect()
    };
    assert_eq!(warnings((40.9, -74.1)), Vec::<String>::new());
    insta::assert_snapshot!(warnings((40.9, 74.1)).join("\n"));
    assert!(warnings((-40.9, -74.1))[0].contains("at latitude 40.9 and longitude -74.1 it would"));
    assert!(warnings((-74.1, 40.9))[0].contains("at latitude 40.9 and longitude -74.1 it would"));
    insta::assert_snapshot!(warnings((44.9, -74.1)).join("\n"));
    let network = at([near[0], near[1], (40.9, 74.1)]);
    let day = network.draw(DaySeed::comparison(1).expect("a small seed"));
    assert_eq!(day.warnings()[0], network.warnings()[0], "a day of it has the same warning");
}

#[test]
fn a_vertiport_without_a_corridor_is_named() {
    let text = NETWORK.replacen(
        "[[vertiports]]",
        "[[corridors]]\nfrom = \"A\"\nto = \"B\"\n\n[[vertiports]]",
        1,
    );
    let third = "[[vertiports]]\nid = \"C\"\nx_mi = 10\ny_mi = 0\nstands = 1\nbusy = false\n\n[[aircraft_types]]";
    let text = text.replacen("[[aircraft_types]]", third, 1);
    let network = Network::from_toml(&text, "net.toml").expect("a valid network");
    let warnings: Vec<String> = network.warnings().iter().map(ToString::to_string).collect();
    insta::assert_snapshot!(warnings.join("\n"));
}

#[cfg(unix)]
#[test]
fn a_network_in_a_pipe_is_checked_with_one_reading() {
    use std::io::Write;
    use std::os::fd::AsRawFd;
    for (text, findings) in
        [(NETWORK.to_owned(), 0), (NETWORK.replace("stands = 2", "stands = 0"), 1)]
    {
        let (reader, mut writer) = std::io::pipe().expect("a pipe");
        writer.write_all(text.as_bytes()).expect("less than a pipe holds");
        drop(writer);
        let path = format!("/dev/fd/{}", reader.as_raw_fd());
        let found = Network::read_or_findings(path).expect("the pipe is read");
        assert_eq!(found.err().map_or(0, |findings| findings.len()), findings);
    }
}
