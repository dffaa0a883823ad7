//! Helpers for tests of misuse: a folder with files of every kind, small enough that commands
//! finish quickly.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder, which is removed at the end.
pub(crate) fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

/// The program in this folder; bounds are kept there too.
pub(crate) fn vertifleet(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vertifleet"));
    command.current_dir(folder).env("XDG_CACHE_HOME", folder.join("kept"));
    command.args(arguments.split_whitespace());
    command
}

/// Runs a command that must succeed.
pub(crate) fn run(folder: &Path, arguments: &str) -> Output {
    let output = vertifleet(folder, arguments).output().expect("the program runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments}: {said}");
    output
}

/// Files of the project, by their path in it.
pub(crate) fn shipped(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// `small.toml`: the network `paper` with days of three quarters of an hour.
pub(crate) fn small_network(folder: &Path) {
    let paper = fs::read_to_string(shipped("networks/paper.toml")).expect("the shipped network");
    let small = paper.replace("end = \"18:00:00\"", "end = \"06:45:00\"");
    assert_ne!(small, paper);
    fs::write(folder.join("small.toml"), small).expect("a file");
}
