//! One file a command, and what they share.

pub(crate) mod bound;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod generalise;
pub(crate) mod plan;
pub(crate) mod scenario;
pub(crate) mod simulate;
pub(crate) mod train;
mod train_any;

use std::path::Path;

use vertifleet_core::Scenario;

use crate::failure::Failure;
use crate::output::warn;

/// Reads a scenario file and says on stderr what looks wrong with it.
fn read_scenario(path: &Path) -> Result<Scenario, Failure> {
    let scenario = Scenario::read(path)?;
    for warning in scenario.warnings() {
        warn(warning.code(), &format!("{}: {warning}", path.display()));
    }
    Ok(scenario)
}

/// The command as anyone can type it, wherever the program lies.
fn command() -> String {
    std::iter::once("vertifleet".to_owned())
        .chain(std::env::args().skip(1))
        .collect::<Vec<_>>()
        .join(" ")
}
