//! `vertifleet train`: runs a training, shows its progress, and writes weights, learning curve and checkpoint.

use std::process::ExitCode;

use anstream::eprintln;
use vertifleet_core::{DaySeed, Outputs, Purpose, World};
use vertifleet_learn::nn::Architecture;
use vertifleet_learn::{
    Curve, Error, RunFolder, TrainingRequest, TrainingRun, TrainingSettings, TrainingWatch,
};
use vertifleet_progress::Bar;

use crate::args::TrainArguments;
use crate::commands::{find_world, warn_of_days};
use crate::failure::Failure;
use crate::interrupt::stop_on_interrupt;
use crate::output::print;

pub(crate) fn run(arguments: &TrainArguments) -> Result<ExitCode, Failure> {
    let mut outputs = Outputs::new(arguments.force);
    let world = find_world(&arguments.network, &mut outputs)?;
    // The first training day stands for all of them in the warnings.
    let seed = DaySeed::training(arguments.seed, 0)?;
    warn_of_days([&world.network(Purpose::Training, seed.get()).draw(seed)]);
    let plan = plan(arguments, world)?;
    let folder = RunFolder::of(&plan.policy, &arguments.out);
    let mut run = folder.begin(plan, arguments.resume, &mut outputs)?;
    let stop = stop_on_interrupt()?;
    let shown = Shown::of(run.as_ref());
    folder.train(run.as_mut(), &stop, &shown)?;
    drop(shown);
    tell(run.as_ref(), &folder)?;
    Ok(ExitCode::SUCCESS)
}

fn plan(arguments: &TrainArguments, world: World) -> Result<TrainingRequest, Failure> {
    let mut policy = Architecture::named(arguments.policy.name())
        .expect("every kind that can be trained has its sizes");
    let mut settings = TrainingSettings::preset(&policy, &arguments.preset)?;
    if arguments.steps.is_some() && matches!(settings, TrainingSettings::Imitation(_)) {
        return Err(Failure::usage(
            "--steps is for PPO, and imitation learns in rounds".to_owned(),
            "change its settings with --set, as --set rounds=4",
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
        self.0.say(match curve {
            Curve::Ppo(rows) => {
                let reward = reward_text(rows.last().and_then(|row| row.mean_reward));
                format!("{steps_per_second:.0} steps/s, reward {reward}")
            }
            Curve::Imitation(rows) => {
                let gain = rows.last().map_or(0.0, |row| row.gain);
                format!("gain over prices {:.2} %", 100.0 * gain)
            }
        });
    }

    fn could_not_write(&self, error: &Error) {
        eprintln!("warning: {error}; the training goes on");
    }
}

/// Prints the results of the run as they stand in its files.
fn tell(run: &dyn TrainingRun, folder: &RunFolder) -> Result<(), Failure> {
    let curve = run.curve();
    let mut rewards = curve.validation_rewards().into_iter().map(|(_, reward)| reward);
    // The validation reward of the weights that were kept.
    let kept = match &curve {
        Curve::Ppo(_) => rewards.reduce(f64::max),
        Curve::Imitation(_) => rewards.next_back(),
    };
    let mut lines = vec![format!("steps              {}", curve.steps())];
    match &curve {
        Curve::Ppo(rows) => {
            let mean = rows.last().and_then(|row| row.mean_reward);
            lines.push(format!("mean reward        {}", reward_text(mean)));
        }
        Curve::Imitation(rows) => {
            if let Some(row) = rows.last() {
                lines.push(format!("gain over prices   {:.2} %", 100.0 * row.gain));
                let random = row.random_gain.map(|gain| 100.0 * gain);
                lines.extend(random.map(|gain| format!("  random networks  {gain:.2} %")));
            }
        }
    }
    lines.extend([
        format!("validation reward  {}", reward_text(kept)),
        format!("weights            {}", folder.weights.display()),
        format!("learning curve     {}", folder.curve.display()),
    ]);
    print(&lines.join("\n"))?;
    eprintln!("watch the curve with: tensorboard --logdir {}", folder.events.display());
    if !run.is_done() {
        eprintln!("stopped early; --resume goes on from {}", folder.checkpoint.display());
    }
    Ok(())
}

/// A reward, or words for one that is not known yet.
fn reward_text(reward: Option<f64>) -> String {
    reward.map_or_else(|| "not known yet".to_owned(), |reward| format!("{reward:.5}"))
}
