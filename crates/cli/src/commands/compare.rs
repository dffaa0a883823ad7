//! `vertifleet compare`: many days, many policies, one table and one report.

use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

use anstream::eprintln;
use vertifleet_core::{Code, Network};
use vertifleet_optimize::Step;
use vertifleet_progress::Bars;
use vertifleet_study::comparison::Comparison;
use vertifleet_study::entrants::Asked;
use vertifleet_study::{Summary, report, table};

use crate::args::CompareArguments;
use crate::commands::command;
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::{print, warn};

pub(crate) fn run(arguments: &CompareArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let network = Network::find(&arguments.network)?;
    let step = arguments.bound.then(|| Step::from_minutes(arguments.step)).transpose()?;
    let asked = Asked {
        policies: &arguments.policies,
        models: &arguments.models,
        seed: arguments.seed,
        network: network.name(),
    };
    // Ctrl-C ends the program itself.
    let never = AtomicBool::new(false);
    let days = (arguments.seed, arguments.days);
    let comparison = Comparison::new(&network, &asked, days, step, &never)?;
    if let Some(folder) = &arguments.report {
        report::check_folder(folder)?;
    }
    for warning in comparison.warnings() {
        warn(Code(310), &warning);
    }
    let study = comparison.run(command(), &never, &Bars)?;
    let summary = Summary::of(&study)?;
    if arguments.json {
        print(&summary.to_json())?;
    } else {
        print(&table::text(&summary))?;
    }
    if let Some(folder) = &arguments.report {
        let paths = report::write(&study, folder)?;
        eprintln!("report: {}", paths.report.display());
    }
    Ok(ExitCode::SUCCESS)
}
