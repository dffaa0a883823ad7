//! `vertifleet train --policy gcaps-x`: runs a course, shows how it goes, and leaves weights, curve and checkpoint.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anstream::eprintln;
use vertifleet_core::{Network, Outputs};
use vertifleet_learn::nn::Architecture;
use vertifleet_learn::relative::{Course, Plan, Study};
use vertifleet_learn::{curve_beside, kinds, to_csv};
use vertifleet_progress::Bar;

use crate::args::TrainArguments;
use crate::commands::find_network;
use crate::commands::train::{earlier_run, warn_of_training};
use crate::failure::Failure;
use crate::interrupt::stop_on_interrupt;
use crate::output::print;

/// Files of a run, in the folder the user names.
struct Files {
    weights: PathBuf,
    curve: PathBuf,
    checkpoint: PathBuf,
}

impl Files {
    fn of(folder: &Path) -> Self {
        let weights = folder.join("gcaps-x.safetensors");
        let checkpoint = folder.join("gcaps-x-checkpoint.safetensors");
        Self { curve: curve_beside(&weights), weights, checkpoint }
    }

    /// None of them is read for something else, and what is there already is of an earlier run.
    fn claim(&self, outputs: &mut Outputs) -> Result<(), Failure> {
        outputs.writes(&self.weights, &kinds::WEIGHTS_ANY)?;
        outputs.writes(&self.curve, &kinds::CURVE_ANY)?;
        outputs.writes(&self.checkpoint, &kinds::CHECKPOINT_ANY)?;
        Ok(())
    }

    /// Leaves the run as it stands. The checkpoint comes last, so that what it knows of is there.
    fn write(&self, study: &Study) -> Result<(), Failure> {
        study.model().write(&self.weights)?;
        vertifleet_core::write_atomically(&self.curve, to_csv(study.rounds()).as_bytes())?;
        study.write_checkpoint(&self.checkpoint)?;
        Ok(())
    }
}

pub(crate) fn run(arguments: &TrainArguments) -> Result<ExitCode, Failure> {
    let mut outputs = Outputs::new(arguments.force);
    let network = find_network(&arguments.network, &mut outputs)?;
    warn_of_training(&network, arguments.seed)?;
    let plan = plan(arguments, network)?;
    let files = Files::of(&arguments.out);
    if arguments.out.exists() && (arguments.resume || !files.checkpoint.exists()) {
        files.claim(&mut outputs)?;
    }
    let mut study = if arguments.resume {
        Study::resume(plan, &files.checkpoint)?
    } else if files.checkpoint.exists() {
        return Err(earlier_run(&files.checkpoint));
    } else {
        Study::start(plan)?
    };
    vertifleet_core::create_folder(&arguments.out)?;
    // The round under way is given up then; the files are as the round before left them.
    let stop = stop_on_interrupt()?;
    learn(&mut study, &files, &stop)?;
    tell(&study, &files)?;
    Ok(ExitCode::SUCCESS)
}

/// Learns until all is learned or `stop` is raised, and sets the run aside after every round.
fn learn(study: &mut Study, files: &Files, stop: &AtomicBool) -> Result<(), Failure> {
    // Days played and passes made are the units; they take about as long.
    let Course { rounds, days, passes, .. } = *study.course();
    let a_round = u64::from(days) + u64::from(passes);
    let progress = Bar::new(u64::from(rounds) * a_round, "days");
    progress.already_done(study.rounds().len() as u64 * a_round);
    let go_on = || {
        progress.advance(1);
        !stop.load(Ordering::Relaxed)
    };
    while !study.is_done() {
        let Some(round) = study.round(&go_on)? else { break };
        progress.say(format!("gain over prices {:.2} %", 100.0 * round.gain));
        files.write(study)?;
    }
    Ok(())
}

fn tell(study: &Study, files: &Files) -> Result<(), Failure> {
    let Some(last) = study.rounds().last() else {
        eprintln!("stopped before the first round was over; nothing is written");
        return Ok(());
    };
    let lines = [
        format!("rounds             {}", last.round),
        format!("decisions          {}", last.decisions),
        format!("validation reward  {:.5}", last.validation_reward),
        format!("gain over prices   {:.2} %", 100.0 * last.gain),
        format!("  random networks  {:.2} %", 100.0 * last.random_gain),
        format!("weights            {}", files.weights.display()),
        format!("learning curve     {}", files.curve.display()),
    ];
    print(&lines.join("\n"))?;
    if !study.is_done() {
        eprintln!("stopped early; --resume goes on from {}", files.checkpoint.display());
    }
    Ok(())
}

fn plan(arguments: &TrainArguments, network: Network) -> Result<Plan, Failure> {
    if arguments.steps.is_some() || arguments.preset != "default" {
        return Err(Failure::usage(
            "--steps and --preset are not for gcaps-x, which learns in rounds".to_owned(),
            "change its settings with --set, as --set rounds=4",
        ));
    }
    let mut course = Course::default();
    course.set(arguments.set.iter().map(|(name, value)| (name.as_str(), value.as_str())))?;
    Ok(Plan {
        network: Arc::new(network),
        policy: Architecture::named("gcaps-x").expect("a policy with sizes"),
        course,
        seed: arguments.seed,
        commit: env!("VERTIFLEET_COMMIT").to_owned(),
    })
}
