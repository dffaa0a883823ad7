//! `vertifleet train`: runs a training, shows its progress, and writes weights, learning curve and
//! checkpoint.

use std::process::ExitCode;

use anstream::eprintln;
use vertifleet_core::{DaySeed, Outputs, Purpose, World};
use vertifleet_learn::{
    Curve, Error, Model, RunFolder, TrainingRequest, TrainingRun, TrainingSettings, TrainingWatch,
};
use vertifleet_progress::Bar;

use crate::args::TrainArguments;
use crate::commands::{resolve_network, warn_of_purpose, warn_unserved_days};
use crate::failure::Failure;
use crate::interrupt::stop_on_interrupt;
use crate::output::print;

pub(crate) fn run(arguments: &TrainArguments) -> Result<ExitCode, Failure> {
    let mut outputs = Outputs::new(arguments.force);
    let world = resolve_network(&arguments.network, &mut outputs)?;
    if let World::Network(network) = &world {
        warn_of_purpose(network, Purpose::Training);
    }
    // The first training day stands for all of them in the warnings.
    let seed = DaySeed::training(arguments.seed, 0)?;
    warn_unserved_days([&world.network(Purpose::Training, seed.get()).draw(seed)]);
    let plan = plan(arguments, world, &mut outputs)?;
    let folder = RunFolder::of(&plan.policy, &arguments.out);
    let mut run = folder.begin(plan, arguments.resume, &mut outputs)?;
    let stop = stop_on_interrupt()?;
    let shown = Shown::of(run.as_ref());
    folder.train(run.as_mut(), &stop, &shown)?;
    drop(shown);
    print_summary(run.as_ref(), &folder)?;
    Ok(ExitCode::SUCCESS)
}

fn plan(
    arguments: &TrainArguments,
    world: World,
    outputs: &mut Outputs,
) -> Result<TrainingRequest, Failure> {
    let begin_with = arguments.begin_with.as_deref().map(|path| {
        outputs.reads(path);
        Model::read(path)
    });
    let begin_with = begin_with.transpose()?;
    let mut policy = vertifleet_learn::sizes(arguments.policy.name(), begin_with.as_ref())
        .expect("every kind that can be trained has its sizes");
    let mut settings = TrainingSettings::preset(&policy, &arguments.preset)?;
    if arguments.steps.is_some() && !settings.has("total_steps") {
        return Err(Failure::usage(
            "--steps is for PPO; imitation learns in rounds, and evolution in generations"
                .to_owned(),
            "change their settings with --set, as --set rounds=4",
        ));
    }
    let steps = arguments.steps.map(|steps| steps.to_string());
    let steps = steps.iter().map(|steps| ("total_steps", steps.as_str()));
    let named = arguments.set.iter().map(|(name, value)| (name.as_str(), value.as_str()));
    vertifleet_learn::set(&mut policy, &mut settings, steps.chain(named))?;
    Ok(TrainingRequest {
        world,
        policy,
        settings,
        seed: arguments.seed,
        begin_with,
        commit: env!("VERTIFLEET_COMMIT").to_owned(),
    })
}

/// Shows the progress of a run on the terminal.
struct Shown(Bar);

impl Shown {
    fn of(run: &dyn TrainingRun) -> Self {
        let work = run.work();
        let bar = Bar::new(work.total, work.units);
        bar.already_done(work.done);
        Self(bar)
    }
}

impl TrainingWatch for Shown {
    fn has_worked(&self, units: u64) {
        self.0.advance(units);
    }

    fn has_learned(&self, curve: &Curve, steps_per_second: f64) {
        let shown = SHOWN.iter().find_map(|column| Some((column, column.last(curve)?)));
        let speed = format!("{steps_per_second:.0} decisions/s");
        self.0.show_message(match shown {
            Some((column, number)) => {
                format!("{speed}, {} {}", column.label.trim(), (column.text)(number))
            }
            None => speed,
        });
    }

    fn could_not_write(&self, error: &Error) {
        eprintln!("warning: {error}; the training continues");
    }
}

/// Prints the current results of the run, as its files contain them.
fn print_summary(run: &dyn TrainingRun, folder: &RunFolder) -> Result<(), Failure> {
    let (curve, kept) = (run.curve(), run.model().header().steps);
    let mut lines = vec![format!("{:<18} {}", "steps", curve.steps())];
    let measured = SHOWN.iter().filter_map(|column| Some((column, column.last(&curve)?)));
    lines.extend(
        measured.map(|(column, number)| format!("{:<18} {}", column.label, (column.text)(number))),
    );
    // The validation reward of the weights that were kept.
    let rewards = curve.validation_rewards();
    let reward = rewards.iter().find(|&&(steps, _)| steps == kept);
    let reward =
        reward.map_or_else(|| "not known yet".to_owned(), |&(_, reward)| reward_text(reward));
    lines.extend([
        format!("validation reward  {reward}"),
        format!("weights            {}", folder.weights.display()),
        format!("learning curve     {}", folder.curve.display()),
    ]);
    print(&lines.join("\n"))?;
    eprintln!("watch the curve with: tensorboard --logdir {}", folder.events.display());
    if !run.is_done() {
        eprintln!("stopped early; --resume continues from {}", folder.checkpoint.display());
    }
    Ok(())
}

/// A column of learning curves that is printed.
struct ShownColumn {
    name: &'static str,
    label: &'static str,
    text: fn(f64) -> String,
}

/// The columns that are printed, if a curve has them.
const SHOWN: [ShownColumn; 3] = [
    ShownColumn { name: "mean_reward", label: "mean reward", text: reward_text },
    ShownColumn { name: "gain", label: "gain over prices", text: share_text },
    ShownColumn { name: "random_gain", label: "  random networks", text: share_text },
];

impl ShownColumn {
    /// The latest measured value.
    fn last(&self, curve: &Curve) -> Option<f64> {
        curve.measured(self.name).last().map(|&(_, number)| number)
    }
}

fn reward_text(reward: f64) -> String {
    format!("{reward:.5}")
}

fn share_text(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}
