//! `vertifleet train`: runs a training, shows how it goes, and leaves weights, curve and checkpoint.

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use anstream::eprintln;
use vertifleet_core::{DaySeed, Network, Outputs};
use vertifleet_learn::nn::Architecture;
use vertifleet_learn::{
    Checkpoint, CurveRow, EventFile, Model, Plan, Settings, Training, curve_beside, kinds, to_csv,
};
use vertifleet_progress::Bar;

use crate::args::{TrainArguments, Trainable};
use crate::commands::{find_network, train_any, warn_of_days};
use crate::failure::Failure;
use crate::interrupt::stop_on_interrupt;
use crate::output::print;

/// How often a run is set aside while it goes on.
const SECONDS_BETWEEN_SAVES: u64 = 30;

/// Files of a run, in the folder the user names.
struct Files {
    weights: PathBuf,
    curve: PathBuf,
    checkpoint: PathBuf,
    /// TensorBoard takes a folder for a run, so each policy has its own.
    events: PathBuf,
}

impl Files {
    fn of(policy: Trainable, folder: &Path) -> Self {
        let name = policy.name();
        let weights = folder.join(format!("{name}.safetensors"));
        Self {
            curve: curve_beside(&weights),
            weights,
            checkpoint: folder.join(format!("{name}-checkpoint.safetensors")),
            events: folder.join("tensorboard").join(name),
        }
    }

    /// None of them is read for something else, and what is there already is of an earlier run.
    fn claim(&self, outputs: &mut Outputs) -> Result<(), Failure> {
        outputs.writes(&self.weights, &kinds::WEIGHTS)?;
        outputs.writes(&self.curve, &kinds::CURVE)?;
        outputs.writes(&self.checkpoint, &kinds::CHECKPOINT)?;
        Ok(())
    }

    /// Leaves the run as it stood; each file is whole at every moment.
    fn write(&self, run: &SetAside) -> Result<(), Failure> {
        vertifleet_core::write_atomically(&self.curve, to_csv(&run.curve).as_bytes())?;
        run.model.write(&self.weights)?;
        run.checkpoint.write(&self.checkpoint)?;
        Ok(())
    }
}

/// A run between two updates, as its files hold it.
struct SetAside {
    curve: Vec<CurveRow>,
    model: Model,
    checkpoint: Checkpoint,
}

impl SetAside {
    fn of(training: &Training) -> Self {
        Self {
            curve: training.curve().to_vec(),
            model: training.best_model(),
            checkpoint: training.checkpoint(),
        }
    }
}

pub(crate) fn run(arguments: &TrainArguments) -> Result<ExitCode, Failure> {
    if arguments.policy == Trainable::GcapsX {
        return train_any::run(arguments);
    }
    let mut outputs = Outputs::new(arguments.force);
    let network = find_network(&arguments.network, &mut outputs)?;
    warn_of_training(&network, arguments.seed)?;
    let plan = plan(arguments, network)?;
    let files = Files::of(arguments.policy, &arguments.out);
    if arguments.out.exists() && (arguments.resume || !files.checkpoint.exists()) {
        files.claim(&mut outputs)?;
    }
    let mut training = if arguments.resume {
        Training::resume(plan, Checkpoint::read(&files.checkpoint)?)?
    } else if files.checkpoint.exists() {
        return Err(earlier_run(&files.checkpoint));
    } else {
        Training::start(plan)?
    };
    vertifleet_core::create_folder(&arguments.out)?;
    // The update under way is given up then, and the run set aside as it stood before.
    let stop = stop_on_interrupt()?;
    let last = learn(&mut training, &files, &stop)?;
    files.write(&last)?;
    tell(&last, &files, training.best_validation_reward())?;
    if !training.is_done() {
        eprintln!("stopped early; --resume goes on from {}", files.checkpoint.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// Says what looks wrong with the network, by its first training day.
pub(super) fn warn_of_training(network: &Network, seed: u32) -> Result<(), Failure> {
    warn_of_days([&network.draw(DaySeed::training(seed, 0)?)]);
    Ok(())
}

/// A new run would write over the checkpoint of an earlier one.
pub(super) fn earlier_run(checkpoint: &Path) -> Failure {
    Failure::usage(
        format!("{} is there already, of an earlier run", checkpoint.display()),
        "go on with it by --resume, name another folder, or remove the file",
    )
}

/// Learns until all is learned or `stop` is raised. Returns the run as it stood after its last whole update.
fn learn(training: &mut Training, files: &Files, stop: &AtomicBool) -> Result<SetAside, Failure> {
    let settings = training.settings().clone();
    let per_update = settings.buffer_size() as u64;
    let mut events = Events::create(&files.events, training.curve());
    let progress = Bar::new(settings.updates() * per_update, "steps");
    let mut saved = Instant::now();
    let mut last = SetAside::of(training);
    if let Some(row) = last.curve.last() {
        progress.already_done(row.steps);
    }
    while !training.is_done() {
        let begun = Instant::now();
        let shown = Cell::new(0);
        let go_on = |share: f64| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a share of the steps"
            )]
            let steps = (share * per_update as f64) as u64;
            progress.advance(steps.saturating_sub(shown.replace(steps)));
            !stop.load(Ordering::Relaxed)
        };
        let Some(row) = training.update(&go_on)? else { break };
        let steps_per_second = per_update as f64 / begun.elapsed().as_secs_f64();
        progress
            .say(format!("{steps_per_second:.0} steps/s, reward {}", reward_text(row.mean_reward)));
        events.append(&row, steps_per_second);
        last = SetAside::of(training);
        if saved.elapsed().as_secs() >= SECONDS_BETWEEN_SAVES {
            // A disk that is full now may have room again when the run is over.
            if let Err(failure) = files.write(&last) {
                failure.report();
            }
            saved = Instant::now();
        }
    }
    Ok(last)
}

/// TensorBoard's file. A run does not depend on it: where it cannot be written, people are told once.
struct Events(Option<EventFile>);

impl Events {
    fn create(folder: &Path, so_far: &[CurveRow]) -> Self {
        Self(Self::told(EventFile::create(folder, unix_seconds(), so_far)))
    }

    fn append(&mut self, row: &CurveRow, steps_per_second: f64) {
        if let Some(file) = &mut self.0
            && Self::told(file.append(unix_seconds(), row, Some(steps_per_second))).is_none()
        {
            self.0 = None;
        }
    }

    fn told<T>(outcome: Result<T, vertifleet_learn::Error>) -> Option<T> {
        outcome.map_err(|error| eprintln!("warning: no events for TensorBoard: {error}")).ok()
    }
}

fn plan(arguments: &TrainArguments, network: Network) -> Result<Plan, Failure> {
    let mut settings = Settings::preset(&arguments.preset)?;
    let steps = arguments.steps.map(|steps| steps.to_string());
    let steps = steps.iter().map(|steps| ("total_steps", steps.as_str()));
    let named = arguments.set.iter().map(|(name, value)| (name.as_str(), value.as_str()));
    settings.set(steps.chain(named))?;
    Ok(Plan {
        network: Arc::new(network),
        policy: Architecture::named(arguments.policy.name())
            .expect("every kind that can be trained has its sizes"),
        settings,
        seed: arguments.seed,
        commit: env!("VERTIFLEET_COMMIT").to_owned(),
    })
}

fn unix_seconds() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64())
}

fn tell(run: &SetAside, files: &Files, best_reward: Option<f64>) -> Result<(), Failure> {
    let CurveRow { steps, mean_reward, .. } = run.curve.last().copied().unwrap_or_default();
    let lines = [
        format!("steps              {steps}"),
        format!("mean reward        {}", reward_text(mean_reward)),
        format!("validation reward  {}", reward_text(best_reward)),
        format!("weights            {}", files.weights.display()),
        format!("learning curve     {}", files.curve.display()),
    ];
    print(&lines.join("\n"))?;
    eprintln!("watch the curve with: tensorboard --logdir {}", files.events.display());
    Ok(())
}

/// A reward that may not be known yet.
fn reward_text(reward: Option<f64>) -> String {
    reward.map_or_else(|| "not known yet".to_owned(), |reward| format!("{reward:.5}"))
}
