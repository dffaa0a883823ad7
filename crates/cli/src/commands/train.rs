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
use crate::commands::{resolve_network, warn_unserved_days};
use crate::failure::Failure;
use crate::interrupt::stop_on_interrupt;
use crate::output::print;

pub(crate) fn run(arguments: &TrainArguments) -> Result<ExitCode, Failure> {
    let mut outputs = Outputs::new(arguments.force);
    let world = resolve_network(&arguments.network, &mut outputs)?;
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
    if arguments.steps.is_some() && !matches!(settings, TrainingSettings::Ppo(_)) {
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
        self.0.say(match curve {
            Curve::Ppo(rows) => {
                let reward = reward_text(rows.last().and_then(|row| row.mean_reward));
                format!("{steps_per_second:.0} steps/s, reward {reward}")
            }
            Curve::Imitation(rows) => {
                let gain = rows.last().map_or(0.0, |row| row.gain);
                format!("gain over prices {:.2} %", 100.0 * gain)
            }
            Curve::Evolution(rows) => {
                let measured = rows.iter().rev().find_map(|row| row.gain);
                measured.map_or_else(
                    || format!("{steps_per_second:.0} decisions/s"),
                    |gain| format!("gain over prices {:.2} %", 100.0 * gain),
                )
            }
        });
    }

    fn could_not_write(&self, error: &Error) {
        eprintln!("warning: {error}; the training goes on");
    }
}

/// Prints the results of the run as they stand in its files.
fn print_summary(run: &dyn TrainingRun, folder: &RunFolder) -> Result<(), Failure> {
    let curve = run.curve();
    let mut rewards = curve.validation_rewards().into_iter().map(|(_, reward)| reward);
    // The validation reward of the weights that were kept.
    let kept = match &curve {
        Curve::Ppo(_) | Curve::Evolution(_) => rewards.reduce(f64::max),
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
        Curve::Evolution(rows) => {
            let gain = |gain: Option<f64>| {
                gain.map_or_else(
                    || "not known yet".to_owned(),
                    |gain| format!("{:.2} %", 100.0 * gain),
                )
            };
            let last = rows.iter().rev().find(|row| row.gain.is_some());
            lines.push(format!(
                "gain over prices   {} (last measured)",
                gain(last.and_then(|row| row.gain))
            ));
            if let Some(random) = last.and_then(|row| row.random_gain) {
                lines.push(format!("  random networks  {}", gain(Some(random))));
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
