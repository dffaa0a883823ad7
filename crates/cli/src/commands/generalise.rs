//! `vertifleet generalise`: plays a day of each of many random networks with many policies, for one table and one
//! report.

use std::process::ExitCode;

use vertifleet_core::{Outputs, Stop};
use vertifleet_optimize::Step;
use vertifleet_progress::Bars;
use vertifleet_study::competitor::Selection;
use vertifleet_study::generalisation::Generalisation;

use crate::args::GeneraliseArguments;
use crate::commands::{claim_report, command, present, reads_models, warn_of_days};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;

/// The seed of the random policy and of the planner's search. It can be fixed because the days differ enough.
const SEED: u64 = 0;

pub(crate) fn run(arguments: &GeneraliseArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let (policies, models) = (&arguments.policies, &arguments.models);
    let selection = Selection { policies, models, seed: SEED };
    let step = Step::from_minutes(arguments.step)?;
    let generalisation = Generalisation::new(&selection, arguments.networks, step)?;
    let mut outputs = Outputs::new(arguments.presented.force);
    reads_models(models.iter().map(|(_, model)| model), &mut outputs);
    claim_report(&arguments.presented, &mut outputs)?;
    warn_of_days(generalisation.days());
    // Ctrl-C ends the program itself, so the study is never asked to stop.
    let study = generalisation.run(command(), &Stop::default(), &Bars)?;
    present(&study, &arguments.presented)?;
    Ok(ExitCode::SUCCESS)
}
