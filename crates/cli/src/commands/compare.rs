//! `vertifleet compare`: many days, many policies, one table and one report.

use std::process::ExitCode;

use anstream::eprintln;
use vertifleet_core::{Code, Network, Outputs, Stop};
use vertifleet_optimize::Step;
use vertifleet_progress::Bars;
use vertifleet_study::comparison::Comparison;
use vertifleet_study::entrants::Asked;
use vertifleet_study::{ComparisonReport, OwnDays, report, table};

use crate::args::CompareArguments;
use crate::commands::{command, find_network, reads_models, tell_kept, warn_of_days};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::{print, warn};

/// Seed of the random policy and of the planner's search on days that are not drawn.
const SEED_ON_OWN_DAYS: u64 = 0;

pub(crate) fn run(arguments: &CompareArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let mut outputs = Outputs::new(arguments.force);
    // Ctrl-C ends the program itself.
    let never = Stop::default();
    let comparison = comparison(arguments, &mut outputs, &never)?;
    reads_models(arguments.models.iter().map(|(_, model)| model), &mut outputs);
    if let Some(folder) = &arguments.report {
        outputs.replaces_folder(folder)?;
        report::check_folder(folder, arguments.force)?;
    }
    warn_of_days(comparison.days());
    for warning in comparison.warnings() {
        warn(Code(310), &warning);
    }
    let study = comparison.run(command(), &never, &Bars)?;
    let summary = ComparisonReport::of(&study)?;
    if arguments.json {
        print(&summary.to_json())?;
    } else {
        print(&table::text(&summary))?;
    }
    if let Some(folder) = &arguments.report {
        let paths = report::write(&study, folder, arguments.force)?;
        tell_kept(paths.kept.as_ref());
        eprintln!("report: {}", paths.report.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// Who is asked for, on the days that are.
fn comparison(
    arguments: &CompareArguments,
    outputs: &mut Outputs,
    stopped: &Stop,
) -> Result<Comparison, Failure> {
    let step = arguments.bound.then(|| Step::from_minutes(arguments.step)).transpose()?;
    let (policies, models) = (&arguments.policies, &arguments.models);
    let seed = arguments.seed.unwrap_or(SEED_ON_OWN_DAYS);
    let asked = |network| Asked { policies, models, seed, network };
    if !arguments.days_from.is_empty() {
        let days = OwnDays::read(&arguments.days_from)?;
        arguments.days_from.iter().for_each(|path| outputs.reads(path));
        let network = days.network().to_owned();
        return Ok(Comparison::of_own(days, &asked(&network), step)?);
    }
    let (Some(name), Some(days)) = (&arguments.network, arguments.days) else {
        unreachable!(
            "clap asks for a network and a number of days where there are none of one's own"
        )
    };
    let network: Network = find_network(name, outputs)?;
    Ok(Comparison::new(&network, &asked(network.name()), (seed, days), step, stopped)?)
}
