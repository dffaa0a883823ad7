//! `vertifleet compare`: many days, many policies, one table and one report.

use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use anstream::eprintln;
use vertifleet_core::{DaySeed, Network, Scenario};
use vertifleet_study::run::{Contender, Contenders, run as play_all};
use vertifleet_study::{Curve, NetworkOrigin, Study, Summary, report, table};

use crate::args::CompareArguments;
use crate::failure::Failure;
use crate::output::print;
use crate::policies::{self, Recipe};
use crate::progress::Progress;

pub(crate) fn run(arguments: &CompareArguments) -> Result<ExitCode, Failure> {
    let network = Network::find(&arguments.network)?;
    let recipes = recipes(arguments, network.name())?;
    let contenders = contenders(&recipes)?;
    let days = draw(&network, arguments)?;
    if let Some(folder) = &arguments.report {
        vertifleet_core::create_folder(folder)?;
    }
    let network_origin = NetworkOrigin::of(network.name(), days.iter().map(Arc::as_ref));
    for (name, recipe) in &recipes {
        recipe.check_fits(&days[0])?;
        recipe.warn_if_shipped_for_another(name, network.name(), network_origin);
    }
    let progress = Progress::new((days.len() * recipes.len()) as u64, "days");
    let policies = play_all(&days, &contenders, &|| progress.advance(1));
    progress.finish();
    let study = Study {
        network: network.name().to_owned(),
        network_origin,
        seed: arguments.seed,
        days: days.len(),
        command: command(),
        policies: policies?,
        curves: curves(&recipes),
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

/// The policies by name: weights given by --model first, then rules, then the network's shipped weights.
fn recipes(arguments: &CompareArguments, network: &str) -> Result<Vec<(String, Recipe)>, Failure> {
    let models: Vec<String> = arguments.models.iter().map(|(name, _)| name.clone()).collect();
    if let Some(twice) = first_repeated(&models) {
        return Err(Failure::usage(
            format!("--model names {twice:?} twice"),
            "give each name one path",
        ));
    }
    if let Some(unused) = models.iter().find(|name| !arguments.policies.contains(name)) {
        return Err(Failure::usage(
            format!("--model names {unused:?}, which is not among --policies"),
            "add the name to --policies",
        ));
    }
    let recipe = |name: &String| {
        let given = arguments.models.iter().find(|(given, _)| given == name);
        let recipe = match (given, Recipe::rule(name, arguments.seed)) {
            (Some(_), Some(_)) => return Err(policies::takes_no_weights(name)),
            (Some((_, path)), None) => Recipe::of_file_with_curve(name, Path::new(path))?,
            (None, Some(rule)) => rule,
            (None, None) => Recipe::shipped(name, network)?,
        };
        Ok((name.clone(), recipe))
    };
    arguments.policies.iter().map(recipe).collect()
}

fn first_repeated(names: &[String]) -> Option<&String> {
    names.iter().enumerate().find(|(at, name)| names[..*at].contains(name)).map(|(_, name)| name)
}

fn draw(network: &Network, arguments: &CompareArguments) -> Result<Vec<Arc<Scenario>>, Failure> {
    // The last seed first, so that nothing is drawn where not everything can be.
    let seed = |day: u32| DaySeed::comparison(arguments.seed.saturating_add(u64::from(day)));
    seed(arguments.days - 1)?;
    (0..arguments.days).map(|day| Ok(Arc::new(network.draw(seed(day)?)))).collect()
}

fn contenders(recipes: &[(String, Recipe)]) -> Result<Contenders<'_>, Failure> {
    let contenders = recipes.iter().map(|(name, recipe)| Contender {
        name: name.clone(),
        description: recipe.description(),
        make: Box::new(|| recipe.make()),
    });
    Ok(Contenders::new(contenders.collect())?)
}

/// The learning curves of the learned policies that have one.
fn curves(recipes: &[(String, Recipe)]) -> Vec<Curve> {
    let curve = |(name, recipe): &(String, Recipe)| {
        let points = recipe.curve();
        (!points.is_empty()).then(|| Curve { name: name.clone(), points })
    };
    recipes.iter().filter_map(curve).collect()
}

/// The command as anyone can type it, wherever the program lies.
fn command() -> String {
    std::iter::once("vertifleet".to_owned())
        .chain(std::env::args().skip(1))
        .collect::<Vec<_>>()
        .join(" ")
}
