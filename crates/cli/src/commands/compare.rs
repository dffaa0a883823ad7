//! `vertifleet compare`: many days, many policies, one table and one report.

use std::process::ExitCode;
use std::sync::Arc;

use anstream::eprintln;
use rayon::prelude::*;
use vertifleet_core::{DaySeed, Network, Scenario};
use vertifleet_optimize::Step;
use vertifleet_study::run::{Contenders, Day, run as play_all};
use vertifleet_study::{NetworkOrigin, PolicyRecord, Study, Summary, report, table};

use crate::args::CompareArguments;
use crate::entrants::{self, Entrant};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::kept_bounds::KeptBounds;
use crate::output::print;
use crate::progress::Progress;

pub(crate) fn run(arguments: &CompareArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let network = Network::find(&arguments.network)?;
    let step = arguments.bound.then(|| Step::from_minutes(arguments.step)).transpose()?;
    let entrants = Entrant::all(arguments, network.name())?;
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
    let days = bounded(scenarios, step)?;
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

/// Plays every day with everybody. A bar for each, since a day of one may take a million times as long as that of another:
/// how long those take that come later is not known.
fn play(
    days: &[Day],
    contenders: &Contenders<'_>,
    number: usize,
) -> Result<Vec<PolicyRecord>, Failure> {
    let mut begun = 0;
    let policies = play_all(days, contenders, |name| {
        begun += 1;
        let units = format!("days of {name} ({begun} of {number} policies)");
        let progress = Progress::new(days.len() as u64, units);
        move || progress.advance(1)
    })?;
    Ok(policies)
}

/// The days with their upper bounds, where a step for them is given.
fn bounded(scenarios: Vec<Arc<Scenario>>, step: Option<Step>) -> Result<Vec<Day>, Failure> {
    let Some(step) = step else {
        let unbounded = |scenario| Day { scenario, upper_bound_usd: None };
        return Ok(scenarios.into_iter().map(unbounded).collect());
    };
    let kept = KeptBounds::of_this_user();
    let progress = Progress::new(scenarios.len() as u64, "bounds");
    let bound = |scenario: Arc<Scenario>| {
        let upper_bound_usd = kept.upper_bound_usd(&scenario, step)?;
        progress.advance(1);
        Ok(Day { scenario, upper_bound_usd: Some(upper_bound_usd) })
    };
    scenarios.into_par_iter().map(bound).collect()
}

fn draw(network: &Network, arguments: &CompareArguments) -> Result<Vec<Arc<Scenario>>, Failure> {
    // The last seed first, so that nothing is drawn where not everything can be.
    let seed = |day: u32| DaySeed::comparison(arguments.seed.saturating_add(u64::from(day)));
    seed(arguments.days - 1)?;
    (0..arguments.days).map(|day| Ok(Arc::new(network.draw(seed(day)?)))).collect()
}

/// The command as anyone can type it, wherever the program lies.
fn command() -> String {
    std::iter::once("vertifleet".to_owned())
        .chain(std::env::args().skip(1))
        .collect::<Vec<_>>()
        .join(" ")
}
