//! `vertifleet size`: how many aircraft, stands and chargers a network should have.

use std::process::ExitCode;

use anstream::eprintln;
use vertifleet_core::{Outputs, Stop, check_folder};
use vertifleet_optimize::Step;
use vertifleet_progress::Bar;
use vertifleet_report::folder;
use vertifleet_study::comparison::DrawnDays;
use vertifleet_study::competitor::Selection;
use vertifleet_study::size::{SizeRequest, Sizing};

use crate::args::SizeArguments;
use crate::commands::{command, find_network, reads_models, warn_of_demand, warn_unserved_days};
use crate::failure::Failure;
use crate::interrupt::end_study_on_interrupt;
use crate::output::print;

pub(crate) fn run(arguments: &SizeArguments) -> Result<ExitCode, Failure> {
    end_study_on_interrupt()?;
    let policies = [arguments.policy.clone()];
    let models = arguments.model.iter().map(|model| (arguments.policy.clone(), model.clone()));
    let models: Vec<_> = models.collect();
    let mut outputs = Outputs::new(arguments.force);
    let network = find_network(&arguments.network, &mut outputs)?;
    reads_models(models.iter().map(|(_, model)| model), &mut outputs);
    outputs.replaces_folder(&arguments.out)?;
    check_folder(&arguments.out, &folder::SIZE, arguments.force)?;
    let sizing = Sizing::new(SizeRequest {
        network: &network,
        factors: arguments.vary.clone(),
        goal: arguments.goal,
        selection: &Selection { policies: &policies, models: &models, seed: arguments.seed },
        drawn: DrawnDays { purpose: arguments.split, first: arguments.seed, days: arguments.days },
        bound_step: Step::from_minutes(arguments.step)?,
        designs: arguments.designs,
    })?;
    warn_of_demand(&network);
    warn_unserved_days(Some(&sizing.first_day()?));
    // Ctrl-C ends the program; the results of finished designs are on disk.
    let (stop, folder) = (Stop::default(), &arguments.out);
    let bar = Bar::new(sizing.designs() as u64, "designs");
    let records = sizing.run(folder, command(), arguments.force, &stop, &mut || bar.advance(1))?;
    drop(bar);
    let report = vertifleet_report::size(&records.report, &records.best);
    let page = folder::write_beside_journal(&report, folder)?;
    print(&if arguments.json { records.report.to_json() } else { report.text() })?;
    eprintln!("report: {}", page.display());
    eprintln!("network file of the design: {}", folder.join("best.toml").display());
    Ok(ExitCode::SUCCESS)
}
