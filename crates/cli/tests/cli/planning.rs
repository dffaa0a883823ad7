//! A planner's work with the program: make a network from their data, inspect it, price a change,
//! and export a day.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

fn vertifleet(folder: &Path, arguments: &[&str]) -> std::process::Output {
    let mut command = Command::cargo_bin("vertifleet").expect("the program");
    command.current_dir(folder).args(arguments).output().expect("it runs")
}

/// The output of a command that has to succeed.
fn stdout(folder: &Path, arguments: &[&str]) -> String {
    let output = vertifleet(folder, arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    String::from_utf8(output.stdout).expect("text")
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    serde_json::from_str(&stdout(folder, arguments)).expect("JSON")
}

const VERTIPORTS: &str = "id,latitude,longitude,stands\n\
                          SFO,37.61882,-122.37580,5\n\
                          OAK,37.72125,-122.22115,4\n\
                          SJC,37.36390,-121.92894,4\n";

const DEMAND: &str = "period,from,to,passengers\n\
                      6,SFO,OAK,12\n7,SFO,OAK,20\n7,OAK,SFO,18\n8,SJC,SFO,9.5\n17,SFO,SJC,22\n";

/// The command that makes a network of the tables.
const IMPORT: [&str; 12] = [
    "network",
    "import",
    "--vertiports",
    "vertiports.csv",
    "--demand",
    "demand.csv",
    "--base",
    "base.toml",
    "--name",
    "bay",
    "--output",
    "bay.toml",
];

/// A folder with a network that was made of tables.
fn imported() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("vertiports.csv"), VERTIPORTS).expect("room");
    fs::write(folder.path().join("demand.csv"), DEMAND).expect("room");
    fs::write(folder.path().join("base.toml"), small_base()).expect("room");
    stdout(folder.path(), &IMPORT);
    folder
}

/// `new-york` with a fleet that fits into the small network.
fn small_base() -> String {
    let text = include_str!("../../../../networks/new-york.toml");
    text.replace("count = 16", "count = 4")
}

#[test]
fn tables_become_a_network_that_can_be_played() {
    let folder = imported();
    let here = folder.path();
    let overview = json(here, &["network", "show", "bay.toml", "--json"]);
    assert_eq!(overview["passengers_a_day"], 81.5);
    assert_eq!(overview["size"]["stands"], 13);
    let played = json(
        here,
        &[
            "compare",
            "--network",
            "bay.toml",
            "--policies",
            "greedy",
            "--days",
            "2",
            "--seed",
            "1",
            "--json",
        ],
    );
    assert!(played["policies"][0]["passengers"].as_f64().expect("a number") > 10.0);
    let again = vertifleet(here, &IMPORT);
    assert_eq!(again.status.code(), Some(2), "a file that may have been edited is not replaced");
    assert!(String::from_utf8_lossy(&again.stderr).contains("V143"));
}

#[test]
fn trips_become_demand_with_an_account_of_every_row() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    fs::write(here.join("vertiports.csv"), VERTIPORTS).expect("room");
    fs::write(here.join("base.toml"), small_base()).expect("room");
    let head = "pickup_datetime,passenger_count,pickup_longitude,pickup_latitude,dropoff_longitude,dropoff_latitude\n";
    let near = "2015-06-01 07:30:00,2,-122.376,37.619,-122.221,37.721\n";
    let far = "2015-06-01 07:40:00,1,-121.0,37.0,-122.221,37.721\n";
    fs::write(here.join("trips.csv"), [head, near, near, far, "no time,1,0,0,0,0\n"].concat())
        .expect("room");
    let account = json(
        here,
        &[
            "network",
            "import",
            "--vertiports",
            "vertiports.csv",
            "--trips",
            "trips.csv",
            "--mode-share",
            "0.5",
            "--weekdays",
            "Mon,Tue",
            "--base",
            "base.toml",
            "--name",
            "bay",
            "--output",
            "bay.toml",
            "--json",
        ],
    );
    let trips = &account["trips"];
    assert_eq!((&trips["rows"], &trips["kept"], &trips["days"]), (&4.into(), &2.into(), &1.into()));
    assert_eq!((&trips["far_pickup"], &trips["no_time"]), (&1.into(), &1.into()));
    let overview = json(here, &["network", "show", "bay.toml", "--json"]);
    assert_eq!(overview["passengers_a_day"], 2.0, "two rows of two passengers, half of whom fly");
    assert_eq!(account["inherited"]["from"], "new-york");
}

#[test]
fn a_dry_run_shows_the_first_row_of_each_reason_and_writes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    fs::write(here.join("vertiports.csv"), VERTIPORTS).expect("room");
    fs::write(here.join("base.toml"), small_base()).expect("room");
    let head =
        "pickup_datetime,pickup_longitude,pickup_latitude,dropoff_longitude,dropoff_latitude\n";
    let near = "01/06/2015 07:30,-122.376,37.619,-122.221,37.721\n";
    fs::write(here.join("trips.csv"), [head, near, "2015-06-01 07:30,0,0,0,0\n"].concat())
        .expect("room");
    let files = fs::read_dir(here).expect("a folder").count();
    let dry =
        [&IMPORT[..4], &["--trips", "trips.csv"], &IMPORT[6..IMPORT.len() - 2], &["--dry-run"]];
    let said = stdout(here, &[&dry.concat()[..], &["--time-format", "%d/%m/%Y %H:%M"]].concat());
    assert_eq!(
        said,
        "of 2 rows, 1 were kept, 1 had no readable time of pick-up (first in trips.csv, line 3)\n\
         1 had no readable time of pick-up\n  first: trips.csv, line 3: 2015-06-01 07:30,0,0,0,0\n"
    );
    assert_eq!(fs::read_dir(here).expect("a folder").count(), files);
}

#[test]
fn columns_of_bicycle_trips_are_recognised_and_others_can_be_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    fs::write(here.join("vertiports.csv"), VERTIPORTS).expect("room");
    fs::write(here.join("base.toml"), small_base()).expect("room");
    let of_bicycles = "ride_id,started_at,ended_at,start_lat,start_lng,end_lat,end_lng\n";
    let ride =
        "7,2015-06-01 07:30:00.123,2015-06-01 08:00:00.456,37.619,-122.376,37.721,-122.221\n";
    fs::write(here.join("rides.csv"), [of_bicycles, ride].concat()).expect("room");
    let of_their_own = "id,began,until,a,b,c,d\n";
    fs::write(here.join("own.csv"), [of_their_own, ride].concat()).expect("room");
    let import = |file, more: &[&'static str]| {
        let trips = [&IMPORT[..4], &["--trips", file, "--json"], &IMPORT[6..]].concat();
        [&trips[..], more, &["--force"]].concat()
    };
    let rides = json(here, &import("rides.csv", &[]));
    assert_eq!(rides["trips"]["kept"], 1);
    let said = refused(here, &import("own.csv", &[]));
    assert!(said.contains("V702") && said.contains("--trip-columns"), "{said}");
    let columns = "pickup_time=began,pickup_latitude=a,pickup_longitude=b,dropoff_latitude=c";
    let named = ["--trip-columns", columns, "--trip-columns", "dropoff_longitude=d"];
    let own = json(here, &import("own.csv", &named));
    assert_eq!(own["trips"]["kept"], 1);
    let said = refused(here, &import("own.csv", &["--trip-columns", "start=began"]));
    assert!(said.contains("pickup_time") && said.contains("dropoff_zone"), "{said}");
    let twice = ["--trip-columns", "passengers=a,passengers=b"];
    assert!(refused(here, &import("own.csv", &twice)).contains("two columns for passengers"));
}

#[test]
fn a_fleet_without_room_is_refused_with_the_flag_that_makes_it_smaller() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    fs::write(here.join("vertiports.csv"), VERTIPORTS).expect("room");
    fs::write(here.join("demand.csv"), DEMAND).expect("room");
    let of_new_york = [&IMPORT[..6], &IMPORT[8..]].concat();
    let said = refused(here, &of_new_york);
    assert!(said.contains("V117") && said.contains("--aircraft"), "{said}");
    let fewer = ["--aircraft", "9", "--time-zone", "America/Los_Angeles"];
    stdout(here, &[&of_new_york[..], &fewer].concat());
    let overview = json(here, &["network", "show", "bay.toml", "--json"]);
    assert_eq!(overview["size"]["aircraft"], 9);
    let wrong = ["--aircraft", "9", "--time-zone", "Pacific Time", "--force"];
    assert!(refused(here, &[&of_new_york[..], &wrong].concat()).contains("time_zone must be"));
}

/// The message of a command that must be refused.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = vertifleet(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    String::from_utf8(output.stderr).expect("text")
}

#[test]
fn flags_of_trip_records_are_refused_without_trip_records() {
    let folder = tempfile::tempdir().expect("a folder");
    for (flag, value) in [
        ("--trip-columns", "passengers=riders"),
        ("--zones", "zones.csv"),
        ("--radius", "2"),
        ("--mode-share", "0.1"),
        ("--decay", "1"),
        ("--weekdays", "Mon"),
        ("--first-date", "2015-06-01"),
        ("--last-date", "2015-06-01"),
        ("--time-format", "epoch-s"),
    ] {
        let said = refused(folder.path(), &[&IMPORT[..], &[flag, value]].concat());
        assert!(said.contains(flag) && said.contains("--trips is not given"), "{said}");
    }
    let neither = [&IMPORT[..4], &IMPORT[6..]].concat();
    let said = refused(folder.path(), &neither);
    assert!(said.contains("--demand <FILE>|--trips <FILE>"), "{said}");
    let both = [&IMPORT[..], &["--trips", "trips.csv"]].concat();
    assert!(refused(folder.path(), &both).contains("cannot be used with"));
}

#[test]
fn check_reports_all_findings_at_once() {
    let folder = imported();
    let here = folder.path();
    let good = stdout(here, &["network", "check", "bay.toml"]);
    assert!(good.contains("bay can be used"), "{good}");
    let text = fs::read_to_string(here.join("bay.toml")).expect("it is there");
    let bad = text
        .replacen("seats = 4", "seats = 0", 1)
        .replacen("takeoff_s = 300", "takeoff_s = -1", 1)
        .replacen("name = \"bay\"", "name = \"my bay\"", 1)
        .replacen("fare_usd_per_mi = 5", "fare_usd_per_mi = 1e9", 1);
    fs::write(here.join("bad.toml"), bad).expect("room");
    let output = vertifleet(here, &["network", "check", "bad.toml", "--json"]);
    assert_eq!(output.status.code(), Some(2));
    let findings: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let messages: Vec<&str> = findings
        .as_array()
        .expect("a list")
        .iter()
        .map(|finding| finding["message"].as_str().expect("a text"))
        .collect();
    for part in ["seats must be", "takeoff_s must be", "name must be", "fare_usd_per_mi must be"] {
        let found = messages.iter().filter(|message| message.contains(part)).count();
        assert_eq!(found, 1, "{part}: {messages:?}");
    }
}

#[test]
fn differences_are_paths_that_a_sweep_takes() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    let paper = include_str!("../../../../networks/paper.toml");
    let mine = paper.replacen("stands = 6", "stands = 8", 1).replace("count = 40", "count = 44");
    fs::write(here.join("mine.toml"), mine).expect("room");
    let differences = stdout(here, &["network", "diff", "paper", "mine.toml"]);
    assert_eq!(differences, "fleet.cityairbus.count: 40 -> 44\nvertiports.V1.stands: 6 -> 8\n");
    assert_eq!(stdout(here, &["network", "diff", "paper", "paper"]), "no difference\n");
    let sweep = json(
        here,
        &[
            "sweep",
            "paper",
            "--vary",
            "vertiports.V1.stands=6,8",
            "--vary",
            "fleet.cityairbus.count=40,44",
            "--policies",
            "greedy",
            "--days",
            "1",
            "--out",
            "sweep",
            "--json",
        ],
    );
    assert_eq!(sweep["cells"].as_array().expect("a list").len(), 4);
}

#[test]
fn a_new_network_marks_assumptions_and_can_be_used_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    let flags = [
        "network",
        "new",
        "--name",
        "bay",
        "--vertiport",
        "SFO,37.61882,-122.3758,5",
        "--vertiport",
        "OAK,37.72125,-122.22115",
        "--aircraft",
        "4",
        "--passengers",
        "600",
        "--fare",
        "5",
    ];
    stdout(here, &[&flags[..], &["--output", "bay.toml"]].concat());
    let text = fs::read_to_string(here.join("bay.toml")).expect("it is there");
    assert!(text.contains("# assumption") && text.contains("id = \"OAK\""), "{text}");
    assert!(stdout(here, &["network", "check", "bay.toml"]).contains("can be used"));
    let not_asked = vertifleet(here, &[&flags[..8], &["--output", "other.toml"]].concat());
    assert_eq!(not_asked.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&not_asked.stderr).contains("--aircraft is not given"));
    assert!(!here.join("other.toml").exists());
}

#[test]
fn a_network_and_a_day_have_pictures() {
    let folder = imported();
    let here = folder.path();
    stdout(here, &["network", "show", "bay.toml", "--picture", "bay.svg"]);
    stdout(here, &["network", "show", "bay.toml", "--picture", "bay.png"]);
    let svg = fs::read_to_string(here.join("bay.svg")).expect("it is there");
    assert!(svg.contains("SFO") && svg.contains("OAK"));
    assert!(fs::read(here.join("bay.png")).expect("it is there").starts_with(b"\x89PNG"));
    let other = vertifleet(here, &["network", "show", "bay.toml", "--picture", "bay.gif"]);
    assert_eq!(other.status.code(), Some(2));
}

#[test]
fn a_day_is_exported_in_every_format() {
    let folder = imported();
    let here = folder.path();
    stdout(here, &["scenario", "bay.toml", "--seed", "1", "--output", "day.json"]);
    stdout(here, &["simulate", "day.json", "--policy", "greedy", "--trace", "trace.csv"]);
    let dated = ["--date", "2026-11-24", "--time-zone", "America/Los_Angeles"];
    for (format, file, opening) in [
        ("csv", "day.csv", "aircraft,type,kind,"),
        ("parquet", "day.parquet", "PAR1"),
        ("geojson", "day.geojson", "{\"type\":\"FeatureCollection\""),
        ("gtfs", "day.zip", "PK"),
        ("svg", "day.svg", "<svg"),
        ("png", "day.png", "PNG"),
    ] {
        let arguments = ["export", "day.json", "trace.csv", "--as", format, "--output", file];
        // Twice, since files that this program wrote may be replaced.
        for _ in 0..2 {
            stdout(here, &[&arguments[..], &dated].concat());
        }
        let content = fs::read(here.join(file)).expect("it is there");
        let begin = usize::from(format == "png");
        assert!(content[begin..].starts_with(opening.as_bytes()), "{format}");
    }
    let arguments =
        ["export", "day.json", "trace.csv", "--as", "icalendar", "--output", "calendars"];
    stdout(here, &[&arguments[..], &dated].concat());
    assert_eq!(fs::read_dir(here.join("calendars")).expect("a folder").count(), 3);
    let undated = vertifleet(here, &arguments);
    assert_eq!(undated.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&undated.stderr).contains("--date"));
    let onto_input = ["export", "day.json", "trace.csv", "--as", "csv", "--output", "trace.csv"];
    let refused = vertifleet(here, &onto_input);
    assert!(String::from_utf8_lossy(&refused.stderr).contains("V141"), "the trace is read");
}
