//! `simulate`: a day played with one policy.

use std::sync::Arc;

use pyo3::prelude::*;
use vertifleet_policy::{Replay, Stoppable, play};
use vertifleet_sim::{self as sim, Simulation, Summary};
use vertifleet_study::Error;
use vertifleet_study::policies::{Choice, for_scenario};

use crate::failure::Failure;
use crate::frames::plain;
use crate::given::Weighed;
use crate::interruptible::interruptible;
use crate::pickle::{Reduced, reduced};
use crate::scenario::Scenario;
use crate::trace::Trace;

/// A day that was played to its end.
#[pyclass(frozen, module = "vertifleet")]
pub(crate) struct Played {
    summary: Summary,
    trace: Trace,
}

#[pymethods]
impl Played {
    /// Profit of the day, dollars.
    #[getter]
    fn profit_usd(&self) -> f64 {
        self.summary.profit
    }

    /// The day's numbers, as `vertifleet simulate --json` prints them: dollars, kWh, counts.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.summary)
    }

    /// Every decision.
    #[getter]
    fn trace(&self) -> Trace {
        self.trace.clone()
    }

    /// The day of a trace that was played to its end: what pickle makes.
    #[staticmethod]
    fn of_trace(trace: &Trace) -> Result<Self, Failure> {
        let mut simulation = Simulation::new(Arc::clone(&trace.scenario));
        play(&mut simulation, &mut Replay::new(Arc::clone(&trace.trace)), |_| ())
            .map_err(|cause| Error::of_play("replay", &trace.scenario.name, cause))?;
        Ok(Self { summary: simulation.summary(), trace: trace.clone() })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Reduced<'py, (Trace,)> {
        reduced::<Self, _>(py, "of_trace", (self.trace.clone(),))
    }

    fn __repr__(&self) -> String {
        let Summary { profit, flights, holds, .. } = self.summary;
        let day = &self.trace.scenario.name;
        format!("<Played {day}: profit ${profit:.2}, {flights} flights, {holds} holds>")
    }
}

/// Plays a day to its end with a policy, named as `vertifleet simulate` names it; `seed` is that of the random policy, `model` a
/// weight file or a `Model` in place of the shipped weights.
#[pyfunction]
#[pyo3(signature = (scenario, policy = "greedy", *, seed = 0, model = None))]
pub(crate) fn simulate(
    py: Python<'_>,
    scenario: &Scenario,
    policy: &str,
    seed: u64,
    model: Option<Weighed<'_>>,
) -> PyResult<Played> {
    let day = &scenario.scenario;
    let given = model.map(Weighed::given);
    let choice = Choice { name: policy, seed, model: given.as_ref() };
    let (recipe, warning) = for_scenario(&choice, day).map_err(Failure::from)?;
    if let Some(warning) = warning {
        crate::failure::warn(py, &warning)?;
    }
    let played = Arc::clone(day);
    let outcome = interruptible(py, 1, move |stop| {
        let mut simulation = Simulation::new(played);
        let mut trace = sim::Trace::default();
        let mut policy = recipe.make();
        let mut stoppable = Stoppable { policy: policy.as_mut(), stop };
        play(&mut simulation, &mut stoppable, |row| trace.rows.push(*row))
            .map(|()| (simulation.summary(), trace))
    })?;
    let (summary, trace) =
        outcome.map_err(|cause| Failure::from(Error::of_play(policy, &day.name, cause)))?;
    let trace = Trace { scenario: Arc::clone(day), trace: Arc::new(trace) };
    Ok(Played { summary, trace })
}
