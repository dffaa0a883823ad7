//! The path to a good bound: from coarse slices to fine ones, and from a coarse clock to the true
//! one.
//!
//! The path to the requested slices passes through all coarser ones (`CUTS`) and does the same work
//! in each for every request. The result is the best bound that was proven on the path, so a
//! shorter step never gives a looser bound. On days that charge as needed, a cut comes once for
//! each number of levels of charge that is worth its time there, from the fewest on. The prices in
//! some number of levels never depend on those in more, so more levels never give a looser bound
//! either. A path with only the most levels is faster, and promises neither.
//!
//! On each rung, prices are first searched for on a clock that ticks once a minute, where a step
//! takes a fraction of the time and proves nothing, and then to the second, where every step proves
//! a bound.

use std::collections::BTreeMap;

use vertifleet_core::{Scenario, Stop, Time};

use super::Bound;
use super::descent::Descent;
use super::penalty::Penalty;
use super::prices::{Pace, Prices};
use super::slices::Slices;
use super::step::{STEPS, Step};
use super::time_expanded_day::TimeExpandedDay;
use crate::Error;

/// Seconds from one tick of the coarse clock to the next.
pub(super) const TICK_S: u32 = 60;

/// Slices of one length, and the effort of searching in them.
pub(super) struct Cut {
    pub(super) step: Step,
    /// The most levels of charge that are worth their time in these slices.
    most_levels: u16,
    pub(super) on_coarse_clock: Descent,
    to_the_second: Descent,
}

/// The cuts from the coarsest to the finest. Prices that come from coarser slices need less search
/// than those that begin at zero.
pub(super) const CUTS: [Cut; 5] = [
    Cut {
        step: STEPS[0],
        most_levels: 1,
        on_coarse_clock: Descent { steps: 200, first: 0.05, enough: 5e-5 },
        to_the_second: Descent { steps: 30, first: 0.003, enough: 1e-5 },
    },
    Cut {
        step: STEPS[1],
        most_levels: 16,
        on_coarse_clock: Descent { steps: 500, first: 0.02, enough: 5e-5 },
        to_the_second: Descent { steps: 60, first: 0.003, enough: 1e-5 },
    },
    Cut {
        step: STEPS[2],
        most_levels: 64,
        on_coarse_clock: Descent { steps: 300, first: 0.01, enough: 5e-5 },
        to_the_second: Descent { steps: 120, first: 0.003, enough: 1e-5 },
    },
    Cut {
        step: STEPS[3],
        most_levels: 64,
        on_coarse_clock: Descent { steps: 300, first: 0.01, enough: 5e-5 },
        to_the_second: Descent { steps: 250, first: 0.003, enough: 1e-5 },
    },
    Cut {
        step: STEPS[4],
        most_levels: 64,
        on_coarse_clock: Descent { steps: 200, first: 0.01, enough: 5e-5 },
        to_the_second: Descent { steps: 200, first: 0.003, enough: 1e-5 },
    },
];

/// The most steps of the first search with several levels on the coarse clock and to the second,
/// and those of each following one, which begins with good prices.
const FIRST_WITH_LEVELS: (u32, u32) = (300, 20);
const LATER_WITH_LEVELS: (u32, u32) = (150, 40);

/// The numbers of levels of charge with which a path passes through each cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PathLevels {
    /// All, so that neither more levels nor shorter slices ever give a looser bound.
    All,
    /// Only the highest, which is faster.
    Highest,
}

/// A search with slices of one length and one number of levels of charge.
struct Rung {
    step: Step,
    levels: u16,
    on_coarse_clock: Descent,
    to_the_second: Descent,
}

/// The day that is bounded.
#[derive(Clone, Copy)]
pub(super) struct Relaxed<'a> {
    pub(super) scenario: &'a Scenario,
    /// When aircraft decide first; those past its end are ready from the start.
    pub(super) ready: &'a [Time],
    /// The payments of aircraft for knowing delays, for a bound without foresight.
    pub(super) penalty: Option<&'a Penalty>,
}

impl<'a> Relaxed<'a> {
    /// A day that is known in full.
    pub(super) fn known(scenario: &'a Scenario, ready: &'a [Time]) -> Self {
        Self { scenario, ready, penalty: None }
    }

    fn day(&self, rung: &Rung) -> Result<TimeExpandedDay, Error> {
        let (step_s, levels) = (rung.step.seconds(), rung.levels);
        let mut day = TimeExpandedDay::of(self.scenario, self.ready, step_s, levels)?;
        day.penalty = self.penalty.cloned();
        Ok(day)
    }
}

/// An observer of a search.
pub(crate) trait Watch: Sync {
    /// The handle by which the search is asked to end soon.
    fn stopped(&self) -> &Stop;
    /// Called with the share of its work that the search has done.
    fn has_come(&self, share: f64);
    /// Called with the best bound so far.
    fn has_found(&self, bound: &Bound);
    /// Whether a bound of this many dollars is as low as any can be.
    fn is_lowest(&self, bound_usd: f64) -> bool;
}

/// The best bound that is proven on a path to slices of `step`, or until `watch` stops the search;
/// `None` if that is before the first bound.
///
/// # Errors
/// [`Error::TooManyFlights`] if the day is too large for this step.
pub(super) fn search(
    relaxed: Relaxed<'_>,
    step: Step,
    levels: PathLevels,
    watch: &dyn Watch,
) -> Result<Option<Bound>, Error> {
    TimeExpandedDay::fits(relaxed.scenario, step.seconds(), 1)?;
    let rungs = rungs(relaxed.scenario, step, levels);
    let in_all = rungs.iter().map(|rung| rung.work(relaxed.scenario)).sum();
    let mut search = Search { relaxed, watch, best: None, done: 0.0, in_all };
    // The prices that were found last, by number of levels.
    let mut found: BTreeMap<u16, (Slices, Prices)> = BTreeMap::new();
    let mut is_final = true;
    for rung in &rungs {
        let before = found.get(&rung.levels).or_else(|| found.values().next_back());
        let Some(prices) = search.rise(rung, before)? else {
            is_final = false;
            break;
        };
        found.insert(rung.levels, prices);
    }
    if is_final {
        watch.has_come(1.0);
    }
    Ok(search.best.map(|best| {
        let is_final = is_final || watch.is_lowest(best.upper_bound_usd());
        Bound { is_final, ..best }
    }))
}

/// The rungs of a path to slices of `step`.
fn rungs(scenario: &Scenario, step: Step, of_path: PathLevels) -> Vec<Rung> {
    let mut rungs: Vec<Rung> = Vec::new();
    let mut steps = FIRST_WITH_LEVELS;
    for cut in CUTS.iter().filter(|cut| step.minutes <= cut.step.minutes) {
        let most = cut.most_levels.min(step.levels);
        let all = Step { levels: most, ..cut.step }.all_levels(scenario);
        let levels = match of_path {
            PathLevels::All => all,
            PathLevels::Highest => &all[all.len() - 1..],
        };
        let before = rungs.last().map_or(1, |rung| rung.levels);
        if of_path == PathLevels::Highest && levels[0] < before {
            // The day is too large for as many levels in finer slices.
            break;
        }
        for &levels in levels {
            let mut rung = cut.with_one_level();
            if levels > 1 {
                rung.levels = levels;
                (rung.on_coarse_clock.steps, rung.to_the_second.steps) = steps;
                steps = LATER_WITH_LEVELS;
            }
            rungs.push(rung);
        }
    }
    rungs
}

impl Cut {
    fn with_one_level(&self) -> Rung {
        let Self { step, on_coarse_clock, to_the_second, .. } = *self;
        Rung { step, levels: 1, on_coarse_clock, to_the_second }
    }
}

impl Rung {
    /// The approximate number of comparisons in all evaluations for each pair of vertiports.
    fn work(&self, scenario: &Scenario) -> f64 {
        let slices = Slices::of(scenario, self.step.seconds());
        f64::from(self.on_coarse_clock.steps) * comparisons(&slices, TICK_S, self.levels)
            + f64::from(self.to_the_second.steps) * comparisons(&slices, 1, self.levels)
    }
}

/// The approximate number of comparisons in an evaluation for each pair of vertiports. Starting
/// another flight takes as long as some of them.
fn comparisons(slices: &Slices, tick_s: u32, levels: u16) -> f64 {
    f64::from(levels) * (f64::from(slices.day_s() / tick_s) + 16.0 * slices.len() as f64)
}

/// A search in progress.
struct Search<'a> {
    relaxed: Relaxed<'a>,
    watch: &'a dyn Watch,
    best: Option<Bound>,
    /// Work done, and all work of the search.
    done: f64,
    in_all: f64,
}

impl Search<'_> {
    /// Searches on one rung, starting with prices that were found before. Returns the prices to
    /// continue with, or `None` if the search is to end.
    fn rise(
        &mut self,
        rung: &Rung,
        before: Option<&(Slices, Prices)>,
    ) -> Result<Option<(Slices, Prices)>, Error> {
        let slices = Slices::of(self.relaxed.scenario, rung.step.seconds());
        let relaxed = self.relaxed;
        let day = || relaxed.day(rung);
        let size = self.relaxed.scenario.vertiports.len();
        let start = if let Some((coarser, prices)) = before {
            Some(prices.in_slices(coarser, &slices, size))
        } else {
            // Any prices prove a bound, so the first ones give one at once.
            let day = day()?;
            let first = Prices::first(&day);
            self.prove(rung, &day, Descent { steps: 0, ..rung.to_the_second }, &first)
        };
        let coarse = day()?.on_coarse_clock(TICK_S);
        let found = start.and_then(|start| self.search_coarsely(rung, &coarse, &slices, &start));
        drop(coarse);
        let Some(found) = found else { return Ok(None) };
        let prices = self.prove(rung, &day()?, rung.to_the_second, &found);
        Ok(prices.map(|prices| (slices, prices)))
    }

    /// Searches for prices on the coarse clock.
    fn search_coarsely(
        &mut self,
        rung: &Rung,
        coarse: &TimeExpandedDay,
        slices: &Slices,
        start: &Prices,
    ) -> Option<Prices> {
        let (pace, step) = (Pace::of(slices), comparisons(slices, TICK_S, coarse.levels));
        let done = self.done;
        self.done += f64::from(rung.on_coarse_clock.steps) * step;
        let (watch, in_all, mut steps) = (self.watch, self.in_all, 0.0);
        let found = rung.on_coarse_clock.run(coarse, &pace, start, watch.stopped(), &mut |_| {
            watch.has_come((done + steps * step) / in_all);
            steps += 1.0;
            true
        })?;
        (!watch.stopped().is_requested()).then_some(found.prices)
    }

    /// Searches for better prices on the clock of seconds. All of them prove a bound, and the best
    /// is kept. Returns the prices to continue with, or `None` if the search is to end.
    fn prove(
        &mut self,
        rung: &Rung,
        day: &TimeExpandedDay,
        descent: Descent,
        start: &Prices,
    ) -> Option<Prices> {
        let (pace, step) = (Pace::of(&day.slices), comparisons(&day.slices, 1, day.levels));
        let done = self.done;
        self.done += f64::from(descent.steps) * step;
        let (watch, in_all, best, mut steps) = (self.watch, self.in_all, &mut self.best, 0.0);
        let found = descent.run(day, &pace, start, watch.stopped(), &mut |found| {
            watch.has_come((done + steps * step) / in_all);
            steps += 1.0;
            if best.as_ref().is_none_or(|best| found.bound(day) < best.micro_usd) {
                let bound = Bound::of(rung.step, day, found);
                watch.has_found(&bound);
                *best = Some(bound);
            }
            !best.as_ref().is_some_and(|best| watch.is_lowest(best.upper_bound_usd()))
        })?;
        let ends = watch.stopped().is_requested()
            || self.best.as_ref().is_some_and(|best| watch.is_lowest(best.upper_bound_usd()));
        (!ends).then_some(found.prices)
    }
}
