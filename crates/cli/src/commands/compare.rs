//! `vertifleet compare`: many days, many policies, one table and one report.

use std::process::ExitCode;
use std::sync::Arc;

use anstream::eprintln;
use vertifleet_core::{DaySeed, Network, Scenario};
use vertifleet_optimize::Step;
use vertifleet_study::run::Day;
use vertifleet_study::{NetworkOrigin, Study, Summary, report, table};

use crate::args::CompareArguments;
use crate::commands::days::{bounded, command, play};
use crate::entrants::{self, Asked, Entrant};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::print;

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
    let entrants = asked.entrants()?;
    let contenders = entrants::contenders(&entrants)?;
    let scenarios = draw(&network, arguments)?;
    if let Some(folder) = &arguments.report {
        report::check_folder(folder)?;
    }
    let network_origin = NetworkOrigin::of(network.name(), scenarios.iter().map(Arc::as_ref));
    entrants.iter().try_for_each(|entrant| entrant.check_fits(&scenarios[0]))?;
    for (entrant, recipe) in entrants.iter().filter_map(|one| Some((one, one.recipe()?))) {
        recipe.warn_if_shipped_for_another(&entrant.name, network.name(), network_origin);
    }
    let unbounded = |scenario| Day { scenario, upper_bound_usd: None };
    let days = match step {
        Some(step) => bounded(scenarios, step)?,
        None => scenarios.into_iter().map(unbounded).collect(),
    };
    let policies = play(&days, &contenders, entrants.len())?;
    let study = Study {
        network: network.name().to_owned(),
        network_origin,
        seed: arguments.seed,
        days: days.len(),
        bound_step_s: step.map(Step::seconds),
        command: command(),
        policies,
        curves: entrants.iter().filter_map(Entrant::curve).collect(),
        trainings: entrants.iter().filter_map(Entrant::training).collect(),
    };
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

fn draw(network: &Network, arguments: &CompareArguments) -> Result<Vec<Arc<Scenario>>, Failure> {
    // The last seed first, so that nothing is drawn where not everything can be.
    let seed = |day: u32| DaySeed::comparison(arguments.seed.saturating_add(u64::from(day)));
    seed(arguments.days - 1)?;
    (0..arguments.days).map(|day| Ok(Arc::new(network.draw(seed(day)?)))).collect()
}
