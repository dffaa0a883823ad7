//! `vertifleet train`: runs a training, shows how it goes, and leaves weights, curve and checkpoint.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use anstream::{eprintln, println};
use vertifleet_core::Network;
use vertifleet_learn::nn::{Architecture, GcapsSettings, MlpSettings};
use vertifleet_learn::{Checkpoint, CurveRow, EventFile, Plan, Settings, Training, to_csv};

use crate::args::{TrainArguments, Trainable};
use crate::failure::Failure;
use crate::policies::curve_beside;
use crate::progress::Progress;

/// Files of a run, in the folder the user names.
struct Files {
    weights: PathBuf,
    curve: PathBuf,
    checkpoint: PathBuf,
}

impl Files {
    fn of(policy: Trainable, folder: &Path) -> Self {
        let name = match policy {
            Trainable::Gcaps => "gcaps",
            Trainable::Mlp => "mlp",
        };
        let weights = folder.join(format!("{name}.safetensors"));
        Self {
            curve: curve_beside(&weights),
            weights,
            checkpoint: folder.join(format!("{name}-checkpoint.safetensors")),
        }
    }

    /// Leaves the run as it stands; each file is whole at every moment.
    fn write(&self, training: &Training) -> Result<(), Failure> {
        vertifleet_core::write_atomically(&self.curve, to_csv(training.curve()).as_bytes())?;
        training.best_model().write(&self.weights)?;
        training.checkpoint().write(&self.checkpoint)?;
        Ok(())
    }
}

pub(crate) fn run(arguments: &TrainArguments) -> Result<ExitCode, Failure> {
    let plan = plan(arguments)?;
    let settings = plan.settings.clone();
    vertifleet_core::create_folder(&arguments.out)?;
    let files = Files::of(arguments.policy, &arguments.out);
    let mut training = if arguments.resume {
        Training::resume(plan, Checkpoint::read(&files.checkpoint)?)?
    } else {
        Training::start(plan)?
    };
    let stop = stop_on_interrupt()?;
    let mut events = EventFile::create(&arguments.out, unix_seconds() as u64)
        .map_err(|error| Failure::internal(&error))?;

    let progress = Progress::new(settings.updates() * settings.buffer_size() as u64, "steps");
    if let Some(row) = training.curve().last() {
        progress.already_done(row.steps);
    }
    let mut saved = Instant::now();
    while !training.is_done() && !stop.load(Ordering::Relaxed) {
        let begun = Instant::now();
        let row = training.update()?;
        let steps_per_second = settings.buffer_size() as f64 / begun.elapsed().as_secs_f64();
        progress.advance(settings.buffer_size() as u64);
        progress
            .say(format!("{steps_per_second:.0} steps/s, reward {}", reward_text(row.mean_reward)));
        events
            .append(unix_seconds(), &row, steps_per_second)
            .map_err(|error| Failure::internal(&error))?;
        if saved.elapsed().as_secs() >= 30 {
            files.write(&training)?;
            saved = Instant::now();
        }
    }
    progress.finish();
    files.write(&training)?;
    tell(&training, &files, arguments);
    Ok(ExitCode::SUCCESS)
}

fn plan(arguments: &TrainArguments) -> Result<Plan, Failure> {
    let mut settings = Settings::preset(&arguments.preset)?;
    if let Some(steps) = arguments.steps {
        settings.set("total_steps", &steps.to_string())?;
    }
    for (name, value) in &arguments.set {
        settings.set(name, value)?;
    }
    Ok(Plan {
        network: Arc::new(Network::find(&arguments.network)?),
        policy: match arguments.policy {
            Trainable::Gcaps => Architecture::Gcaps(GcapsSettings::default()),
            Trainable::Mlp => Architecture::Mlp(MlpSettings::default()),
        },
        settings,
        seed: arguments.seed,
        commit: env!("VERTIFLEET_COMMIT").to_owned(),
    })
}

/// A flag that Ctrl-C raises; the update under way is finished and everything written. A second Ctrl-C ends at once.
fn stop_on_interrupt() -> Result<Arc<AtomicBool>, Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&stop);
    ctrlc::set_handler(move || {
        if raised.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        eprintln!("\nstopping after this update; press Ctrl-C again to stop at once");
    })
    .map_err(|error| Failure::internal(&error))?;
    Ok(stop)
}

fn unix_seconds() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64())
}

fn tell(training: &Training, files: &Files, arguments: &TrainArguments) {
    let CurveRow { steps, mean_reward, .. } = training.curve().last().copied().unwrap_or_default();
    if !training.is_done() {
        eprintln!(
            "stopped after {steps} steps; --resume goes on from {}",
            files.checkpoint.display()
        );
    }
    println!("steps              {steps}");
    println!("mean reward        {}", reward_text(mean_reward));
    println!("validation reward  {}", reward_text(training.best_validation_reward()));
    println!("weights            {}", files.weights.display());
    println!("learning curve     {}", files.curve.display());
    eprintln!("watch the curve with: tensorboard --logdir {}", arguments.out.display());
}

/// A reward that may not be known yet.
fn reward_text(reward: Option<f64>) -> String {
    reward.map_or_else(|| "not known yet".to_owned(), |reward| format!("{reward:.5}"))
}
