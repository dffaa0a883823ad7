//! Evaluations from the command line: results are written and verified, and the book shows the
//! program's output.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;

fn vertifleet(folder: &Path, arguments: &str) -> Command {
    let mut command = cargo_bin_cmd!("vertifleet");
    command.current_dir(folder).args(arguments.split(' '));
    command
}

fn stdout(folder: &Path, arguments: &str) -> String {
    let output = vertifleet(folder, arguments).assert().success().get_output().stdout.clone();
    String::from_utf8(output).expect("UTF-8")
}

#[test]
fn results_are_written_and_verified() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let printed =
        stdout(at, "evaluate --policies greedy,random --results out --about training=none --json");
    let report: Value = serde_json::from_str(&printed).expect("JSON");
    assert_eq!(report["format"], "vertifleet-evaluation/1");
    let (greedy, random) =
        (&report["suites"][0]["policies"][0], &report["suites"][0]["policies"][1]);
    assert!(greedy["minus_first"].is_null() && random["p_value_holm"].as_f64() < Some(0.001));

    let path = at.join("out/paper-100-greedy.json");
    let result: Value = serde_json::from_slice(&fs::read(&path).expect("a file")).expect("JSON");
    assert_eq!(result["about"]["training"], "none");
    assert_eq!(result["bound_share"], greedy["bound_share"]);
    let verified =
        stdout(at, "evaluate --verify out/paper-100-greedy.json out/paper-100-random.json");
    assert_eq!(verified.lines().filter(|line| line.starts_with("verified: ")).count(), 2);

    // A result may be written again, and a file of another kind is kept.
    stdout(at, "evaluate --policies greedy --results out");
    fs::write(at.join("out/paper-100-random.json"), "notes").expect("a file");
    let refused = vertifleet(at, "evaluate --policies random --results out").assert().code(2);
    assert!(String::from_utf8_lossy(&refused.get_output().stderr).contains("V143"));

    let text = fs::read_to_string(&path).expect("a file");
    let first = result["days"][0]["choices"].as_str().expect("choices");
    fs::write(&path, text.replacen(first, &first[2..], 1)).expect("a file");
    let found = vertifleet(at, "evaluate --verify out/paper-100-greedy.json").assert().code(1);
    assert!(
        String::from_utf8_lossy(&found.get_output().stdout).starts_with("not verified: greedy")
    );
}

/// The cheapest row of the book's table; the others come from the same command.
#[test]
fn the_protocol_shows_the_output_of_the_program() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = fs::read_to_string(root.join("docs/src/reference/protocol.md")).expect("a page");
    let cells = |start: &str| -> Vec<&str> {
        let row = page.lines().find(|line| line.starts_with(start)).expect("a row");
        row.split('|').map(str::trim).collect()
    };
    let (names, row) = (cells("| policy |"), cells("| `greedy` |"));
    let suites = ["paper-100", "paper-quick-20", "random-places-100"];
    let printed =
        stdout(&root, &format!("evaluate --policies greedy --suite {}", suites.join(",")));
    let shares = printed.lines().rfind(|line| line.starts_with("greedy ")).expect("a row");
    let mut shares = shares.split("  ").map(str::trim).filter(|cell| cell.contains('±'));
    for suite in suites {
        let column = names.iter().position(|name| *name == format!("`{suite}`"));
        assert_eq!(Some(row[column.expect("a column")]), shares.next(), "{suite}");
    }
}
