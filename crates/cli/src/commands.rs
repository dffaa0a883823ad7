//! One file a command, and what they share.

pub(crate) mod bound;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod generalise;
pub(crate) mod plan;
pub(crate) mod scenario;
pub(crate) mod simulate;
pub(crate) mod train;

use std::path::Path;

use anstream::eprintln;
use vertifleet_core::{Network, Outputs, Scenario};
use vertifleet_study::PolicySource;
use vertifleet_study::report::{self, Records};

use crate::failure::Failure;
use crate::output::{print, warn};

/// Warnings of many days that are printed one by one.
const MOST_WARNINGS: usize = 10;

/// The network of this name or path; what it is read from is not to be written to.
fn find_network(name: &str, outputs: &mut Outputs) -> Result<Network, Failure> {
    let network = Network::find(name)?;
    for file in network.files() {
        outputs.reads(file);
    }
    Ok(network)
}

/// Weights that are read are not to be written to.
fn reads_models<'a>(models: impl IntoIterator<Item = &'a PolicySource>, outputs: &mut Outputs) {
    for model in models {
        if let PolicySource::File(path) = model {
            outputs.reads(path);
        }
    }
}

/// Says on stderr what looks wrong with some days, each thing once, with the first day that it was found on.
fn warn_of_days<'a>(days: impl IntoIterator<Item = &'a Scenario>) {
    let mut said: Vec<String> = Vec::new();
    let mut more = 0_u32;
    for day in days {
        for warning in day.warnings() {
            let text = warning.to_string();
            if said.contains(&text) {
                continue;
            }
            if said.len() == MOST_WARNINGS {
                more += 1;
                continue;
            }
            warn(warning.code(), &format!("{}: {text}", day.name));
            said.push(text);
        }
    }
    if more > 0 {
        eprintln!("and {more} more such warnings");
    }
}

/// Makes sure, before any day is played, that a report can be written to this folder and replaces nothing that is read.
fn claim_report(folder: Option<&Path>, outputs: &mut Outputs, force: bool) -> Result<(), Failure> {
    if let Some(folder) = folder {
        outputs.replaces_folder(folder)?;
        report::check_folder(folder, force)?;
    }
    Ok(())
}

/// Prints a study, and writes its report where one is asked for.
fn present(
    study: &impl Records,
    json: bool,
    folder: Option<&Path>,
    force: bool,
) -> Result<(), Failure> {
    print(&if json { study.json()? } else { study.text()? })?;
    if let Some(folder) = folder {
        let written = report::write(study, folder, force)?;
        if let Some(kept) = &written.kept {
            eprintln!("what was there before is now {}", kept.display());
        }
        eprintln!("report: {}", written.page.display());
    }
    Ok(())
}

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
