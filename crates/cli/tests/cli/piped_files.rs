//! Every command takes a pipe for a file: `/dev/stdin`, `<(...)` and named pipes are read once.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use crate::common::{folder, run, small_network};

/// Runs a line of bash, in which `vertifleet` is the program; it must end.
fn bash(folder: &Path, line: &str) -> Output {
    let line = line.replace("vertifleet", env!("CARGO_BIN_EXE_vertifleet"));
    let mut command = Command::new("bash");
    let mut shell = command.current_dir(folder).args(["-c", &line]);
    shell = shell.env("XDG_CACHE_HOME", folder.join("kept"));
    let mut child = shell.stdout(std::process::Stdio::piped()).spawn().expect("bash runs");
    let begun = Instant::now();
    while child.try_wait().expect("a child").is_none() {
        if begun.elapsed() > Duration::from_mins(2) {
            child.kill().expect("it is running");
            panic!("{line} waits for ever");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    child.wait_with_output().expect("it has ended")
}

const VERTIPORTS: &str = "id,latitude,longitude,stands
JRB,40.70112,-74.00880,30
JFK,40.63993,-73.77869,20
";
const TRIPS: &str =
    "pickup_datetime,pickup_latitude,pickup_longitude,dropoff_latitude,dropoff_longitude
2026-06-01 07:30:00,40.7011,-74.0088,40.6399,-73.7787
2026-06-01 08:30:00,40.7011,-74.0088,40.6399,-73.7787
";

#[test]
fn a_file_in_a_pipe_gives_what_the_file_gives() {
    let folder = folder();
    let at = folder.path();
    small_network(at);
    run(at, "scenario small.toml --seed 1 -o day.json");
    run(at, "simulate day.json --policy greedy --trace trace.csv");
    fs::write(at.join("vertiports"), VERTIPORTS).expect("a file");
    fs::write(at.join("trips"), TRIPS).expect("a file");
    fs::write(at.join("demand"), "from,to,06:00,07:00\nJRB,JFK,14,9\n").expect("a file");
    let import = "vertifleet network import --vertiports @vertiports --name a --dry-run --json";
    for line in [
        "vertifleet network check @small.toml",
        "vertifleet network show @small.toml --json",
        "vertifleet network diff @small.toml paper --json",
        "vertifleet scenario @small.toml --seed 1 -o again.json --force && cat again.json",
        "vertifleet simulate @day.json --policy greedy --json",
        "vertifleet check @day.json @trace.csv --json",
        "vertifleet export @day.json @trace.csv --as csv -o flights.csv --force && cat flights.csv",
        &format!("{import} --trips @trips"),
        &format!("{import} --demand @demand"),
    ] {
        let plain = bash(at, &line.replace('@', ""));
        assert!(plain.status.success() && !plain.stdout.is_empty(), "{line}");
        let words = line.split(' ').map(|word| match word.strip_prefix('@') {
            Some(file) => format!("<(cat {file})"),
            None => word.to_owned(),
        });
        let piped = bash(at, &words.collect::<Vec<_>>().join(" "));
        // Messages name the file, and these have its name and the descriptor of the pipe.
        let text = |output: &Output| String::from_utf8_lossy(&output.stdout).into_owned();
        let nameless = |text: String| {
            let is_name = |line: &&str| !line.contains("/dev/fd/") && !line.contains("small.toml");
            let lines: Vec<&str> = text.lines().filter(is_name).collect();
            lines.join("\n").replace("\"trips\"", "F").replace("\"63\"", "F").replace("\"62\"", "F")
        };
        assert!(piped.status.success(), "{line}");
        assert_eq!(nameless(text(&piped)), nameless(text(&plain)), "{line}");
    }
}

#[test]
fn stdin_and_named_pipes_end() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("vertiports"), VERTIPORTS).expect("a file");
    fs::write(at.join("trips"), TRIPS).expect("a file");
    let import = "vertifleet network import --vertiports vertiports --name a --dry-run";
    for line in [
        format!("cat trips | {import} --trips /dev/stdin"),
        format!("mkfifo pipe; cat trips > pipe & {import} --trips pipe"),
        format!("gzip -c trips | {import} --trips /dev/stdin"),
    ] {
        let output = bash(at, &line);
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success() && text.contains('2'), "{line}: {text}");
    }
}
