//! `bound` and `plan`: what a known day can earn at most, and a schedule that comes close to it.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use numpy::PyArray1;
use pyo3::prelude::*;
use vertifleet_core::{self as core, VertiportIx};
use vertifleet_optimize::{self as exact, Budget, Proof, Settings, Step};

use crate::failure::Failure;
use crate::frames::table;
use crate::interruptible::interruptible;
use crate::scenario::Scenario;
use crate::trace::Trace;

/// How often somebody who waits for a proof looks for Ctrl-C.
const GLANCE: Duration = Duration::from_millis(50);

/// A proof of what a day can earn at most.
#[pyclass(frozen, module = "vertifleet")]
#[derive(Clone)]
pub(crate) struct Bound {
    scenario: Arc<core::Scenario>,
    bound: Arc<exact::Bound>,
}

#[pymethods]
impl Bound {
    /// No schedule of the day earns more, dollars.
    #[getter]
    fn upper_bound_usd(&self) -> f64 {
        self.bound.upper_bound_usd()
    }

    /// Minutes for which the proof's prices stay the same.
    #[getter]
    fn step(&self) -> u32 {
        self.bound.step_s() / 60
    }

    /// What one more stand is worth all day at most, dollars [vertiports].
    #[getter]
    fn stand_worth_usd<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        let vertiports = VertiportIx::all(self.scenario.vertiports.len());
        PyArray1::from_iter(py, vertiports.map(|at| self.bound.stand_worth_usd(at)))
    }

    /// What one more passenger is worth at most, dollars [periods, vertiports, vertiports].
    #[getter]
    fn passenger_worth_usd<'py>(&self, py: Python<'py>) -> PyResult<pyo3::Bound<'py, PyAny>> {
        let (periods, size) = (self.scenario.periods.len(), self.scenario.vertiports.len());
        let pairs = || {
            VertiportIx::all(size).flat_map(|from| VertiportIx::all(size).map(move |to| (from, to)))
        };
        let worth = (0..periods).flat_map(|period| {
            pairs().map(move |(from, to)| self.bound.passenger_worth_usd(period, from, to))
        });
        table(py, worth, [periods, size, size])
    }

    /// By which share of the bound a profit is below it.
    fn gap(&self, profit_usd: f64) -> f64 {
        self.bound.gap(profit_usd)
    }

    fn __repr__(&self) -> String {
        let (day, usd) = (&self.scenario.name, self.bound.upper_bound_usd());
        format!("<Bound of {day}: ${usd:.2}>")
    }
}

/// An array of numbers.
type Numbers<'py> = pyo3::Bound<'py, PyArray1<f64>>;

/// Proves how much a day can earn at most. `step`: minutes for which the proof's prices stay the same, 1 to 60; fewer give a
/// tighter bound, later.
#[pyfunction]
#[pyo3(signature = (scenario, *, step = 5))]
pub(crate) fn bound(py: Python<'_>, scenario: &Scenario, step: u32) -> PyResult<Bound> {
    let step = Step::from_minutes(step).map_err(Failure::from)?;
    let day = &scenario.scenario;
    // A proof takes about a second and cannot be cut short; Ctrl-C is heard after it.
    let bound = interruptible(py, Some(1), |_| exact::upper_bound(day, step))?;
    let bound = bound.map_err(Failure::from)?;
    Ok(Bound { scenario: Arc::clone(day), bound: Arc::new(bound) })
}

/// A schedule for a day that is known.
#[pyclass(frozen, module = "vertifleet")]
pub(crate) struct Plan {
    trace: Trace,
    found: exact::Plan,
    bound: Option<Bound>,
}

#[pymethods]
impl Plan {
    /// Every decision of the day.
    #[getter]
    fn trace(&self) -> Trace {
        self.trace.clone()
    }

    /// What the day earns, as the simulator accounts for it, dollars.
    #[getter]
    fn profit(&self) -> f64 {
        self.found.profit_usd
    }

    /// What the best policy earns that the search began with, dollars; the plan is never worse.
    #[getter]
    fn best_policy(&self) -> f64 {
        self.found.best_policy_usd
    }

    /// Steps of each search.
    #[getter]
    fn steps(&self) -> u64 {
        self.found.steps
    }

    /// What no schedule earns more than.
    #[getter]
    fn bound(&self) -> Option<Bound> {
        self.bound.clone()
    }

    /// Share of the bound by which the plan is below it: the best schedule is at most so far ahead.
    #[getter]
    fn gap(&self) -> Option<f64> {
        self.bound.as_ref().map(|bound| bound.gap(self.found.profit_usd))
    }

    fn __repr__(&self) -> String {
        let (day, profit_usd) = (&self.trace.scenario.name, self.found.profit_usd);
        let gap = self.gap().map_or(String::new(), |gap| format!(", gap {:.2} %", 100.0 * gap));
        format!("<Plan of {day}: profit ${profit_usd:.2}{gap}>")
    }
}

/// Finds the best schedule it can for a day that is known, while a proof of what is possible runs beside it.
///
/// Searches for `time_limit` seconds, or for `steps` steps of each search if those are given (the plan then depends on nothing
/// but the day, `seed`, `steps` and `threads`), or until the gap to the bound is no more than `gap`, as 0.03.
#[pyfunction]
#[pyo3(signature = (scenario, *, time_limit = 60.0, steps = None, gap = None, seed = 0, threads = None))]
pub(crate) fn plan(
    py: Python<'_>,
    scenario: &Scenario,
    time_limit: f64,
    steps: Option<u64>,
    gap: Option<f64>,
    seed: u64,
    threads: Option<usize>,
) -> PyResult<Plan> {
    let budget = match steps {
        Some(steps) => Budget::Steps(steps),
        None => Budget::Time(seconds(time_limit)?),
    };
    let day = &scenario.scenario;
    let outcome = interruptible(py, threads, |stop| {
        let mut proof = Proof::begin(day);
        let settings = Settings { budget, searches: rayon::current_num_threads(), seed };
        let plan = exact::plan(day, &settings, &mut |now| {
            proof.wait(Duration::ZERO);
            let found = proof.bound().map(|bound| bound.gap(now.profit_usd));
            let good_enough = gap.zip(found).is_some_and(|(asked, found)| found <= asked);
            !good_enough && !stop.load(Ordering::Relaxed)
        })?;
        while !proof.wait(GLANCE) && !stop.load(Ordering::Relaxed) {}
        Ok::<_, exact::Error>((plan, proof.outcome()))
    })?;
    let (plan, proof) = outcome.map_err(Failure::from)?;
    // A day too large for any bound has a plan all the same.
    let bound = proof.ok().flatten();
    let bound = bound.map(|bound| Bound { scenario: Arc::clone(day), bound: Arc::new(bound) });
    let trace = Trace { scenario: Arc::clone(day), trace: Arc::new(plan.trace.clone()) };
    Ok(Plan { trace, found: plan, bound })
}

/// A time limit as the planner takes it.
fn seconds(time_limit: f64) -> Result<Duration, Failure> {
    if (0.0..=1e6).contains(&time_limit) {
        return Ok(Duration::from_secs_f64(time_limit));
    }
    let message = format!("time_limit must be seconds from 0 to 1000000, found {time_limit}");
    Err(Failure::argument(message))
}
