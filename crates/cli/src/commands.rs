//! One file a command, and what they share.

pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod scenario;
pub(crate) mod simulate;
pub(crate) mod train;

use std::path::Path;

use anstream::eprintln;
use vertifleet_core::Scenario;

use crate::failure::Failure;

/// Reads a scenario file and says on stderr what looks wrong with it.
fn read_scenario(path: &Path) -> Result<Scenario, Failure> {
    let scenario = Scenario::read(path)?;
    for warning in scenario.warnings() {
        let (yellow, reset) = ("\u{1b}[1;33m", "\u{1b}[0m");
        eprintln!("{yellow}warning[{}]{reset}: {}: {warning}", warning.code(), path.display());
    }
    Ok(scenario)
}
