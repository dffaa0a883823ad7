//! Runs the commands of the guide "Plan a city in an hour", on fewer days and designs than there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use assert_cmd::cargo::cargo_bin;

/// Smaller arguments than those of the guide, to save time. The test checks that the commands
/// succeed, not the guide's figures.
const SMALLER: [(&str, &str); 3] =
    [("--days 5", "--days 2"), ("--days 3", "--days 2"), ("--designs 16", "--designs 3")];

fn guide() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src/guide")
}

#[test]
fn every_command_of_the_guide_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    for table in ["vertiports.csv", "demand.csv"] {
        fs::copy(guide().join("bay").join(table), folder.path().join(table)).expect("it is there");
    }
    let page = fs::read_to_string(guide().join("plan-a-city.md")).expect("it is there");
    let commands: Vec<&str> = page.lines().filter_map(|line| line.strip_prefix("    ")).collect();
    assert!(
        commands.len() > 12,
        "the guide still writes its commands in a way that this test finds"
    );
    for (of_the_guide, _) in SMALLER {
        assert!(page.contains(of_the_guide), "the guide no longer has {of_the_guide}");
    }
    let programs = cargo_bin!("vertifleet").parent().expect("a folder").to_owned();
    let path = std::env::var("PATH").expect("a path");
    for command in commands {
        let command =
            SMALLER.iter().fold(command.to_owned(), |command, (of_the_guide, smaller)| {
                command.replace(of_the_guide, smaller)
            });
        let output = Command::new("sh")
            .args(["-c", &command])
            .current_dir(folder.path())
            .env("PATH", format!("{}:{path}", programs.display()))
            .output()
            .expect("a shell");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{command}: {said}");
    }
    for file in [
        "bay.png",
        "day.html",
        "day.svg",
        "fleet/report.html",
        "best/best.toml",
        "fare/figure-response-curves.svg",
        "stands/cells.csv",
        "chargers/cells.csv",
        "flights.geojson",
        "feed.zip",
        "flights.parquet",
    ] {
        assert!(folder.path().join(file).exists(), "{file}");
    }
}
