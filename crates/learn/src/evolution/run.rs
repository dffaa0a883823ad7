//! A training run by evolution: perturbs the weights, plays days with them, moves towards higher
//! profit, and keeps the weights that did best on the validation days.

use std::path::Path;
use std::sync::Arc;

use rayon::prelude::{IntoParallelIterator, IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};
use vertifleet_core::{Scenario, Stop, World};
use vertifleet_policy::units_usd;
use vertifleet_sim::{DayTotals, Simulation};

use crate::adam::Adam;
use crate::error::Error;
use crate::evolution::direction::Direction;
use crate::evolution::{EvolutionRow, EvolutionSettings};
use crate::header::Header;
use crate::lockstep::play_together;
use crate::model::Model;
use crate::run::begin::{Begin, training_days};
use crate::run::checkpoint::{self, BEST_PARAMS};
use crate::run::{Curve, RunIdentity, TrainingRequest, TrainingRun, Work, check_finite};
use crate::settings::Learner;
use crate::validation::{Validated, ValidationDays, played};

/// A run in progress.
pub(crate) struct EvolutionRun {
    identity: RunIdentity,
    settings: EvolutionSettings,
    /// The header of the run's models, except for the number of steps.
    header: Header,
    world: World,
    validation: ValidationDays,
    params: Vec<f32>,
    adam: Adam,
    progress: Progress,
}

/// The progress of a run as its checkpoint stores it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Progress {
    curve: Vec<EvolutionRow>,
    /// The gain of the weights that did best on the validation days, the decisions until then, and
    /// these weights.
    best_gain: f64,
    best_decisions: u64,
    #[serde(skip)]
    best_params: Vec<f32>,
}

/// The results of days that were played with the weights moved along a direction or against it.
struct DirectionScore {
    /// The sum over the days of profit over the [unit](day_unit_usd) of the day.
    score: f64,
    decisions: u64,
}

impl Learner for EvolutionSettings {
    fn curve_opening(&self) -> &'static str {
        "generation,decisions,difference,"
    }

    fn begin(
        &self,
        plan: &TrainingRequest,
        identity: RunIdentity,
        from: Option<&Path>,
    ) -> Result<Box<dyn TrainingRun>, Error> {
        let Begin { header, params, adam, checkpoint, .. } =
            Begin::of(plan, &identity, self.random_share, from)?;
        let mut progress = Progress {
            curve: Vec::new(),
            best_gain: f64::NEG_INFINITY,
            best_decisions: 0,
            best_params: params.clone(),
        };
        if let Some(checkpoint) = checkpoint {
            let best_params = checkpoint.best_params()?;
            progress = Progress { best_params, ..checkpoint.progress };
        }
        let numbers = progress.curve.iter().map(|row| row.generation);
        checkpoint::check_steps("generations", numbers, self.generations)?;
        let is_done = progress.curve.len() >= self.generations as usize;
        // A finished run measures nothing more, and playing `prices` on the validation days takes
        // time.
        let days = if is_done { 0 } else { self.validation_days };
        let validation = ValidationDays::of(&plan.world, days, plan.policy.fits_any_size())?;
        let world = plan.world.clone();
        let mut run = EvolutionRun {
            identity,
            settings: *self,
            header,
            world,
            validation,
            params,
            adam,
            progress,
        };
        if from.is_none() {
            // Weights that a run begins with are kept until others are better.
            run.progress.best_gain = mean_gain(run.validation.measure(&run.model()));
        }
        Ok(Box::new(run))
    }
}

impl EvolutionRun {
    fn generations_done(&self) -> u32 {
        u32::try_from(self.progress.curve.len()).expect("a run has saturating_count generations")
    }

    /// Plays a generation and takes a step. After [`Error::Stopped`], nothing is undone.
    fn generation(
        &mut self,
        stop: &Stop,
        worked: &(dyn Fn(u64) + Sync),
    ) -> Result<EvolutionRow, Error> {
        let done = self.generations_done();
        let seed = u64::from(self.identity.seed) << 32 | u64::from(done);
        let days = self.days()?;
        let played = self.played(seed, &days, stop, worked)?;
        let differences: Vec<f64> =
            played.iter().map(|[along, against]| along.score - against.score).collect();
        let pairs = differences.len() as f64;
        let root = (differences.iter().map(|difference| difference * difference).sum::<f64>()
            / pairs)
            .sqrt();
        if root > 0.0 {
            self.step(seed, &differences, root);
        }
        check_finite(&self.params, u64::from(done) + 1)?;
        let all = played.iter().flatten();
        let mean = all.clone().map(|played| played.score).sum::<f64>() / (2.0 * pairs);
        let decisions = self.decisions() + all.map(|played| played.decisions).sum::<u64>();
        let mut row = EvolutionRow {
            generation: done + 1,
            decisions,
            difference: share_of(root, mean),
            ..EvolutionRow::default()
        };
        let is_last = row.generation == self.settings.generations;
        if is_last || row.generation.is_multiple_of(self.settings.eval_every) {
            let found = self.validation.measure(&self.model_of(&self.params, decisions));
            row.validation_reward = Some(found.reward);
            row.gain = Some(found.gain);
            row.random_gain = found.random_gain;
            if mean_gain(found) > self.progress.best_gain {
                self.progress.best_gain = mean_gain(found);
                self.progress.best_decisions = decisions;
                self.progress.best_params.copy_from_slice(&self.params);
            }
        }
        Ok(row)
    }

    /// The days of the next generation, with days of the same number of vertiports next to each
    /// other.
    fn days(&self) -> Result<Vec<Arc<Scenario>>, Error> {
        let (round, EvolutionSettings { days, random_share, .. }) =
            (self.generations_done(), self.settings);
        let mut days = training_days(&self.world, self.identity.seed, random_share, (round, days))?;
        days.sort_by_key(|day| day.vertiports.len());
        Ok(days)
    }

    /// Plays the days with the weights moved along each direction and against it.
    fn played(
        &self,
        seed: u64,
        days: &[Arc<Scenario>],
        stop: &Stop,
        worked: &(dyn Fn(u64) + Sync),
    ) -> Result<Vec<[DirectionScore; 2]>, Error> {
        let units_usd: Vec<f64> = days.par_iter().map(day_unit_usd).collect();
        let moved = |pair: u32, length: f32| -> Result<DirectionScore, Error> {
            stop.check()?;
            let mut params = self.params.clone();
            Direction { seed, pair: pair.into() }.add_to(&mut params, length);
            let totals = play_days(&self.model_of(&params, 0), days);
            worked(days.len() as u64);
            let scores = totals.iter().zip(&units_usd).map(|(day, unit)| day.profit_usd / unit);
            let decisions = totals.iter().map(|day| u64::from(day.decisions)).sum();
            Ok(DirectionScore { score: scores.sum(), decisions })
        };
        (0..self.settings.pairs)
            .into_par_iter()
            .map(|pair| {
                let noise = self.settings.noise;
                let (along, against) = rayon::join(|| moved(pair, noise), || moved(pair, -noise));
                Ok([along?, against?])
            })
            .collect()
    }

    /// Takes a step of Adam. Each direction counts in proportion to how much more the days along it
    /// earned than those against it, divided by the root mean square of these differences.
    fn step(&mut self, seed: u64, differences: &[f64], root: f64) {
        let mut slopes = vec![0.0; self.params.len()];
        for (pair, difference) in (0..).zip(differences) {
            let length = -(difference / root / differences.len() as f64) as f32;
            Direction { seed, pair }.add_to(&mut slopes, length);
        }
        let share = f64::from(self.generations_done()) / f64::from(self.settings.generations);
        let learning_rate = self.settings.learning_rate * (1.0 - 0.9 * share) as f32;
        self.adam.step(&mut self.params, &slopes, learning_rate);
    }

    fn decisions(&self) -> u64 {
        self.progress.curve.last().map_or(0, |row| row.decisions)
    }

    fn model_of(&self, params: &[f32], decisions: u64) -> Model {
        Model::new(self.header.after(decisions), params.to_vec())
            .expect("a run has checked all of this")
    }
}

impl TrainingRun for EvolutionRun {
    fn is_done(&self) -> bool {
        self.generations_done() >= self.settings.generations
    }

    fn work(&self) -> Work {
        let EvolutionSettings { generations, pairs, days, .. } = self.settings;
        let a_generation = 2 * u64::from(pairs) * u64::from(days);
        Work {
            done: u64::from(self.generations_done()) * a_generation,
            total: u64::from(generations) * a_generation,
            units: "days",
        }
    }

    fn advance(&mut self, stop: &Stop, worked: &(dyn Fn(u64) + Sync)) -> Result<(), Error> {
        let row = self.generation(stop, worked)?;
        self.progress.curve.push(row);
        Ok(())
    }

    fn curve(&self) -> Curve {
        Curve::of(&self.progress.curve)
    }

    fn model(&self) -> Model {
        self.model_of(&self.progress.best_params, self.progress.best_decisions)
    }

    fn write_checkpoint(&self, path: &Path) -> Result<(), Error> {
        let best = [(BEST_PARAMS.to_owned(), self.progress.best_params.as_slice())];
        checkpoint::write(path, &self.identity, &self.params, &self.adam, &self.progress, best)
    }
}

/// The gain by which weights are kept: the mean of those on the network's days and on days of
/// random networks.
fn mean_gain(found: Validated) -> f64 {
    found.random_gain.map_or(found.gain, |random| f64::midpoint(found.gain, random))
}

/// A difference in score as a share of the mean score; 0 where nothing is earned, because a
/// checkpoint must contain finite numbers.
fn share_of(difference: f64, mean: f64) -> f64 {
    if mean == 0.0 { 0.0 } else { difference / mean.abs() }
}

/// The profit of a typical full flight of every aircraft of a day, dollars. Profits are divided by
/// it, so that days of large and of small fleets have equal weight.
fn day_unit_usd(day: &Arc<Scenario>) -> f64 {
    let simulation = Simulation::new(Arc::clone(day));
    let units_usd = units_usd(simulation.view());
    day.aircraft.iter().map(|aircraft| units_usd[aircraft.kind.at()]).sum()
}

/// Plays days, of which those with the same number of vertiports are next to each other.
fn play_days(model: &Model, days: &[Arc<Scenario>]) -> Vec<DayTotals> {
    let mut policy = model.policy(1);
    // It caches the prices of one day at a time.
    if model.header().policy.observation().is_priced() {
        return days.iter().map(|day| played(policy.as_mut(), day)).collect();
    }
    days.chunk_by(|one, other| one.vertiports.len() == other.vertiports.len())
        .flat_map(|days| play_together(policy.as_mut(), days))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::share_of;

    #[test]
    fn a_generation_that_earns_nothing_has_a_finite_row() {
        assert_eq!(share_of(0.5, -2.0), 0.25);
        assert_eq!(share_of(0.5, 0.0), 0.0);
    }
}
