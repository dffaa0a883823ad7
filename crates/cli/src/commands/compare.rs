//! `vertifleet compare`: plays many days with many policies, for one table and one report.

use std::process::ExitCode;

use anstream::eprintln;
use vertifleet_core::{Code, Outputs, Stop};
use vertifleet_optimize::Step;
use vertifleet_progress::Bars;
use vertifleet_report::folder;
use vertifleet_study::comparison::{Comparison, DrawnDays};
use vertifleet_study::competitor::Selection;
use vertifleet_study::{ComparisonReport, OwnDays};

use crate::args::CompareArguments;
use crate::commands::{
    claim_report, command, find_network, reads_models, warn_of_purpose, warn_unserved_days,
};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::{print, warn};

/// The seed of the first of the drawn days, where none is given.
const FIRST_SEED: u64 = 1;
/// The seed of the random policy and of the planner's search on the user's own days.
const SEED_ON_OWN_DAYS: u64 = 0;

pub(crate) fn run(arguments: &CompareArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let mut outputs = Outputs::new(arguments.presented.force);
    // Ctrl-C ends the program, so the study needs no stop request.
    let never = Stop::default();
    let comparison = comparison(arguments, &mut outputs, &never)?;
    reads_models(arguments.models.iter().map(|(_, model)| model), &mut outputs);
    claim_report(&arguments.presented, &mut outputs)?;
    warn_unserved_days(comparison.days());
    for warning in comparison.warnings() {
        warn(Code(310), &warning);
    }
    let records = comparison.run(command(), &never, &Bars)?;
    let summary = ComparisonReport::of(&records)?;
    let report = vertifleet_report::comparison_folder(&summary, &records);
    print(&if arguments.presented.json { summary.to_json() } else { report.text() })?;
    if let Some(path) = &arguments.presented.report {
        let written = folder::write(&report, path, arguments.presented.force)?;
        if let Some(kept) = &written.kept {
            eprintln!("what was there before is now {}", kept.display());
        }
        eprintln!("report: {}", written.page.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// The comparison of the requested competitors on the requested days.
fn comparison(
    arguments: &CompareArguments,
    outputs: &mut Outputs,
    stop: &Stop,
) -> Result<Comparison, Failure> {
    let bound_step = arguments.bound.then(|| Step::from_minutes(arguments.step)).transpose()?;
    let (policies, models) = (&arguments.policies, &arguments.models);
    let usual = if arguments.days_from.is_empty() { FIRST_SEED } else { SEED_ON_OWN_DAYS };
    let seed = arguments.seed.unwrap_or(usual);
    let selection = Selection { policies, models, seed };
    if !arguments.days_from.is_empty() {
        let days = OwnDays::read(&arguments.days_from)?;
        arguments.days_from.iter().for_each(|path| outputs.reads(path));
        return Ok(Comparison::of_own(days, &selection, bound_step)?);
    }
    let (Some(name), Some(days)) = (&arguments.network, arguments.days) else {
        unreachable!(
            "clap asks for a network and a number of days where there are none of one's own"
        )
    };
    let network = find_network(name, outputs)?;
    warn_of_purpose(&network, arguments.split);
    let drawn = DrawnDays { purpose: arguments.split, first: seed, days };
    Ok(Comparison::new(&network, &selection, drawn, bound_step, stop)?)
}
