//! Good prices, found step by step: a proximal bundle method, with a bundle of ways for each group of like aircraft.
//!
//! Around the best prices so far, the model (`master.rs`) finds prices that would be better if the ways known so far were all
//! there are, and says what they promise. They are evaluated; the ways that are worth most at them are ways that the model did
//! not know, and from then on it does. Where the bound falls by a good part of what was promised, the model moves to the new prices
//! and reaches farther; where it rises, the model reaches less far. This is a stabilised column generation (G. Dantzig and P. Wolfe,
//! *Decomposition principle for linear programs*, Operations Research 8, 1960; K. Kiwiel, *Proximity control in bundle
//! methods for convex nondifferentiable minimization*, Mathematical Programming 46, 1990).

use super::certificate::Certificate;
use super::master::{Master, Way};
use super::prices::{Pace, Prices};
use super::time_expanded_day::TimeExpandedDay;
use super::ways::Ways;
use vertifleet_core::Stop;

/// How often each group may shift its aircraft before prices are evaluated. To go on until no shift is left takes longer than
/// it is worth.
const ROUNDS: u32 = 3;
/// The model has settled when shifts are worth less than this part of what it promised last.
const SETTLED: f64 = 0.05;
/// The reach changes so much after prices that were better by more than a part of what was promised, worse, and worse by more than was
/// promised.
const KEPT: f64 = 0.05;
const FARTHER: f64 = 2.0;
const NEARER: f64 = 0.98;
const MUCH_NEARER: f64 = 0.8;
/// Where the model promises too little, it reaches so much farther, as often as this, before that is believed.
const FAR: f64 = 3.0;
const FAR_TRIES: u32 = 4;
/// To reach farther than any price can go changes nothing.
const FARTHEST: f64 = 1e15;
/// The search has come to its end when so many steps lowered the bound by less than was enough, or when the model promises
/// less than so many times that in one step.
const WINDOW: u32 = 40;
const PROMISED: f64 = 3.0;

/// A part of the search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Descent {
    /// Steps at most, each with one evaluation.
    pub(super) steps: u32,
    /// What the first step aims at, as a share of the bound.
    pub(super) first: f64,
    /// What is too little to go on for, as a share of the bound.
    pub(super) enough: f64,
}

/// The best prices of a descent, and what they prove on the clock of its network before what the fleet costs whatever it does;
/// micro-dollars.
pub(super) struct Found {
    pub(super) prices: Prices,
    pub(super) micro_usd: i128,
}

impl Found {
    /// No schedule earns more micro-dollars.
    pub(super) fn bound(&self, network: &TimeExpandedDay) -> i128 {
        self.micro_usd - i128::from(network.fleet_cost)
    }
}

impl Descent {
    /// Looks for prices from `start` on. `watch` sees the best so far after every evaluation, and says whether to go on. None if
    /// `stopped` is raised before the first evaluation is done.
    pub(super) fn run(
        self,
        network: &TimeExpandedDay,
        pace: &Pace,
        start: Prices,
        stopped: &Stop,
        watch: &mut dyn FnMut(&Found) -> bool,
    ) -> Option<Found> {
        let mut certificate = Certificate::new(network);
        let micro_usd = certificate.evaluate(network, &start, stopped)?;
        let mut trial = start.clone();
        let mut best = Found { prices: start, micro_usd };
        let ways = Ways { network, prices: &trial, certificate: &certificate }.of_groups();
        let master = Master::new(network, pace, trial.clone(), ways);
        let mut model = Model::new(master, self, micro_usd as f64);
        let mut before = best.micro_usd;
        for step in 1..=self.steps {
            if !watch(&best) || !model.promises_enough(best.micro_usd as f64) {
                break;
            }
            model.master.prices(&mut trial);
            let Some(micro_usd) = certificate.evaluate(network, &trial, stopped) else { break };
            let ways = Ways { network, prices: &trial, certificate: &certificate }.of_groups();
            model.learn(ways, (best.micro_usd - micro_usd) as f64);
            if micro_usd < best.micro_usd {
                best.micro_usd = micro_usd;
                best.prices.clone_from(&trial);
                model.master.move_to(&trial);
            }
            if step % WINDOW == 0 {
                if (before - best.micro_usd) as f64 <= self.enough * before as f64 {
                    break;
                }
                before = best.micro_usd;
            }
        }
        watch(&best);
        Some(best)
    }
}

/// The model, and what it promised last.
struct Model<'a> {
    master: Master<'a>,
    promised: f64,
    /// What is too little to promise, micro-dollars.
    enough: f64,
}

impl<'a> Model<'a> {
    /// A model whose first step aims at the share of `bound` that the descent says.
    fn new(mut master: Master<'a>, descent: Descent, bound: f64) -> Self {
        let promised = descent.first * bound;
        master.reach = (promised / master.fall().max(1e-9)).min(FARTHEST);
        Self { master, promised, enough: PROMISED * descent.enough * bound }
    }

    /// Finds the model's prices; whether they may lower the bound by enough to go on.
    fn promises_enough(&mut self, best: f64) -> bool {
        let enough = self.enough;
        let mut unsettled = self.master.settle(ROUNDS, SETTLED * self.promised);
        for _ in 0..FAR_TRIES {
            self.promised = best - self.master.value();
            if self.promised > enough || unsettled > enough {
                self.promised = self.promised.max(enough);
                return true;
            }
            self.master.reach = (FAR * self.master.reach).min(FARTHEST);
            unsettled = self.master.settle(ROUNDS, SETTLED * enough);
        }
        false
    }

    /// Takes in what an evaluation has shown: the ways that are worth most, and by how much the bound fell.
    fn learn(&mut self, ways: Vec<(u32, Way)>, fell: f64) {
        self.master.learn(ways);
        let change = match fell / self.promised {
            kept if kept > KEPT => FARTHER,
            kept if kept < -1.0 => MUCH_NEARER,
            kept if kept < 0.0 => NEARER,
            _ => 1.0,
        };
        self.master.reach = (change * self.master.reach).min(FARTHEST);
    }
}
