//! `vertifleet train --policy gcaps-x`: runs a course, shows how it goes, and leaves weights and curve.

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anstream::eprintln;
use vertifleet_core::Network;
use vertifleet_learn::nn::Architecture;
use vertifleet_learn::relative::{Course, Round, Study, to_csv};

use crate::args::TrainArguments;
use crate::failure::Failure;
use crate::interrupt::stop_on_interrupt;
use crate::output::print;
use crate::policies::curve_beside;
use crate::progress::Progress;

pub(crate) fn run(arguments: &TrainArguments) -> Result<ExitCode, Failure> {
    let mut study = study(arguments)?;
    vertifleet_core::create_folder(&arguments.out)?;
    let weights = arguments.out.join("gcaps-x.safetensors");
    let curve = curve_beside(&weights);
    // The round under way is given up then; weights are as the round before left them.
    let stop = stop_on_interrupt()?;
    let mut rounds: Vec<Round> = Vec::new();
    let progress = progress(study.course());
    while !study.is_done() {
        let Some(round) = learn(&mut study, &progress, &stop)? else { break };
        progress.say(format!("gain over prices {:.2} %", 100.0 * round.gain));
        rounds.push(round);
        study.model().write(&weights)?;
        vertifleet_core::write_atomically(&curve, to_csv(&rounds).as_bytes())?;
    }
    drop(progress);
    let Some(last) = rounds.last() else {
        eprintln!("stopped before the first round was over; nothing is written");
        return Ok(ExitCode::SUCCESS);
    };
    let lines = [
        format!("rounds             {}", last.round),
        format!("decisions          {}", last.decisions),
        format!("gain over prices   {:.2} %", 100.0 * last.gain),
        format!("  random networks  {:.2} %", 100.0 * last.random_gain),
        format!("weights            {}", weights.display()),
        format!("learning curve     {}", curve.display()),
    ];
    print(&lines.join("\n"))?;
    Ok(ExitCode::SUCCESS)
}

fn learn(
    study: &mut Study,
    progress: &Progress,
    stop: &AtomicBool,
) -> Result<Option<Round>, Failure> {
    let go_on = || {
        progress.advance(1);
        !stop.load(Ordering::Relaxed)
    };
    Ok(study.round(&go_on)?)
}

/// Days played and passes made are the units; they take about as long.
fn progress(course: &Course) -> Progress {
    Progress::new(u64::from(course.rounds) * u64::from(course.days + course.passes), "days")
}

fn study(arguments: &TrainArguments) -> Result<Study, Failure> {
    if arguments.resume || arguments.steps.is_some() || arguments.preset != "default" {
        return Err(Failure::usage(
            "--resume, --steps and --preset are not for gcaps-x, which learns in rounds".to_owned(),
            "change its settings with --set, as --set rounds=4",
        ));
    }
    let mut course = Course::default();
    course.set(arguments.set.iter().map(|(name, value)| (name.as_str(), value.as_str())))?;
    let network = Arc::new(Network::find(&arguments.network)?);
    let architecture = Architecture::named("gcaps-x").expect("a policy with sizes");
    let origin = (arguments.seed, env!("VERTIFLEET_COMMIT").to_owned());
    Ok(Study::start(network, architecture, course, origin)?)
}
