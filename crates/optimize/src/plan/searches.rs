//! Searches in parallel, which share their results from time to time.

use std::sync::Arc;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use vertifleet_core::Scenario;
use vertifleet_policy::draw;

use super::dive::{Dive, Dived};
use super::guiding_prices::GuidingPrices;
use super::problem::Problem;
use super::schedule::Schedule;
use super::search::Search;
use super::{BestPlan, Clock, Plan, SearchProgress, SearchSettings, start};
use crate::proof::POLL_INTERVAL;

/// Rounds after which the search with the worst schedule continues from the best one's.
const ROUNDS_A_MEETING: u64 = 100;
/// Temperatures at which annealing begins and ends, dollars. From 20, days of `paper` earned 0.2 %
/// less after 100,000 steps, because that is too hot for a search that starts from a good day.
const HOT_USD: f64 = 4.0;
const COLD_USD: f64 = 1.0;

/// The searches of a plan.
pub(super) struct Searches<'a> {
    scenario: &'a Arc<Scenario>,
    settings: &'a SearchSettings,
    problem: &'a Problem,
    prices: GuidingPrices,
    all: Vec<Search>,
    /// Rounds since the searches met.
    rounds: u64,
    /// A dive that has not ended. It takes the place of a search, if there are several.
    dive: Option<Dive>,
}

impl<'a> Searches<'a> {
    /// Searches that begin with a schedule. The prices and the schedule of the dive join them: with
    /// a limit of time when it has come to an end, otherwise before the first step.
    pub(super) fn begin(
        scenario: &'a Arc<Scenario>,
        settings: &'a SearchSettings,
        problem: &'a Problem,
        first: &Schedule,
        dive: Option<Dive>,
    ) -> Self {
        let prices = GuidingPrices::of_policies(scenario, &problem.day);
        let all = Vec::new();
        let mut searches = Self { scenario, settings, problem, prices, all, rounds: 0, dive };
        let places = settings.searches.saturating_sub(searches.dive.is_some().into());
        (0..places.max(1)).for_each(|_| searches.add(first.clone()));
        searches
    }

    /// Adds a search that begins with a schedule.
    fn add(&mut self, schedule: Schedule) {
        let number = u32::try_from(self.all.len()).expect("as many searches as threads");
        let seed = draw(self.settings.seed, self.scenario.seed, number);
        self.all.push(Search::new(self.problem, schedule, seed));
    }

    /// Improves a plan until the budget is used up or `watch` stops it.
    pub(super) fn improve(
        mut self,
        clock: &Clock,
        plan: &mut Plan,
        best: &BestPlan,
        watch: &mut dyn FnMut(&SearchProgress) -> bool,
    ) {
        loop {
            let share = clock.share(plan.steps);
            let progress = SearchProgress { share, steps: plan.steps, profit_usd: plan.profit_usd };
            if !watch(&progress) || share >= 1.0 {
                return;
            }
            self.join_dive(clock);
            let is_waiting = self.dive.is_some() && clock.waits_for_dive();
            if !is_waiting {
                plan.steps += self.round(clock, plan.steps);
            }
            self.keep_best(plan, best);
            if !is_waiting && self.rounds.is_multiple_of(ROUNDS_A_MEETING) {
                self.meet();
            }
        }
    }

    /// If the dive has come to an end, its prices guide the searches from now on, and one begins
    /// with its schedule.
    fn join_dive(&mut self, clock: &Clock) {
        let patience = if clock.waits_for_dive() { POLL_INTERVAL } else { Duration::ZERO };
        let outcome = self.dive.as_ref().and_then(|dive| dive.outcome(patience));
        let Some(Dived { prices, schedule }) = outcome else { return };
        self.dive = None;
        if let Some(prices) = prices {
            self.prices = prices;
        }
        self.add(schedule.unwrap_or_else(|| self.all[0].current.clone()));
        self.rounds = 0;
    }

    /// Takes some steps of each search. Returns their number.
    fn round(&mut self, clock: &Clock, done: u64) -> u64 {
        let temperature_usd = HOT_USD * (COLD_USD / HOT_USD).powf(clock.share(done));
        let steps = clock.steps_a_round(done);
        let until = clock.end_of_round();
        let (problem, prices) = (self.problem, &self.prices);
        let taken = self.all.par_iter_mut().map(|search| {
            let goes_on = || until.is_none_or(|until| Instant::now() < until);
            let mut taken = 0;
            while taken < steps && goes_on() {
                search.step(problem, prices, temperature_usd);
                taken += 1;
            }
            taken
        });
        let taken = taken.min().expect("there is a search");
        self.rounds += 1;
        taken
    }

    /// Lets the search with the worst schedule continue from the best one's. If there are more than
    /// there should be, it ends.
    fn meet(&mut self) {
        let value = |&at: &usize| self.all[at].current.value_usd();
        let by_value = |one: &usize, other: &usize| value(one).total_cmp(&value(other));
        let best = (0..self.all.len()).max_by(by_value).expect("there is a search");
        let worst = (0..self.all.len()).min_by(by_value).expect("there is a search");
        if best == worst {
            return;
        }
        if self.all.len() > self.settings.searches.max(1) {
            self.all.remove(worst);
        } else {
            let current = self.all[best].current.clone();
            self.all[worst].current.clone_from(&current);
        }
    }

    /// Plays the best schedule of all searches and keeps it if it earns more than the plan so far.
    fn keep_best(&self, plan: &mut Plan, known: &BestPlan) {
        let schedules = self.all.iter().map(|search| &search.best);
        let best = schedules
            .max_by(|one, other| one.value_usd().total_cmp(&other.value_usd()))
            .expect("there is a search");
        if best.value_usd() > plan.profit_usd {
            let (trace, profit_usd) = start::flown(self.scenario, best);
            if profit_usd > plan.profit_usd {
                (plan.trace, plan.profit_usd) = (trace, profit_usd);
                known.record(plan);
            }
        }
    }
}
