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
        eprintln!("\u{1b}[1;33mwarning\u{1b}[0m: {}: {warning}", path.display());
    }
    Ok(scenario)
}
