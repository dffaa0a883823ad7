//! The path to a good bound: from coarse slices to fine ones, and from a coarse clock to the true
//! one.
//!
//! The path to the requested slices passes through all coarser ones (`CUTS`) and does the same work
//! in each for every request. The result is the best bound that was proven on the path, so a
//! shorter step never gives a looser bound. On days that charge as needed, the finest slices come
//! again with more levels of charge, from the fewest on. In each cut, prices are first searched for
//! on a clock that ticks once a minute, where a step takes a fraction of the time and proves
//! nothing, and then to the second, where every step proves a bound.

use vertifleet_core::{Scenario, Stop, Time};

use super::Bound;
use super::descent::Descent;
use super::penalty::Penalty;
use super::prices::{Pace, Prices};
use super::slices::Slices;
use super::step::{LEVELS, STEPS, Step};
use super::time_expanded_day::TimeExpandedDay;
use crate::Error;

/// Seconds from one tick of the coarse clock to the next.
pub(super) const TICK_S: u32 = 60;

/// Slices of one length, and the effort of searching in them.
pub(super) struct Cut {
    pub(super) step: Step,
    pub(super) on_coarse_clock: Descent,
    to_the_second: Descent,
}

/// The cuts from the coarsest to the finest. Prices that come from coarser slices need less search
/// than those that begin at zero.
pub(super) const CUTS: [Cut; 5] = [
    Cut {
        step: STEPS[0],
        on_coarse_clock: Descent { steps: 200, first: 0.05, enough: 5e-5 },
        to_the_second: Descent { steps: 30, first: 0.003, enough: 1e-5 },
    },
    Cut {
        step: STEPS[1],
        on_coarse_clock: Descent { steps: 500, first: 0.02, enough: 5e-5 },
        to_the_second: Descent { steps: 60, first: 0.003, enough: 1e-5 },
    },
    Cut {
        step: STEPS[2],
        on_coarse_clock: Descent { steps: 300, first: 0.01, enough: 5e-5 },
        to_the_second: Descent { steps: 120, first: 0.003, enough: 1e-5 },
    },
    Cut {
        step: STEPS[3],
        on_coarse_clock: Descent { steps: 300, first: 0.01, enough: 5e-5 },
        to_the_second: Descent { steps: 250, first: 0.003, enough: 1e-5 },
    },
    Cut {
        step: STEPS[4],
        on_coarse_clock: Descent { steps: 200, first: 0.01, enough: 5e-5 },
        to_the_second: Descent { steps: 200, first: 0.003, enough: 1e-5 },
    },
];

/// The day that is bounded.
#[derive(Clone, Copy)]
pub(crate) struct Relaxed<'a> {
    pub(crate) scenario: &'a Scenario,
    /// When aircraft decide first; those past its end are ready from the start.
    pub(crate) ready: &'a [Time],
    /// Number of levels of charge, on days that charge as needed.
    pub(super) levels: u16,
    /// The payments of aircraft for knowing delays, for a bound without foresight.
    pub(super) penalty: Option<&'a Penalty>,
}

impl<'a> Relaxed<'a> {
    /// A day that is known in full.
    pub(crate) fn known(scenario: &'a Scenario, ready: &'a [Time]) -> Self {
        Self { scenario, ready, levels: 1, penalty: None }
    }

    pub(super) fn day(&self, step: Step) -> Result<TimeExpandedDay, Error> {
        let mut day = TimeExpandedDay::of(self.scenario, self.ready, step.seconds(), self.levels)?;
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

/// The best bound that is proven on the path to slices of `step`, or until `watch` stops the
/// search; `None` if that is before the first bound.
///
/// # Errors
/// [`Error::TooManyFlights`] if the day is too large for this step.
pub(crate) fn search(
    relaxed: Relaxed<'_>,
    step: Step,
    watch: &dyn Watch,
) -> Result<Option<Bound>, Error> {
    TimeExpandedDay::fits(relaxed.scenario, step.seconds(), step.most_levels(relaxed.scenario))?;
    let cuts = || CUTS.iter().filter(|cut| step.minutes <= cut.step.minutes);
    let most_levels = step.most_levels(relaxed.scenario);
    let levels = || LEVELS.iter().filter(|&&levels| levels <= most_levels);
    let finest = cuts().next_back().expect("a step is one of the cuts");
    let in_all = cuts().map(|cut| cut.work(relaxed.scenario, 1)).sum::<f64>()
        + levels().map(|&levels| finest.work(relaxed.scenario, levels)).sum::<f64>();
    let mut search = Search { relaxed, watch, best: None, done: 0.0, in_all };
    let mut before = None;
    for cut in cuts() {
        before = search.rise(cut, before)?;
        if before.is_none() {
            break;
        }
    }
    for &levels in levels() {
        if before.is_none() {
            break;
        }
        search.relaxed.levels = levels;
        before = search.rise(finest, before)?;
    }
    if before.is_some() {
        watch.has_come(1.0);
    }
    Ok(search.best.map(|best| {
        let is_final = before.is_some() || watch.is_lowest(best.upper_bound_usd());
        Bound { is_final, ..best }
    }))
}

impl Cut {
    /// The approximate number of comparisons in all evaluations for each pair of vertiports.
    fn work(&self, scenario: &Scenario, levels: u16) -> f64 {
        let slices = Slices::of(scenario, self.step.seconds());
        f64::from(self.on_coarse_clock.steps) * comparisons(&slices, TICK_S, levels)
            + f64::from(self.to_the_second.steps) * comparisons(&slices, 1, levels)
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
    /// Searches in slices of one length, starting with the prices that were found in coarser ones.
    /// Returns the prices to continue with, or `None` if the search is to end.
    fn rise(
        &mut self,
        cut: &Cut,
        before: Option<(Slices, Prices)>,
    ) -> Result<Option<(Slices, Prices)>, Error> {
        let slices = Slices::of(self.relaxed.scenario, cut.step.seconds());
        let relaxed = self.relaxed;
        let day = || relaxed.day(cut.step);
        let size = self.relaxed.scenario.vertiports.len();
        let start = if let Some((coarser, prices)) = before {
            Some(prices.in_slices(&coarser, &slices, size))
        } else {
            // Any prices prove a bound, so the first ones give one at once.
            let day = day()?;
            let first = Prices::first(&day);
            self.prove(cut, &day, Descent { steps: 0, ..cut.to_the_second }, &first)
        };
        let coarse = day()?.on_coarse_clock(TICK_S);
        let found = start.and_then(|start| self.search_coarsely(cut, &coarse, &slices, &start));
        drop(coarse);
        let Some(found) = found else { return Ok(None) };
        let prices = self.prove(cut, &day()?, cut.to_the_second, &found);
        Ok(prices.map(|prices| (slices, prices)))
    }

    /// Searches for prices on the coarse clock.
    fn search_coarsely(
        &mut self,
        cut: &Cut,
        coarse: &TimeExpandedDay,
        slices: &Slices,
        start: &Prices,
    ) -> Option<Prices> {
        let (pace, step) = (Pace::of(slices), comparisons(slices, TICK_S, coarse.levels));
        let done = self.done;
        self.done += f64::from(cut.on_coarse_clock.steps) * step;
        let (watch, in_all, mut steps) = (self.watch, self.in_all, 0.0);
        let found = cut.on_coarse_clock.run(coarse, &pace, start, watch.stopped(), &mut |_| {
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
        cut: &Cut,
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
                let bound = Bound::of(cut.step, day, found);
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
