//! The buffer that PPO learns from: the current policy plays many days in parallel, and every
//! decision is recorded.
//!
//! Days are split into groups of fixed size. A group plays in lockstep, with one inference per step
//! for all of its days, and groups play in parallel. All randomness is a function of run seed, day
//! and decision, so nothing depends on the number of threads, and a checkpoint can store a day in
//! progress by its number and its choices alone.

use std::sync::Arc;

use rayon::prelude::{IntoParallelRefMutIterator, ParallelIterator};
use serde::{Deserialize, Serialize};
use vertifleet_core::{DaySeed, FeatureScales, Purpose, VertiportIx, World};
use vertifleet_observe::Writer;
use vertifleet_policy::draw;
use vertifleet_sim::{Decision, Simulation};

use crate::error::Error;
use crate::nn::{self, Weights, Workspace};
use crate::ppo::PpoSettings;
use crate::rows::Rows;

/// Number of days that share one inference: large enough for the matrix products, small enough for
/// the cache.
const GROUP: usize = 32;

/// The source of training days and of the randomness of choices.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    pub(crate) world: World,
    pub(crate) run_seed: u32,
}

impl Source {
    fn day(&self, number: u64) -> Result<Simulation, Error> {
        let seed = DaySeed::training(self.run_seed, number)?;
        let network = self.world.network(Purpose::Training, seed.get());
        Ok(Simulation::new(Arc::new(network.draw(seed))))
    }

    /// The divisors of the features, the same on all networks of a world.
    fn scales(&self) -> FeatureScales {
        self.world.network(Purpose::Training, 0).feature_scales()
    }

    /// A random number in [0, 1) that depends only on run, training day and decision.
    fn uniform(&self, day: u64, decision: u32) -> f32 {
        let bits = draw(u64::from(self.run_seed), day, decision);
        // A single-precision number in [0, 1) can hold only the upper 24 bits.
        (bits >> 40) as f32 * (1.0 / 16_777_216.0)
    }
}

/// A day in progress, as a checkpoint stores it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct DayInProgress {
    pub(crate) number: u64,
    pub(crate) choices: Vec<u16>,
}

/// A day being played.
struct PlayedDay {
    progress: DayInProgress,
    simulation: Simulation,
}

impl PlayedDay {
    fn resume(source: &Source, progress: DayInProgress) -> Result<Self, Error> {
        let mut simulation = source.day(progress.number)?;
        for &choice in &progress.choices {
            simulation.apply(VertiportIx(choice)).map_err(|refusal| Error::BadCheckpoint {
                rule: format!("day {} does not replay: {refusal}", progress.number),
            })?;
        }
        if simulation.next_decision().is_none() {
            let rule = format!("day {} is over and not in progress", progress.number);
            return Err(Error::BadCheckpoint { rule });
        }
        Ok(Self { progress, simulation })
    }

    /// The next decision; the day must not be over.
    fn decision(&mut self) -> Decision {
        self.simulation
            .next_decision()
            .expect("a day that is over has been replaced by the next one")
    }
}

/// The recorded decisions of a group of days: `n_steps` of each day, day by day.
pub(crate) struct Experience {
    pub(crate) observations: Rows,
    pub(crate) choices: Vec<u16>,
    pub(crate) log_probabilities: Vec<f32>,
    pub(crate) values: Vec<f32>,
    pub(crate) rewards: Vec<f32>,
    pub(crate) day_ends: Vec<bool>,
    /// The value after the last decision of each day.
    pub(crate) last_values: Vec<f32>,
}

/// Some days that are played in lockstep, and their recorded decisions.
pub(crate) struct Group {
    days: Vec<PlayedDay>,
    pub(crate) experience: Experience,
    writer: Writer,
    /// The features of the current decision of each day.
    present: Rows,
    workspace: Workspace,
    /// The reward of each day that has finished since the last update.
    finished: Vec<f64>,
}

/// All days of a training run that are being played, and the decisions recorded since the last
/// update.
pub(crate) struct Buffer {
    settings: PpoSettings,
    pub(crate) groups: Vec<Group>,
}

impl Buffer {
    /// Starts `n_envs` days, or continues the ones given.
    pub(crate) fn new(
        source: &Source,
        net: &nn::NeuralNetwork,
        settings: &PpoSettings,
        days: Option<Vec<DayInProgress>>,
    ) -> Result<Self, Error> {
        let fresh = |number| DayInProgress { number, choices: Vec::new() };
        let days = days.unwrap_or_else(|| (0..settings.n_envs as u64).map(fresh).collect());
        if days.len() != settings.n_envs {
            let rule =
                format!("{} days in progress, but n_envs is {}", days.len(), settings.n_envs);
            return Err(Error::BadCheckpoint { rule });
        }
        let mut played = Vec::with_capacity(days.len());
        for progress in days {
            played.push(PlayedDay::resume(source, progress)?);
        }
        let scales = source.scales();
        let mut groups = Vec::new();
        while !played.is_empty() {
            let rest = played.split_off(played.len().min(GROUP));
            groups.push(Group::new(played, net, scales, settings.n_steps));
            played = rest;
        }
        Ok(Self { settings: settings.clone(), groups })
    }

    /// Plays `n_steps` decisions of every day. Returns the rewards of the days that ended, in a
    /// fixed order.
    pub(crate) fn collect(
        &mut self,
        source: &Source,
        net: &nn::NeuralNetwork,
        weights: &Weights,
    ) -> Result<Vec<f64>, Error> {
        let Self { settings, groups } = self;
        groups
            .par_iter_mut()
            .map(|group| group.collect(source, settings, net, weights))
            .collect::<Result<Vec<()>, Error>>()?;
        Ok(groups.iter().flat_map(|group| group.finished.iter().copied()).collect())
    }

    /// The days in progress, as a checkpoint stores them.
    pub(crate) fn days(&self) -> Vec<DayInProgress> {
        self.groups.iter().flat_map(|group| &group.days).map(|day| day.progress.clone()).collect()
    }

    /// Finds a decision that is counted over the whole buffer: its group's experience and its row
    /// there.
    pub(crate) fn locate(&self, decision: usize) -> (&Experience, usize) {
        let rows = GROUP * self.settings.n_steps;
        (&self.groups[decision / rows].experience, decision % rows)
    }
}

impl Group {
    fn new(
        days: Vec<PlayedDay>,
        net: &nn::NeuralNetwork,
        scales: FeatureScales,
        n_steps: usize,
    ) -> Self {
        let present = Rows::new(net.architecture(), net.shape().vertiports);
        let rows = days.len() * n_steps;
        let mut observations = present.clone();
        observations.resize(rows);
        let experience = Experience {
            observations,
            choices: vec![0; rows],
            log_probabilities: vec![0.0; rows],
            values: vec![0.0; rows],
            rewards: vec![0.0; rows],
            day_ends: vec![false; rows],
            last_values: vec![0.0; days.len()],
        };
        Self {
            writer: net.architecture().writer(Some(scales)),
            present,
            workspace: net.workspace(days.len()),
            finished: Vec::new(),
            experience,
            days,
        }
    }

    fn collect(
        &mut self,
        source: &Source,
        settings: &PpoSettings,
        net: &nn::NeuralNetwork,
        weights: &Weights,
    ) -> Result<(), Error> {
        self.finished.clear();
        for step in 0..settings.n_steps {
            self.observe();
            net.forward(weights, self.present.inputs(), &mut self.workspace);
            for at in 0..self.days.len() {
                self.step(at, at * settings.n_steps + step, source, settings)?;
            }
        }
        self.observe();
        net.forward(weights, self.present.inputs(), &mut self.workspace);
        self.experience.last_values.copy_from_slice(self.workspace.values());
        Ok(())
    }

    fn observe(&mut self) {
        self.present.clear();
        for day in &mut self.days {
            let decision = day.decision();
            let view = day.simulation.view();
            self.present.push(|row| self.writer.write(view, &decision, None, row));
        }
    }

    /// Decides for one day and records the decision in row `row`.
    fn step(
        &mut self,
        at: usize,
        row: usize,
        source: &Source,
        settings: &PpoSettings,
    ) -> Result<(), Error> {
        let Self { days, experience, present, workspace, finished, .. } = self;
        let day = &mut days[at];
        let decision = day.decision();
        let vertiports = day.simulation.scenario().vertiports.len();
        let logits = &workspace.logits()[at * vertiports..][..vertiports];
        let uniform = source.uniform(day.progress.number, decision.index);
        let (choice, log_probability) = sample(logits, uniform);

        let outcome = day.simulation.apply(choice).expect("the choice was drawn from the mask");
        day.progress.choices.push(choice.0);
        let over = day.simulation.next_decision().is_none();
        let reward = settings.reward.of(&outcome, &day.simulation, over);

        experience.observations.copy(row, present, at);
        experience.choices[row] = choice.0;
        experience.log_probabilities[row] = log_probability;
        experience.values[row] = workspace.values()[at];
        experience.rewards[row] = reward as f32 * settings.reward_scale;
        experience.day_ends[row] = over;
        if over {
            finished.push(day.simulation.totals().reward);
            let number = day.progress.number + settings.n_envs as u64;
            *day = PlayedDay::resume(source, DayInProgress { number, choices: Vec::new() })?;
        }
        Ok(())
    }
}

/// Draws from the softmax of the logits with `uniform`, a number in [0, 1). Returns the choice and
/// the logarithm of its probability. Masked vertiports have a logit of minus infinity, so their
/// probability is 0.
fn sample(logits: &[f32], uniform: f32) -> (VertiportIx, f32) {
    let highest = nn::maximum(logits.iter().copied());
    let total: f32 = logits.iter().map(|logit| (logit - highest).exp()).sum();
    let mut left = uniform * total;
    let mut chosen = None;
    for (at, logit) in logits.iter().enumerate() {
        let weight = (logit - highest).exp();
        if weight > 0.0 {
            chosen = Some(at);
            if left < weight {
                break;
            }
            left -= weight;
        }
    }
    // Rounding may leave a small remainder after the last weight; then the last vertiport with any
    // weight is chosen.
    let at = chosen.expect("hold is always feasible");
    (VertiportIx::new(at), logits[at] - highest - total.ln())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use vertifleet_core::Network;

    use super::{DayInProgress, Group, PlayedDay, Source, sample};
    use crate::nn::{Architecture, GcapsSettings};
    use crate::ppo::{PpoSettings, Reward};

    /// Days of `paper` with costs of flights and aircraft.
    fn source() -> Source {
        let network = Network::shipped("paper").expect("a shipped network");
        let costs = [("flight_cost_usd", 20), ("aircraft_cost_usd_per_day", 100)];
        let costs: Vec<(String, serde_json::Value)> =
            costs.map(|(member, usd)| (format!("tariffs.{member}"), usd.into())).into();
        let network = network.changed(costs.iter().map(|(path, usd)| (path, usd)));
        let network = network.expect("a network");
        Source { world: Arc::new(network).into(), run_seed: 5 }
    }

    /// The rewards of one day's first 600 decisions, which are more than a day has, and the index
    /// at which the day ends.
    fn rewards(reward: Reward) -> (Vec<f32>, usize) {
        let source = source();
        let mut settings = PpoSettings::tuned();
        (settings.n_envs, settings.n_steps) = (1, 600);
        (settings.reward, settings.reward_scale) = (reward, 1.0);
        let architecture = Architecture::Gcaps(GcapsSettings::of_sizes(16, 2));
        let net = architecture.network(8);
        let weights = net.weights(net.init(1));
        let day = DayInProgress { number: 0, choices: Vec::new() };
        let day = PlayedDay::resume(&source, day).expect("a training day");
        let mut group = Group::new(vec![day], &net, source.scales(), settings.n_steps);
        group.collect(&source, &settings, &net, &weights).expect("days are left");
        let end = group.experience.day_ends.iter().position(|&end| end).expect("the day ends");
        (group.experience.rewards, end)
    }

    #[test]
    fn dense_rewards_sum_to_the_terminal_reward() {
        let (dense, end) = rewards(Reward::Dense);
        let (terminal, same_end) = rewards(Reward::Terminal);
        assert_eq!(end, same_end);
        assert!(terminal[..end].iter().all(|&reward| reward == 0.0));
        let sum: f32 = dense[..=end].iter().sum();
        assert!((sum - terminal[end]).abs() < 1e-6, "{sum} is not {}", terminal[end]);
    }

    #[test]
    fn choices_have_the_frequencies_of_the_softmax() {
        let logits = [0.3, f32::NEG_INFINITY, -1.0, 2.0];
        let total: f32 = logits.iter().map(|logit: &f32| logit.exp()).sum();
        let draws = 100_000;
        let mut counts = [0_u32; 4];
        for draw in 0..draws {
            let (choice, log_probability) = sample(&logits, draw as f32 / draws as f32);
            counts[choice.at()] += 1;
            let expected = logits[choice.at()] - total.ln();
            assert!((log_probability - expected).abs() < 1e-5);
        }
        for (logit, count) in logits.iter().zip(counts) {
            let share = count as f32 / draws as f32;
            assert!((share - logit.exp() / total).abs() < 1e-4, "{share} of {logit}");
        }
    }
}
