//! Measures how far the features of §IV.A suffice without a network of layers: a table of 72
//! numbers is learned by an evolution strategy.
//!
//! An aircraft at i scores each feasible j by the flight's profit per hour, plus a number of the
//! pair, plus a number of j times U_j. The networks of layers see all of these inputs and more,
//! except for the demand of a single pair, which hardly ever binds on `paper`. The reward that the
//! table reaches on validation days is therefore within their reach, and where they earn less, the
//! learning is at fault and not the features. (Salimans et al. 2017, "Evolution strategies as a
//! scalable alternative to reinforcement learning".)
//!
//! Run: `cargo run --release -p vertifleet-policy --example table`

use std::sync::Arc;

use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::SplitMix64;
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use vertifleet_core::{DaySeed, Network, Scenario, VertiportIx};
use vertifleet_policy::{Policy, PolicyError, play};
use vertifleet_sim::{Decision, Simulation, View};

const GENERATIONS: usize = 600;
/// Number of directions tried in a generation, each forwards and backwards.
const DIRECTIONS: usize = 64;
const DAYS_A_GENERATION: usize = 16;
const TRAINING_DAYS: u64 = 2_000;
const VALIDATION_DAYS: u64 = 100;
/// Length of a step in a trial direction; scores are profits per hour in hundreds of dollars.
const SPREAD: f64 = 0.08;
const STEP: f64 = 0.06;
const MOMENTUM: f64 = 0.8;

/// One number for each pair, row by row, then one for each vertiport.
#[derive(Clone)]
struct Table {
    vertiports: usize,
    numbers: Vec<f64>,
}

impl Table {
    fn score(&self, decision: &Decision, view: View<'_>, to: VertiportIx) -> f64 {
        let from = decision.at;
        let (pairs, crowds) = self.numbers.split_at(self.vertiports * self.vertiports);
        let taken = f64::from(view.stands_taken()[to.at()]) - f64::from(view.stands(to));
        let score = pairs[from.at() * self.vertiports + to.at()] + crowds[to.at()] * taken;
        if to == from {
            return score;
        }
        let kind = view.kind(decision.aircraft);
        let waiting = view.demand_left(view.period(), from, to);
        let profit_usd = view.flight_profit_usd(decision.time, kind, (from, to), waiting);
        let hours = f64::from(view.leg(kind, from, to).block_s()) / 3600.0;
        score + profit_usd / hours / 100.0
    }
}

impl Policy for Table {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let scored = view.feasible(decision).iter().map(|to| (self.score(decision, *view, to), to));
        let best = scored.max_by(|(one, _), (other, _)| one.total_cmp(other));
        Ok(best.expect("hold is always feasible").1)
    }
}

fn mean_reward(table: &Table, days: &[Arc<Scenario>]) -> f64 {
    let reward = |day: &Arc<Scenario>| {
        let mut simulation = Simulation::new(Arc::clone(day));
        play(&mut simulation, &mut table.clone(), |_| ()).expect("a table always has an answer");
        simulation.totals().reward
    };
    days.iter().map(reward).sum::<f64>() / days.len() as f64
}

fn moved(table: &Table, direction: &[f64], by: f64) -> Table {
    let numbers = table.numbers.iter().zip(direction).map(|(number, part)| number + by * part);
    Table { vertiports: table.vertiports, numbers: numbers.collect() }
}

/// The slope of the mean reward in every number, in units of the rewards' standard deviation.
fn slope(table: &Table, days: &[Arc<Scenario>], rng: &mut SplitMix64) -> Vec<f64> {
    let mut draw = || StandardNormal.sample(rng);
    let directions: Vec<Vec<f64>> =
        (0..DIRECTIONS).map(|_| table.numbers.iter().map(|_| draw()).collect()).collect();
    let rewards: Vec<[f64; 2]> = directions
        .par_iter()
        .map(|way| [SPREAD, -SPREAD].map(|by| mean_reward(&moved(table, way, by), days)))
        .collect();
    let count = (2 * DIRECTIONS) as f64;
    let mean = rewards.iter().flatten().sum::<f64>() / count;
    let squares = rewards.iter().flatten().map(|reward| (reward - mean).powi(2)).sum::<f64>();
    let spread = (squares / count).sqrt().max(f64::MIN_POSITIVE);
    let mut slope = vec![0.0; table.numbers.len()];
    for (direction, [forwards, backwards]) in directions.iter().zip(&rewards) {
        for (sum, part) in slope.iter_mut().zip(direction) {
            *sum += (forwards - backwards) / spread / count * part;
        }
    }
    slope
}

fn main() {
    let network = Network::shipped("paper").expect("a shipped network");
    let training: Vec<_> = (0..TRAINING_DAYS)
        .map(|day| network.draw(DaySeed::training(1, day).expect("a training seed")))
        .map(Arc::new)
        .collect();
    let validation: Vec<_> = (0..VALIDATION_DAYS)
        .map(|day| network.draw(DaySeed::validation(day).expect("a validation seed")))
        .map(Arc::new)
        .collect();
    let vertiports = network.vertiports().len();
    let mut table = Table { vertiports, numbers: vec![0.0; vertiports * (vertiports + 1)] };
    let mut momentum = vec![0.0; table.numbers.len()];
    let mut rng = SplitMix64::seed_from_u64(1);
    println!("generation,validation_reward");
    println!("0,{:.5}", mean_reward(&table, &validation));
    for generation in 1..=GENERATIONS {
        let first = generation * DAYS_A_GENERATION % (training.len() - DAYS_A_GENERATION);
        let slope = slope(&table, &training[first..][..DAYS_A_GENERATION], &mut rng);
        let step = STEP * (1.0 - generation as f64 / GENERATIONS as f64);
        for ((number, momentum), slope) in table.numbers.iter_mut().zip(&mut momentum).zip(slope) {
            *momentum = MOMENTUM * *momentum + (1.0 - MOMENTUM) * slope;
            *number += step * *momentum;
        }
        if generation % 50 == 0 {
            println!("{generation},{:.5}", mean_reward(&table, &validation));
        }
    }
}
