//! `vertifleet generalise`: a day each of many random networks, many policies, one table and one report.

use std::process::ExitCode;
use std::sync::Arc;

use anstream::eprintln;
use vertifleet_core::{DaySeed, Network, Outputs, Purpose, Scenario, Stop, random_network};
use vertifleet_optimize::Step;
use vertifleet_progress::Bars;
use vertifleet_study::comparison::{Watch as _, play};
use vertifleet_study::entrants::{Asked, contenders};
use vertifleet_study::generalisation::{
    self, GeneralisationRecords, GeneralisationReport, NetworkRecord,
};
use vertifleet_study::{KeptBounds, report};

use crate::args::GeneraliseArguments;
use crate::commands::{command, reads_models, tell_kept, warn_of_days};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::print;

/// Seed of the random policy and of the planner's search: the days differ enough.
const SEED: u64 = 0;

pub(crate) fn run(arguments: &GeneraliseArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let step = Step::from_minutes(arguments.step)?;
    let asked = Asked {
        policies: &arguments.policies,
        models: &arguments.models,
        seed: SEED,
        network: "random",
    };
    let entrants = asked.entrants()?;
    // A name that comes twice is refused before anything is drawn.
    contenders(&entrants)?;
    if let Some(folder) = &arguments.report {
        let mut outputs = Outputs::new(arguments.force);
        reads_models(arguments.models.iter().map(|(_, model)| model), &mut outputs);
        outputs.replaces_folder(folder)?;
        report::check_folder(folder, arguments.force)?;
    }
    let numbers = || 0..u64::from(arguments.networks);
    let scenarios: Vec<Arc<Scenario>> = numbers().map(day).collect::<Result<_, Failure>>()?;
    for scenario in &scenarios {
        entrants.iter().try_for_each(|entrant| entrant.check_fits(scenario))?;
    }
    warn_of_days(scenarios.iter().map(Arc::as_ref));
    let record = |(number, scenario): (u64, &Arc<Scenario>)| NetworkRecord {
        name: Network::random_name(number),
        vertiports: scenario.vertiports.len(),
        aircraft: scenario.aircraft.len(),
    };
    let networks = numbers().zip(&scenarios).map(record).collect();
    // Ctrl-C ends the program itself.
    let never = Stop::default();
    let bar = Bars.bounds(scenarios.len());
    let days = KeptBounds::of_this_user().days(scenarios, step, &never, &bar)?;
    let policies = play(&days, &entrants, &never, &Bars)?;
    let study = GeneralisationRecords {
        bound_step_s: step.seconds(),
        command: command(),
        networks,
        policies,
    };
    let summary = GeneralisationReport::of(&study)?;
    if arguments.json {
        print(&summary.to_json())?;
    } else {
        print(&generalisation::text(&summary))?;
    }
    if let Some(folder) = &arguments.report {
        let written = generalisation::write(&study, folder, arguments.force)?;
        tell_kept(written.kept.as_ref());
        eprintln!("report: {}", written.report.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// The day of a random network that has the same number.
fn day(number: u64) -> Result<Arc<Scenario>, Failure> {
    let network = random_network(Purpose::Comparison, number);
    Ok(Arc::new(network.draw(DaySeed::comparison(number)?)))
}
