//! `simulate`: a day played with one policy.

use std::sync::Arc;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use vertifleet_core as core;
use vertifleet_learn::Scales;
use vertifleet_policy::{Replay, Stoppable, play};
use vertifleet_sim::{self as sim, DayTotals, Simulation};
use vertifleet_study::Error;
use vertifleet_study::policies::{Choice, Given, Recipe, for_scenario};

use crate::failure::Failure;
use crate::frames::plain;
use crate::given::{Raised, Weighed, own};
use crate::interruptible::interruptible;
use crate::model::Model;
use crate::network::Network;
use crate::pickle::{Reduced, reduced};
use crate::scenario::Scenario;
use crate::trace::Trace;
use crate::whole::Whole;

/// A day that was played to its end.
#[pyclass(frozen, module = "vertifleet")]
pub(crate) struct Played {
    summary: DayTotals,
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
        let DayTotals { profit, flights, holds, .. } = self.summary;
        let day = &self.trace.scenario.name;
        format!("<Played {day}: profit ${profit:.2}, {flights} flights, {holds} holds>")
    }
}

/// Who is to play.
#[derive(FromPyObject)]
pub(crate) enum Player<'py> {
    Named(String),
    Model(PyRef<'py, Model>),
    Trace(PyRef<'py, Trace>),
    Function(Bound<'py, PyAny>),
}

/// Plays a day to its end with a policy: one named as `vertifleet simulate` names it, where `seed` is that of the random policy and
/// `model` a weight file or a `Model` in place of the shipped weights; a `Model`; a `Trace` of this day, played again; or a function of
/// the caller's own, as `compare` takes it, which sees the day as the environment of `network` shows it.
#[pyfunction]
#[pyo3(
    signature = (scenario, policy = Player::Named("greedy".to_owned()), *, seed = Whole::from(0), model = None, network = None),
    text_signature = "(scenario, policy='greedy', *, seed=0, model=None, network=None)"
)]
pub(crate) fn simulate(
    py: Python<'_>,
    scenario: &Scenario,
    policy: Player<'_>,
    seed: Whole,
    model: Option<Weighed<'_>>,
    network: Option<PyRef<'_, Network>>,
) -> PyResult<Played> {
    let day = &scenario.scenario;
    let seed = seed.of("seed")?;
    match (policy, model, network) {
        (Player::Trace(trace), None, None) => {
            let recipe = Recipe::Replay(Arc::clone(&trace.trace));
            played(py, day, "replay".to_owned(), recipe)
        }
        (Player::Model(model), None, None) => {
            let given = Given::Model(Arc::clone(&model.model));
            by_name(py, day, &Choice { name: model.model.kind(), seed, model: Some(&given) })
        }
        (Player::Named(name), model, None) => {
            let given = model.map(Weighed::given);
            by_name(py, day, &Choice { name: &name, seed, model: given.as_ref() })
        }
        (Player::Function(function), ..) if !function.is_callable() => Err(PyTypeError::new_err(
            "a policy is a name, a vertifleet.Model, a vertifleet.Trace, or a function from an observation to an action",
        )),
        (Player::Function(function), None, Some(network)) => {
            network.check_fits(day)?;
            let raised = Raised::default();
            let maker = own(&function, Scales::from(network.network.feature_scales()), &raised);
            let played = played(py, day, "function".to_owned(), Recipe::Own(maker));
            raised.take().map_or(played, Err)
        }
        _ => {
            let message = "a function takes network=, as which it sees the day, and nothing else does; a name alone takes model=";
            Err(Failure::argument(message.to_owned()).into())
        }
    }
}

fn by_name(py: Python<'_>, day: &Arc<core::Scenario>, choice: &Choice<'_>) -> PyResult<Played> {
    let (recipe, warning) = for_scenario(choice, day).map_err(Failure::from)?;
    if let Some(warning) = warning {
        crate::failure::warn(py, &warning)?;
    }
    played(py, day, choice.name.to_owned(), recipe)
}

fn played(
    py: Python<'_>,
    day: &Arc<core::Scenario>,
    name: String,
    recipe: Recipe,
) -> PyResult<Played> {
    let scenario = Arc::clone(day);
    let outcome = interruptible(py, 1, move |stop| {
        let mut simulation = Simulation::new(Arc::clone(&scenario));
        let mut trace = sim::Trace::default();
        let mut policy = recipe.make();
        let mut stoppable = Stoppable { policy: policy.as_mut(), stop };
        play(&mut simulation, &mut stoppable, |row| trace.rows.push(*row))
            .map_err(|cause| Error::of_play(&name, &scenario.name, cause))?;
        let trace = Trace { scenario, trace: Arc::new(trace) };
        Ok::<_, Error>(Played { summary: simulation.summary(), trace })
    })?;
    Ok(outcome.map_err(Failure::from)?)
}
