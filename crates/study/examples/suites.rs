//! Freezes the suites: draws their days, proves their bounds, and writes their tables.
//!
//! `make suites`, or `cargo run --release -p vertifleet-study --example suites -- FOLDER [NAME...]`

use std::path::Path;
use std::process::ExitCode;

use vertifleet_core::{Coded, Stop, write_atomically};
use vertifleet_study::{Error, SUITES, Suite};

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let Some(folder) = arguments.next() else {
        eprintln!("usage: suites FOLDER [NAME...]");
        return ExitCode::from(2);
    };
    let names: Vec<String> = arguments.collect();
    let asked = |suite: &Suite| names.is_empty() || names.iter().any(|name| *name == suite.name);
    for suite in SUITES.into_iter().filter(asked) {
        if let Err(error) = freeze(&suite, Path::new(&folder)) {
            eprintln!("error[{}]: {error}", error.code());
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn freeze(suite: &Suite, folder: &Path) -> Result<(), Error> {
    let table = suite.freeze(&Stop::default(), &|| eprint!("."))?;
    let path = folder.join(format!("{}.csv", suite.name));
    write_atomically(&path, table.as_bytes())?;
    eprintln!("\n{}", path.display());
    Ok(())
}
