//! `bound` and `plan`: an upper bound on the profit of a known day, and a schedule that comes close
//! to it.

use std::sync::Arc;
use std::time::Duration;

use numpy::PyArray1;
use pyo3::prelude::*;
use vertifleet_core::{self as core, VertiportIx};
use vertifleet_optimize::{self as exact, Budget, SearchSettings, Step, plan_in_time};
use vertifleet_progress::SearchBar;
use vertifleet_study::starting_policies;

use crate::failure::Failure;
use crate::frames::table;
use crate::interruptible::{self, interruptible};
use crate::pickle::{Reduced, reduced};
use crate::scenario::Scenario;
use crate::trace::Trace;
use crate::whole_number::WholeNumber;

/// A proven upper bound on the profit of every schedule of a day.
#[pyclass(frozen, module = "vertifleet")]
#[derive(Clone)]
pub(crate) struct Bound {
    scenario: Arc<core::Scenario>,
    step: u32,
    upper_bound_usd: f64,
    is_final: bool,
    /// Indexed by vertiport.
    stand_shadow_price_usd: Vec<f64>,
    /// Indexed by period, origin and destination.
    passenger_shadow_price_usd: Vec<f64>,
}

#[pymethods]
impl Bound {
    /// The day.
    #[getter]
    fn scenario(&self) -> Scenario {
        Scenario { scenario: Arc::clone(&self.scenario) }
    }

    /// The upper bound, dollars. No schedule of the day earns more.
    #[getter]
    fn upper_bound_usd(&self) -> f64 {
        self.upper_bound_usd
    }

    /// Whether the search for the bound is complete. If not, a longer search may find a lower
    /// bound.
    #[getter]
    fn is_final(&self) -> bool {
        self.is_final
    }

    /// Longest interval, in minutes, for which the prices of the bound stay the same. This may be
    /// more than requested, if longer slices prove a lower bound.
    #[getter]
    fn step(&self) -> u32 {
        self.step
    }

    /// Shadow price of one more stand all day, dollars [vertiports]. With one more stand, no
    /// schedule earns more than the bound plus this price.
    #[getter]
    fn stand_shadow_price_usd<'py>(&self, py: Python<'py>) -> pyo3::Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.stand_shadow_price_usd)
    }

    /// Shadow price of one more passenger, dollars [periods, vertiports, vertiports]. With one more
    /// passenger, no schedule earns more than the bound plus this price.
    #[getter]
    fn passenger_shadow_price_usd<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<pyo3::Bound<'py, PyAny>> {
        let (periods, size) = (self.scenario.periods.len(), self.scenario.vertiports.len());
        table(py, self.passenger_shadow_price_usd.iter().copied(), [periods, size, size])
    }

    /// The gap: the distance of a profit below the bound, as a share of the bound. Both are taken
    /// before the costs of aircraft and sites, which no decision changes.
    fn gap(&self, profit_usd: f64) -> f64 {
        let fixed_usd = self.scenario.fixed_cost_usd();
        exact::gap(self.upper_bound_usd + fixed_usd, profit_usd + fixed_usd)
    }

    fn __repr__(&self) -> String {
        format!("<Bound of {}: ${:.2}>", self.scenario.name, self.upper_bound_usd)
    }

    /// Restores a pickled object.
    #[staticmethod]
    fn of_numbers(
        scenario: &Scenario,
        step: u32,
        upper_bound_usd: f64,
        is_final: bool,
        stand_shadow_price_usd: Vec<f64>,
        passenger_shadow_price_usd: Vec<f64>,
    ) -> Self {
        let scenario = Arc::clone(&scenario.scenario);
        Self {
            scenario,
            step,
            upper_bound_usd,
            is_final,
            stand_shadow_price_usd,
            passenger_shadow_price_usd,
        }
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Reduced<'py, Numbers> {
        let scenario = Scenario { scenario: Arc::clone(&self.scenario) };
        let Self {
            step,
            upper_bound_usd,
            is_final,
            stand_shadow_price_usd,
            passenger_shadow_price_usd,
            ..
        } = self.clone();
        let numbers = (
            scenario,
            step,
            upper_bound_usd,
            is_final,
            stand_shadow_price_usd,
            passenger_shadow_price_usd,
        );
        reduced::<Self, _>(py, "of_numbers", numbers)
    }
}

/// Arguments of [`Bound::of_numbers`].
type Numbers = (Scenario, u32, f64, bool, Vec<f64>, Vec<f64>);

impl Bound {
    /// Copies the results out of a bound.
    fn of(scenario: &Arc<core::Scenario>, bound: &exact::Bound) -> Self {
        let size = scenario.vertiports.len();
        let pairs = || {
            VertiportIx::all(size)
                .flat_map(move |from| VertiportIx::all(size).map(move |to| (from, to)))
        };
        let passengers = (0..scenario.periods.len()).flat_map(|period| {
            pairs().map(move |(from, to)| bound.passenger_shadow_price_usd(period, from, to))
        });
        Self {
            step: bound.step_s() / 60,
            upper_bound_usd: bound.upper_bound_usd(),
            is_final: bound.is_final(),
            stand_shadow_price_usd: VertiportIx::all(size)
                .map(|at| bound.stand_shadow_price_usd(at))
                .collect(),
            passenger_shadow_price_usd: passengers.collect(),
            scenario: Arc::clone(scenario),
        }
    }
}

/// Proves an upper bound on the profit of every schedule of a day. `step` is the length of the
/// bound's slices in minutes, 1 to 60, and `levels` the number of levels of charge on days that
/// charge as needed, 4 to 64. Shorter slices and more levels never give a looser bound, but take
/// longer.
#[pyfunction]
#[pyo3(
    signature = (scenario, *, step = WholeNumber::from(5), levels = WholeNumber::from(64)),
    text_signature = "(scenario, *, step=5, levels=64)"
)]
pub(crate) fn bound(
    py: Python<'_>,
    scenario: &Scenario,
    step: WholeNumber,
    levels: WholeNumber,
) -> PyResult<Bound> {
    let step = Step::from_minutes(step.of("step")?).map_err(Failure::from)?;
    let step = step.with_levels(levels.of("levels")?).map_err(Failure::from)?;
    let day = Arc::clone(&scenario.scenario);
    let bound = interruptible(py, 1, move |stop| {
        let bound = exact::upper_bound_unless(stop, &day, step)?;
        Ok::<_, exact::Error>(bound.map(|bound| Bound::of(&day, &bound)))
    })?;
    let bound = bound.map_err(Failure::from)?;
    Ok(bound.expect("a stop is the only answer to a stopped call"))
}

/// A schedule for a day that is known.
#[pyclass(frozen, module = "vertifleet")]
pub(crate) struct Plan {
    trace: Trace,
    profit_usd: f64,
    best_policy: String,
    best_policy_usd: f64,
    steps: u64,
    bound: Option<Bound>,
}

#[pymethods]
impl Plan {
    /// Every decision of the day.
    #[getter]
    fn trace(&self) -> Trace {
        self.trace.clone()
    }

    /// Profit of the day, as the simulator computes it, dollars.
    #[getter]
    fn profit_usd(&self) -> f64 {
        self.profit_usd
    }

    /// Name of the best of the policies that finished the day in time.
    #[getter]
    fn best_policy(&self) -> &str {
        &self.best_policy
    }

    /// Profit of that policy, dollars. The plan never earns less.
    #[getter]
    fn best_policy_usd(&self) -> f64 {
        self.best_policy_usd
    }

    /// Number of steps of each search.
    #[getter]
    fn steps(&self) -> u64 {
        self.steps
    }

    /// The upper bound of the day, or `None` if the day is too large for a bound or the time was
    /// too short to prove one.
    #[getter]
    fn bound(&self) -> Option<Bound> {
        self.bound.clone()
    }

    /// The distance of the plan's profit below the bound, as a share of the bound. The best
    /// schedule is at most this much better.
    #[getter]
    fn gap(&self) -> Option<f64> {
        self.bound.as_ref().map(|bound| bound.gap(self.profit_usd))
    }

    /// Restores a pickled object.
    #[staticmethod]
    fn of_parts(
        trace: &Trace,
        profit_usd: f64,
        best_policy: String,
        best_policy_usd: f64,
        steps: u64,
        bound: Option<&Bound>,
    ) -> Self {
        let (trace, bound) = (trace.clone(), bound.cloned());
        Self { trace, profit_usd, best_policy, best_policy_usd, steps, bound }
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> Reduced<'py, (Trace, f64, String, f64, u64, Option<Bound>)> {
        let Self { trace, profit_usd, best_policy, best_policy_usd, steps, bound } = self;
        reduced::<Self, _>(
            py,
            "of_parts",
            (
                trace.clone(),
                *profit_usd,
                best_policy.clone(),
                *best_policy_usd,
                *steps,
                bound.clone(),
            ),
        )
    }

    fn __repr__(&self) -> String {
        let (day, profit_usd) = (&self.trace.scenario.name, self.profit_usd);
        let gap = self.gap().map_or(String::new(), |gap| format!(", gap {:.2} %", 100.0 * gap));
        format!("<Plan of {day}: profit ${profit_usd:.2}{gap}>")
    }
}

/// Searches for a good schedule of a known day, and proves an upper bound of the day at the same
/// time.
///
/// The search takes `time_limit` seconds, 60 by default, or `steps` steps in each search if `steps`
/// is given; the plan then depends only on the day, `seed`, `steps` and `threads`. It ends early
/// when the gap to the bound is at most `gap`, for example 0.03. The bound is the best one that is
/// proven when the time is over. With `steps`, the call waits for the whole proof.
#[pyfunction]
#[pyo3(
    signature = (scenario, *, time_limit = None, steps = None, gap = None, seed = WholeNumber::from(0), threads = None),
    text_signature = "(scenario, *, time_limit=None, steps=None, gap=None, seed=0, threads=None)"
)]
pub(crate) fn plan(
    py: Python<'_>,
    scenario: &Scenario,
    time_limit: Option<f64>,
    steps: Option<WholeNumber>,
    gap: Option<f64>,
    seed: WholeNumber,
    threads: Option<WholeNumber>,
) -> PyResult<Plan> {
    let seed = seed.of("seed")?;
    let (budget, units) = match (time_limit, steps) {
        (None, Some(steps)) => (Budget::Steps(steps.of("steps")?), "% of the steps"),
        (limit_s, None) => {
            let limit_s = within("time_limit", limit_s.unwrap_or(60.0), 1e6)?;
            (Budget::Time(Duration::from_secs_f64(limit_s)), "% of the time")
        }
        (Some(_), Some(_)) => {
            let message = "a search ends after time_limit seconds or after a number of steps: give one of them";
            return Err(Failure::argument(message.to_owned()).into());
        }
    };
    let asked = gap.map(|gap| within("gap", gap, 1.0)).transpose()?;
    let threads = interruptible::threads(threads)?;
    let day = Arc::clone(&scenario.scenario);
    // The search starts its own threads.
    let outcome = interruptible(py, 1, move |stop| {
        let settings = SearchSettings { budget, searches: threads, seed };
        let limit = match budget {
            Budget::Time(limit) => Some(limit),
            Budget::Steps(_) => None,
        };
        let mut bar = SearchBar::new(units, limit);
        let starts = starting_policies(&day);
        let exact::ProvenPlan { plan, bound } =
            plan_in_time(&day, &settings, starts, asked, stop, &mut |now, bound| {
                bar.show(now, bound);
            })?;
        Ok(Plan {
            trace: Trace { scenario: Arc::clone(&day), trace: Arc::new(plan.trace) },
            profit_usd: plan.profit_usd,
            best_policy: plan.best_policy,
            best_policy_usd: plan.best_policy_usd,
            steps: plan.steps,
            // A day that is too large for a bound still gets a plan.
            bound: bound.map(|bound| Bound::of(&day, &bound)),
        })
    })?;
    outcome.map_err(|error: exact::Error| Failure::from(error).into())
}

/// Checks that an argument is from 0 to `most`.
fn within(name: &str, found: f64, most: f64) -> Result<f64, Failure> {
    if (0.0..=most).contains(&found) {
        return Ok(found);
    }
    Err(Failure::argument(format!("{name} must be from 0 to {most}, found {found}")))
}
