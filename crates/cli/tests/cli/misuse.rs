//! Tests of about a hundred and fifty wrong commands. Each command must state the mistake, end with
//! exit code 2 (1 if the arguments were right), leave every file unchanged, and create none.

use crate::misuses;
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;

use crate::common::{folder, run, shipped, small_network, vertifleet};
use crate::contents::contents;
use crate::misuses::Misuse;

/// A folder with files of every kind, valid and invalid.
fn prepared() -> tempfile::TempDir {
    let folder = folder();
    let at = folder.path();
    let file = |name: &str, text: &[u8]| fs::write(at.join(name), text).expect("a file");
    small_network(at);
    run(at, "scenario small.toml --seed 1 -o day.json");
    run(at, "scenario small.toml --seed 2 -o other.json");
    run(at, "simulate day.json --policy greedy --trace trace.csv");
    run(at, "simulate other.json --policy greedy --trace other.csv");
    let report = "compare --network small.toml --policies greedy --days 2 --seed 1 --report report";
    run(at, report);
    run(at, &report.replace("--report report", "--report mixed-report"));
    file("mixed-report/notes.txt", b"dear");
    run(at, "scenario small.toml --seed 1 --days 2 -o days");

    let weights = fs::read(shipped("models/any/gcaps-x.safetensors")).expect("shipped weights");
    file("w.st", &weights);
    file("cut.st", &weights[..weights.len() / 2]);
    let day = fs::read(at.join("day.json")).expect("a day");
    file("cut.json", &day[..day.len() / 2]);
    let text = String::from_utf8(day.clone()).expect("text");
    file("nan.json", text.replacen("\"stands\": 6", "\"stands\": NaN", 1).as_bytes());
    file("huge.json", text.replacen("\"stands\": 6", "\"stands\": 1e999", 1).as_bytes());
    let trace = fs::read(at.join("trace.csv")).expect("a trace");
    file("cut.csv", &trace[..trace.len() / 2]);
    for empty in ["empty.json", "empty.toml", "empty.csv", "empty.st"] {
        file(empty, b"");
    }
    file("garbage", &[0xff, 0, 0x80, b'{', 0xfe]);
    file("notes.txt", b"dear to its owner");
    for folder in ["folder", "none", "strange", "twice", "taken", "run", "rest", "foreign"] {
        fs::create_dir(at.join(folder)).expect("a folder");
    }
    file("folder/notes.txt", b"dear");
    fs::write(at.join("twice/a.json"), &day).expect("a file");
    fs::write(at.join("twice/b.json"), &day).expect("a file");
    fs::write(at.join("strange/a.json"), &day).expect("a file");
    file("rest/a.json", b"{");
    file("foreign/package.json", b"{\"dependencies\": {}}");
    run(at, "scenario random:1 --seed 1 -o strange/b.json");
    file("taken/paper-3.json", b"dear");
    file("run/mlp.safetensors", b"of another program");

    symlink("day.json", at.join("soft.json")).expect("a link");
    symlink("small.toml", at.join("soft.toml")).expect("a link");
    symlink("nowhere.csv", at.join("dangling.csv")).expect("a link");
    fs::hard_link(at.join("day.json"), at.join("hard.json")).expect("a link");
    fs::hard_link(at.join("small.toml"), at.join("hard.toml")).expect("a link");
    fs::hard_link(at.join("w.st"), at.join("hard.st")).expect("a link");
    run(at, "scenario small.toml --seed 4 -o read-only.json");
    run(at, "simulate day.json --policy greedy --trace read-only.csv");
    run(at, &report.replace("--report report", "--report read-only"));
    for name in ["read-only.json", "read-only.csv", "read-only/report.html"] {
        fs::set_permissions(at.join(name), fs::Permissions::from_mode(0o444)).expect("our file");
    }
    folder
}

/// Checks that a misuse is answered by an orderly error message, with the right exit code and no
/// panic.
fn is_in_control(at: &Path, misuse: &Misuse) -> Result<(), String> {
    let (arguments, code, named) = *misuse;
    let output = vertifleet(at, arguments).output().expect("the program runs");
    let said = String::from_utf8_lossy(&output.stderr);
    let rules = [
        (output.status.code() == Some(code), "the exit code"),
        (said.contains(named), "what is named"),
        (said.contains("error[V") || said.contains("Usage:") || said.contains("error: "), "error"),
        (!said.contains("panicked"), "no panic"),
        (output.stdout.is_empty(), "nothing on stdout"),
    ];
    match rules.iter().find(|(kept, _)| !kept) {
        None => Ok(()),
        Some((_, rule)) => Err(format!("{rule}: {arguments}: {:?}\n{said}", output.status.code())),
    }
}

#[test]
fn every_misuse_is_answered_and_changes_nothing() {
    let folder = prepared();
    let at = folder.path();
    let before = contents(at);
    let mut wrong = Vec::new();
    let all: Vec<&Misuse> =
        misuses::ALL.iter().flat_map(|of_a_command| of_a_command.iter()).collect();
    assert!(all.len() >= 100, "{}", all.len());
    for misuse in all {
        wrong.extend(is_in_control(at, misuse).err());
        let after = contents(at);
        if after != before {
            let names = |files: &std::collections::BTreeMap<_, _>| {
                files.keys().cloned().collect::<Vec<_>>()
            };
            panic!("{} changed something: {:?} {:?}", misuse.0, names(&before), names(&after));
        }
    }
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn existing_files_are_replaced_only_with_force() {
    let folder = prepared();
    let at = folder.path();
    for arguments in [
        "scenario small.toml --seed 1 -o notes.txt",
        "scenario small.toml --seed 1 -o read-only.json",
        "simulate day.json --policy greedy --trace garbage",
        "simulate day.json --policy greedy --trace read-only.csv",
        "plan day.json --time-limit 0 -o other.json",
        "compare --network small.toml --policies greedy --days 1 --seed 5 --report folder",
        "compare --network small.toml --policies greedy --days 1 --seed 5 --report mixed-report",
        "compare --network small.toml --policies greedy --days 1 --seed 5 --report read-only",
        "train --network small.toml --policy mlp --steps 200 --set n_envs=2 --set n_steps=50 --set batch_size=100 \
         --set n_epochs=1 --set eval_days=1 --out run",
    ] {
        let refused = vertifleet(at, arguments).output().expect("the program runs");
        assert_eq!(refused.status.code(), Some(2), "{arguments}");
        run(at, &format!("{arguments} --force"));
    }
    let mode = fs::metadata(at.join("read-only.csv")).expect("a file").permissions().mode();
    assert_eq!(mode & 0o777, 0o444, "it stays read-only");
    assert_eq!(fs::read(at.join("folder.old/notes.txt")).expect("it is kept"), b"dear");
    assert_eq!(fs::read(at.join("mixed-report.old/notes.txt")).expect("it is kept"), b"dear");
    assert!(at.join("folder/report.html").exists() && at.join("mixed-report/report.html").exists());
    assert!(!at.join("read-only.old").exists(), "a report is replaced");
}

#[test]
fn two_results_never_go_to_one_file() {
    let folder = prepared();
    let at = folder.path();
    let before = fs::read(at.join("trace.csv")).expect("a trace");
    for (arguments, named) in [
        ("simulate day.json --policy greedy --trace trace.csv --force", "trace.csv"),
        ("plan day.json --time-limit 0 -o /dev/stdout", "/dev/stdout"),
    ] {
        let to = fs::File::options().append(true).open(at.join("trace.csv")).expect("a trace");
        let output = vertifleet(at, arguments).stdout(to).output().expect("the program runs");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("error[V142]") && said.contains(named), "{said}");
    }
    assert!(fs::read(at.join("trace.csv")).expect("a trace") == before);
    // A pipe has no content that could be overwritten, so the trace and the printed results may
    // both go to it.
    let output = run(at, "simulate day.json --policy greedy --trace /dev/stdout");
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(text.starts_with("time,aircraft") && text.contains("load factor"), "{text}");
}

#[test]
fn blanks_around_names_are_ignored() {
    let folder = folder();
    small_network(folder.path());
    let mut command = vertifleet(folder.path(), "compare --network small.toml --days 1 --seed 1");
    let output = command.args(["--policies", "greedy, prices"]).output().expect("the program runs");
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(output.status.success() && text.contains("\nprices "), "{text}");
}
