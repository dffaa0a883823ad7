//! Boards from the command line, the page of the book that is one, and the page of baselines.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;
use vertifleet_learn::Model;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn vertifleet(folder: &Path, arguments: &str) -> Command {
    let mut command = cargo_bin_cmd!("vertifleet");
    command.current_dir(folder).args(arguments.split(' '));
    command
}

fn stdout(folder: &Path, arguments: &str) -> String {
    let output = vertifleet(folder, arguments).assert().success().get_output().stdout.clone();
    String::from_utf8(output).expect("UTF-8")
}

fn stderr_of_failure(folder: &Path, arguments: &str, code: i32) -> String {
    let output = vertifleet(folder, arguments).assert().code(code).get_output().stderr.clone();
    String::from_utf8(output).expect("UTF-8")
}

/// The names of the files in a folder of which a book needs a copy, with their content.
fn pages(folder: &Path) -> BTreeMap<String, String> {
    let mut pages = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if path.extension().is_some_and(|end| end == "md" || end == "svg") {
            pages.insert(name, fs::read_to_string(path).expect("a text"));
        }
    }
    pages
}

/// `board` verifies every file of `results/` before it prints.
#[test]
fn the_page_of_the_board_is_made_of_the_result_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let report = folder.path().join("report");
    let printed = stdout(&root(), &format!("board results --report {}", report.display()));
    let (made, shown) = (pages(&report), pages(&root().join("docs/src/board")));
    assert_eq!(
        made.keys().collect::<Vec<_>>(),
        shown.keys().collect::<Vec<_>>(),
        "run `make board`"
    );
    for (name, content) in &made {
        assert!(shown[name] == *content, "docs/src/board/{name} is outdated: run `make board`");
    }
    let page = &made["board.md"];
    for entry in fs::read_dir(root().join("results")).expect("a folder") {
        let name = entry.expect("an entry").file_name().to_string_lossy().into_owned();
        assert!(page.contains(&format!("results/{name}")), "{name} has no row");
    }
    // Policies that see the present come first, then those with the forecast, each by share.
    let table: Vec<&str> = printed.lines().take_while(|line| !line.is_empty()).collect();
    assert!(table.len() < 4, "the title stands above the table");
    let rows = printed.lines().skip(2).skip_while(|line| !line.starts_with("---")).skip(1);
    let rows: Vec<&str> = rows.take_while(|line| line.contains(" to ")).collect();
    let sees: Vec<bool> = rows.iter().map(|row| row.contains("  forecast  ")).collect();
    assert!(sees.is_sorted() && sees.contains(&true) && sees.contains(&false), "{printed}");
}

#[test]
fn runs_of_one_method_are_one_row() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let gcaps_x = root().join("models/any/gcaps-x.safetensors");
    let evaluated = format!(
        "evaluate --suite paper-quick-20 --policies greedy,mine-1,random --results out \
         --model mine-1={} --method mine-1=mine --method greedy=mine",
        gcaps_x.display()
    );
    stdout(at, &evaluated);
    let result = fs::read_to_string(at.join("out/paper-quick-20-mine-1.json")).expect("a file");
    let result: Value = serde_json::from_str(&result).expect("JSON");
    assert_eq!(result["run"]["method"], "mine");
    assert_eq!(result["run"]["training_seed"], 1, "the seed of the weights");

    // A rule sees something else than weights with prices, so they are no runs of one method.
    let refused = stderr_of_failure(at, "board out", 2);
    assert!(refused.contains("V416") && refused.contains("sees the"), "{refused}");
    fs::remove_file(at.join("out/paper-quick-20-greedy.json")).expect("a file");
    let board: Value = serde_json::from_str(&stdout(at, "board out --json")).expect("JSON");
    let methods = board["suites"][0]["methods"].as_array().expect("methods");
    let names: Vec<&Value> = methods.iter().map(|method| &method["method"]).collect();
    assert_eq!(names, ["random", "mine"]);
    assert_eq!(methods[1]["bound_share"]["estimate"], methods[1]["runs"][0]["bound_share"]);

    let refused =
        stderr_of_failure(at, "evaluate --policies greedy --results out --method prices=mine", 2);
    assert!(refused.contains("V407") && refused.contains("prices"), "{refused}");
    let twice = "board out/paper-quick-20-mine-1.json out/paper-quick-20-mine-1.json";
    assert!(stderr_of_failure(at, twice, 2).contains("V416"));
    fs::create_dir(at.join("empty")).expect("a folder");
    assert!(stderr_of_failure(at, "board empty", 2).contains("V416"));
}

#[test]
fn a_claim_that_does_not_hold_leaves_no_board() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    stdout(at, "evaluate --suite paper-quick-20 --policies greedy --results out");
    let path = at.join("out/paper-quick-20-greedy.json");
    let text = fs::read_to_string(&path).expect("a file");
    let result: Value = serde_json::from_str(&text).expect("JSON");
    let profit = result["days"][4]["profit_usd"].to_string();
    fs::write(&path, text.replacen(&profit, "50000.0", 1)).expect("a file");
    let refused = stderr_of_failure(at, "board out", 1);
    assert!(refused.contains("V415") && refused.contains("50000"), "{refused}");
}

/// The cells of the rows of the table of baselines.
fn baselines() -> Vec<Vec<String>> {
    let page = fs::read_to_string(root().join("docs/src/reference/baselines.md")).expect("a page");
    let rows = page.lines().filter(|line| line.starts_with("| `") && line.contains("](#"));
    rows.map(|row| row.trim_matches('|').split(" | ").map(|cell| cell.trim().to_owned()).collect())
        .collect()
}

#[test]
fn the_page_of_baselines_lists_every_weight_file_and_curve() {
    let listed: BTreeSet<String> = baselines()
        .iter()
        .flat_map(|row| [&row[4], &row[6]])
        .flat_map(|cell| cell.split(", ").map(|path| path.trim_matches('`').to_owned()))
        .filter(|path| path != "–")
        .collect();
    let mut found = BTreeSet::new();
    let mut folders = vec![PathBuf::from("models"), PathBuf::from("benches/table2")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(root().join(&folder)).expect("a folder") {
            let path = folder.join(entry.expect("an entry").file_name());
            match path.extension().and_then(|end| end.to_str()) {
                _ if root().join(&path).is_dir() => folders.push(path),
                Some("safetensors" | "csv") => {
                    found.insert(path.to_string_lossy().replace('\\', "/"));
                }
                _ => {}
            }
        }
    }
    assert_eq!(listed, found);
}

#[test]
fn the_page_of_baselines_states_what_weights_state() {
    for row in baselines().iter().filter(|row| row[4] != "–") {
        let path = row[4].trim_matches('`');
        let model = Model::read(&root().join(path)).expect("weights");
        let header = model.header();
        let numbers = [&row[1], &row[2]].map(|cell| cell.replace(',', ""));
        let seed = header.seed.expect("a seed").to_string();
        assert_eq!(numbers, [seed, header.steps.to_string()], "{path}");
        assert_eq!(row[0].trim_matches('`'), model.kind(), "{path}");
        assert_eq!(row[3].trim_matches('`'), header.commit, "{path}");
        assert!(model.sha256().starts_with(row[5].trim_matches('`')), "{path}: {}", model.sha256());
    }
}
