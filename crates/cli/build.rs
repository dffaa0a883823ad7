//! Sets the commit that the program is built from, for the header of the weights it trains.

use std::process::Command;

fn main() {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    let commit = git(&["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(|| "unknown".to_owned());
    // Sources only: other files in these folders do not change the program.
    let changed = git(&["status", "--porcelain", "--", ":/crates", ":/networks", ":/Cargo.lock"]);
    let mark = if changed.is_some_and(|files| !files.is_empty()) { "-dirty" } else { "" };
    let commit = commit + mark;
    println!("cargo::rustc-env=VERTIFLEET_COMMIT={commit}");
    if let Some(folder) = git(&["rev-parse", "--absolute-git-dir"]) {
        println!("cargo::rerun-if-changed={folder}/logs/HEAD");
    }
    println!("cargo::rerun-if-changed=build.rs");
}
