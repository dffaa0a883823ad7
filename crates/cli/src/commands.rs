//! The commands, one file each, and the functions that they share.

pub(crate) mod board;
pub(crate) mod bound;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod evaluate;
pub(crate) mod explain;
pub(crate) mod export;
pub(crate) mod network;
#[cfg(feature = "service")]
pub(crate) mod operate;
pub(crate) mod plan;
pub(crate) mod scenario;
#[cfg(feature = "service")]
pub(crate) mod serve;
pub(crate) mod simulate;
pub(crate) mod size;
pub(crate) mod sweep;
pub(crate) mod train;

use std::path::Path;

use anstream::eprintln;
use vertifleet_core::{Network, Outputs, Purpose, Scenario, World};
use vertifleet_report::folder;
use vertifleet_study::{PolicySource, PolicySpec};

use crate::args::PresentedArguments;
use crate::failure::Failure;
use crate::output::warn;

/// Largest number of warnings about many days that are printed.
const MOST_WARNINGS: usize = 10;

/// Finds the network with this name or path, and protects the files that were read from being
/// overwritten.
fn find_network(name: &str, outputs: &mut Outputs) -> Result<Network, Failure> {
    let network = Network::find(name)?;
    for file in network.files() {
        outputs.reads(file);
    }
    Ok(network)
}

/// Finds the world with this name, and protects the files that were read from being overwritten.
fn resolve_network(name: &str, outputs: &mut Outputs) -> Result<World, Failure> {
    let world = World::find(name)?;
    if let World::Network(network) = &world {
        for file in network.files() {
            outputs.reads(file);
        }
    }
    Ok(world)
}

/// Protects the weight files that are read from being overwritten.
fn reads_models<'a>(models: impl IntoIterator<Item = &'a PolicySource>, outputs: &mut Outputs) {
    for model in models {
        if let PolicySource::File(path) = model {
            outputs.reads(path);
        }
    }
}

/// Protects the files of a policy, its weights and the trace that it replays, from being
/// overwritten.
fn reads_policy(spec: &PolicySpec, model: Option<&PolicySource>, outputs: &mut Outputs) {
    reads_models(model, outputs);
    if let Some(replayed) = spec.replayed() {
        outputs.reads(replayed);
    }
}

/// Prints the warnings about some days on stderr, each one once, with the first day that it applies
/// to.
fn warn_unserved_days<'a>(days: impl IntoIterator<Item = &'a Scenario>) {
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

/// Warns if days of a purpose are asked for, and the network was drawn for another one. Results on
/// a network that policies are trained on say nothing of other networks, and policies that are
/// trained or chosen on a comparison network must not be reported on it.
fn warn_of_purpose(network: &Network, purpose: Purpose) {
    let Some(drawn_for) = network.purpose().filter(|&drawn_for| drawn_for != purpose) else {
        return;
    };
    let (name, drawn_for) = (network.name(), drawn_for.name());
    let stricter = network.purpose().map_or(purpose, |of| of.stricter(purpose)).name();
    eprintln!(
        "warning: {name} is a {drawn_for} network, but its {} days are asked for: treat them as {stricter} days",
        purpose.name()
    );
}

/// Prints the warnings about passengers whom no fleet can carry, for studies of fleets.
fn warn_of_demand(network: &Network) {
    for warning in network.warnings().iter().filter(|warning| warning.is_about_demand()) {
        warn(warning.code(), &format!("{}: {warning}", network.name()));
    }
}

/// Checks, before any day is played, that the report can be written to its folder without replacing
/// an input file.
fn claim_report(arguments: &PresentedArguments, outputs: &mut Outputs) -> Result<(), Failure> {
    if let Some(folder) = &arguments.report {
        outputs.replaces_folder(folder)?;
        folder::check(folder, arguments.force)?;
    }
    Ok(())
}

/// Reads a scenario file and prints the warnings about it on stderr.
fn read_scenario(path: &Path) -> Result<Scenario, Failure> {
    let scenario = Scenario::read(path)?;
    for warning in scenario.warnings() {
        warn(warning.code(), &format!("{}: {warning}", path.display()));
    }
    Ok(scenario)
}

/// The command line, starting with the program's name without its path.
fn command() -> String {
    std::iter::once("vertifleet".to_owned())
        .chain(std::env::args().skip(1))
        .collect::<Vec<_>>()
        .join(" ")
}
