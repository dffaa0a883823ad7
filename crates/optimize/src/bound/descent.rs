//! The search for good prices, step by step: a proximal bundle method, with a bundle of itineraries
//! for each group of like aircraft.
//!
//! Around the best prices so far, the model (`master.rs`) finds prices that would be better if
//! there were no itineraries but those known so far, and predicts the fall of the bound. The prices
//! are evaluated. The itineraries that are worth most at them are new to the model and are added to
//! it. Where the bound falls by a good part of the prediction, the model moves to the new prices
//! and reaches farther; where it rises, the model reaches less far. This is a stabilised column
//! generation (G. Dantzig and P. Wolfe, *Decomposition principle for linear programs*, Operations
//! Research 8, 1960; K. Kiwiel, *Proximity control in bundle methods for convex nondifferentiable
//! minimization*, Mathematical Programming 46, 1990).

use vertifleet_core::Stop;

use super::best_itineraries::BestItineraries;
use super::certificate::Certificate;
use super::itinerary::Itinerary;
use super::master::{Groups, Master};
use super::prices::{Pace, Prices};
use super::time_expanded_day::TimeExpandedDay;

/// How often each group may shift its aircraft before prices are evaluated. Continuing until no
/// shift is left costs more time than it gains.
const ROUNDS: u32 = 3;
/// The model has settled when shifts are worth less than this share of its last prediction.
const SETTLED: f64 = 0.05;
/// The reach is multiplied by `FARTHER` after prices that were better by more than the share `KEPT`
/// of the prediction, by `NEARER` after worse ones, and by `MUCH_NEARER` after prices that were
/// worse by more than the whole prediction.
const KEPT: f64 = 0.05;
const FARTHER: f64 = 2.0;
const NEARER: f64 = 0.98;
const MUCH_NEARER: f64 = 0.8;
/// A model that predicts too little reaches farther by this factor, at most this many times, before
/// the prediction is believed.
const FAR: f64 = 3.0;
const FAR_TRIES: u32 = 4;
/// The greatest reach. Reaching farther than any price can go changes nothing.
const FARTHEST: f64 = 1e15;
/// The search ends when this many steps lowered the bound by less than `enough`, or when the model
/// predicts for one step less than this multiple of it.
const WINDOW: u32 = 40;
const PROMISED: f64 = 3.0;

/// The fall that is too small to continue for while aircraft are planned one after another,
/// micro-dollars.
const A_DOLLAR: f64 = 1e6;

/// The settings of one part of the search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Descent {
    /// The most steps, each with one evaluation.
    pub(super) steps: u32,
    /// The fall that the first step aims at, as a share of the bound.
    pub(super) first: f64,
    /// The fall that is too small to continue for, as a share of the bound.
    pub(super) enough: f64,
}

/// The best prices of a descent, and the bound that they prove on the clock of its day before what
/// the day costs anyway is deducted, micro-dollars.
pub(super) struct Found {
    pub(super) prices: Prices,
    pub(super) micro_usd: i128,
}

impl Found {
    /// The bound, micro-dollars: no schedule earns more.
    pub(super) fn bound(&self, day: &TimeExpandedDay) -> i128 {
        self.micro_usd - i128::from(day.fixed_cost)
    }
}

impl Descent {
    /// Searches for prices from `start` on. `watch` is called with the best prices so far after
    /// every evaluation, and returns whether to continue. Returns `None` if `stopped` is requested
    /// before the first evaluation is done.
    pub(super) fn run(
        self,
        day: &TimeExpandedDay,
        pace: &Pace,
        start: &Prices,
        stopped: &Stop,
        watch: &mut dyn FnMut(&Found) -> bool,
    ) -> Option<Found> {
        let mut bundle = Bundle::begin(self, (day, pace), start, stopped)?;
        bundle.descend(self, stopped, watch);
        Some(bundle.best)
    }
}

/// The model, which is a bundle of itineraries for each group, and the best prices so far.
pub(super) struct Bundle<'a> {
    day: &'a TimeExpandedDay,
    certificate: Certificate,
    master: Master<'a>,
    best: Found,
    /// The prices that were evaluated last.
    trial: Prices,
    /// The fall of the bound that the model predicted last, micro-dollars.
    promised: f64,
    /// A prediction that is too small to continue for, micro-dollars.
    enough: f64,
}

impl<'a> Bundle<'a> {
    /// A model whose first step aims at the fall that the descent's settings ask for. Returns
    /// `None` if `stopped` is requested.
    pub(super) fn begin(
        descent: Descent,
        (day, pace): (&'a TimeExpandedDay, &'a Pace),
        start: &Prices,
        stopped: &Stop,
    ) -> Option<Self> {
        let model = |itineraries| Master::new(day, pace, start.clone(), itineraries);
        let mut bundle = Self::around(day, start, model, stopped)?;
        let micro_usd = bundle.best.micro_usd as f64;
        bundle.promised = descent.first * micro_usd;
        bundle.enough = PROMISED * descent.enough * micro_usd;
        let Self { master, promised, .. } = &mut bundle;
        master.reach = (*promised / master.fall().max(1e-9)).min(FARTHEST);
        Some(bundle)
    }

    /// The model of a day on which some of the aircraft of `groups` have been planned. Returns
    /// `None` if `stopped` is requested.
    pub(super) fn resume(
        (day, pace): (&'a TimeExpandedDay, &'a Pace),
        start: &Prices,
        groups: Groups,
        stopped: &Stop,
    ) -> Option<Self> {
        let model = |itineraries| {
            let mut master = Master::resume(day, pace, start.clone(), groups);
            master.learn(itineraries);
            master
        };
        Self::around(day, start, model, stopped)
    }

    /// A model that is made of the itineraries that are worth most at some prices, and those prices
    /// as the best so far.
    fn around(
        day: &'a TimeExpandedDay,
        start: &Prices,
        model: impl FnOnce(Vec<(u32, Itinerary)>) -> Master<'a>,
        stopped: &Stop,
    ) -> Option<Self> {
        let mut certificate = Certificate::new(day);
        let micro_usd = certificate.evaluate(day, start, stopped)?;
        let itineraries =
            BestItineraries { day, prices: start, certificate: &certificate }.of_groups();
        let master = model(itineraries);
        let best = Found { prices: start.clone(), micro_usd };
        let (promised, enough) = (A_DOLLAR, A_DOLLAR);
        Some(Self { day, certificate, master, best, trial: start.clone(), promised, enough })
    }

    /// Takes steps until the settings of the descent or `watch` end it, or `stopped` is requested.
    pub(super) fn descend(
        &mut self,
        descent: Descent,
        stopped: &Stop,
        watch: &mut dyn FnMut(&Found) -> bool,
    ) {
        let mut before = self.best.micro_usd;
        for step in 1..=descent.steps {
            if !watch(&self.best) || !self.step(stopped) {
                break;
            }
            if step % WINDOW == 0 {
                if (before - self.best.micro_usd) as f64 <= descent.enough * before as f64 {
                    break;
                }
                before = self.best.micro_usd;
            }
        }
        watch(&self.best);
    }

    /// Evaluates the model's prices. Returns whether to continue: not if the model promises too
    /// little, or `stopped` is requested.
    fn step(&mut self, stopped: &Stop) -> bool {
        if !self.promises_enough() {
            return false;
        }
        self.master.prices(&mut self.trial);
        let evaluated = self.certificate.evaluate(self.day, &self.trial, stopped);
        let Some(micro_usd) = evaluated else { return false };
        let Self { day, trial, certificate, .. } = self;
        let itineraries = BestItineraries { day, prices: trial, certificate }.of_groups();
        self.learn(itineraries, (self.best.micro_usd - micro_usd) as f64);
        if micro_usd < self.best.micro_usd {
            self.best.micro_usd = micro_usd;
            self.best.prices.clone_from(&self.trial);
            self.master.move_to(&self.trial);
        }
        true
    }

    /// Finds the model's prices, and returns whether they may lower the bound by enough to
    /// continue.
    fn promises_enough(&mut self) -> bool {
        let (best, enough) = (self.best.micro_usd as f64, self.enough);
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

    /// Learns from an evaluation: the itineraries that are worth most, and the fall of the bound.
    fn learn(&mut self, itineraries: Vec<(u32, Itinerary)>, fell: f64) {
        self.master.learn(itineraries);
        let change = match fell / self.promised {
            kept if kept > KEPT => FARTHER,
            kept if kept < -1.0 => MUCH_NEARER,
            kept if kept < 0.0 => NEARER,
            _ => 1.0,
        };
        self.master.reach = (change * self.master.reach).min(FARTHEST);
    }

    /// The best prices, and the model's groups.
    pub(super) fn into_parts(self) -> (Prices, Groups) {
        (self.best.prices, self.master.into_groups())
    }
}
