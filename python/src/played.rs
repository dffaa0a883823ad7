//! `simulate`: plays a day with one policy.

use std::sync::Arc;

use pyo3::prelude::*;
use vertifleet_core as core;
use vertifleet_sim::DayTotals;
use vertifleet_study::{Error, PolicySource, PolicySpec, ResolveFor, ResolvedPolicy};

use crate::failure::{Failure, warn};
use crate::frames::plain;
use crate::interruptible::interruptible;
use crate::model::Model;
use crate::network::Network;
use crate::pickle::{Reduced, reduced};
use crate::picture::Picture;
use crate::policy_source::{OwnCalls, Weights, of_own};
use crate::scenario::Scenario;
use crate::trace::Trace;
use crate::whole_number::WholeNumber;

/// A day that was played to its end.
#[pyclass(frozen, module = "vertifleet")]
pub(crate) struct Played {
    totals: DayTotals,
    trace: Trace,
}

#[pymethods]
impl Played {
    /// Profit of the day, dollars.
    #[getter]
    fn profit_usd(&self) -> f64 {
        self.totals.profit_usd
    }

    /// The results of the day, as `vertifleet simulate --json` prints them, in dollars, kWh and
    /// counts.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.totals)
    }

    /// The trace with every decision of the day.
    #[getter]
    fn trace(&self) -> Trace {
        self.trace.clone()
    }

    /// The trace as a picture.
    fn plot(&self, py: Python<'_>) -> Picture {
        self.trace.plot(py)
    }

    fn _repr_svg_(&self, py: Python<'_>) -> String {
        self.trace.plot(py).text
    }

    /// Restores a pickled object by replaying a trace of a whole day.
    #[staticmethod]
    fn of_trace(trace: &Trace) -> Result<Self, Failure> {
        let policy = ResolvedPolicy::Replay(Arc::clone(&trace.trace));
        let (_, totals) = policy.play("replay", &trace.scenario, &core::Stop::default())?;
        Ok(Self { totals, trace: trace.clone() })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Reduced<'py, (Trace,)> {
        reduced::<Self, _>(py, "of_trace", (self.trace.clone(),))
    }

    fn __repr__(&self) -> String {
        let DayTotals { profit_usd, flights, holds, .. } = self.totals;
        let day = &self.trace.scenario.name;
        format!("<Played {day}: profit ${profit_usd:.2}, {flights} flights, {holds} holds>")
    }
}

/// The name of a policy of the caller in messages.
const OWN: &str = "function";

/// The policy that plays the day.
#[derive(FromPyObject)]
pub(crate) enum Player<'py> {
    Named(String),
    Model(PyRef<'py, Model>),
    Trace(PyRef<'py, Trace>),
    Function(Bound<'py, PyAny>),
}

/// Plays a day to its end with a policy. The policy is one of the following: a name as in
/// `vertifleet simulate`, with `seed` for the random policy and `model` for a weight file or a
/// `Model` to use instead of the shipped weights; a `Model`; a `Trace` of this day, which is
/// replayed; or a function as for `compare`, which observes the day as in the environment of
/// `network`.
#[pyfunction]
#[pyo3(
    signature = (scenario, policy = Player::Named("greedy".to_owned()), *, seed = WholeNumber::from(0), model = None, network = None),
    text_signature = "(scenario, policy='greedy', *, seed=0, model=None, network=None)"
)]
pub(crate) fn simulate(
    py: Python<'_>,
    scenario: &Scenario,
    policy: Player<'_>,
    seed: WholeNumber,
    model: Option<Weights<'_>>,
    network: Option<PyRef<'_, Network>>,
) -> PyResult<Played> {
    let day = &scenario.scenario;
    let seed = seed.of("seed")?;
    match (policy, model, network) {
        (Player::Trace(trace), None, None) => {
            played(py, day, "replay", ResolvedPolicy::Replay(Arc::clone(&trace.trace)))
        }
        (Player::Model(model), None, None) => {
            let source = PolicySource::Model(Arc::clone(&model.model));
            by_name(py, day, model.model.kind(), Some(&source), seed)
        }
        (Player::Named(name), model, None) => {
            by_name(py, day, &name, model.map(PolicySource::from).as_ref(), seed)
        }
        (Player::Function(function), None, network) => {
            if let Some(network) = &network {
                network.check_fits(day)?;
            }
            let calls = OwnCalls::default();
            let policy = of_own(&function, OWN, network.as_deref(), &calls)?;
            let played = played(py, day, OWN, ResolvedPolicy::Own(policy));
            for warning in calls.warnings() {
                warn(py, &warning)?;
            }
            calls.raised().map_or(played, Err)
        }
        _ => {
            let message = "only a function takes network=, whose observations it gets; only a name takes model=";
            Err(Failure::argument(message.to_owned()).into())
        }
    }
}

fn by_name(
    py: Python<'_>,
    day: &Arc<core::Scenario>,
    name: &str,
    source: Option<&PolicySource>,
    seed: u64,
) -> PyResult<Played> {
    let resolve = || {
        let policy = PolicySpec::parse(name)?.resolve(source, ResolveFor::Day(day), seed)?;
        policy.check_fits(day)?;
        Ok::<_, Error>(policy)
    };
    let policy = resolve().map_err(Failure::from)?;
    if let Some(warning) = policy.warning_for(name, day) {
        warn(py, &warning)?;
    }
    played(py, day, name, policy)
}

fn played(
    py: Python<'_>,
    day: &Arc<core::Scenario>,
    name: &str,
    policy: ResolvedPolicy,
) -> PyResult<Played> {
    let (scenario, name) = (Arc::clone(day), name.to_owned());
    let outcome = interruptible(py, 1, move |stop| {
        let (trace, totals) = policy.play(&name, &scenario, stop)?;
        Ok::<_, Error>(Played { totals, trace: Trace { scenario, trace: Arc::new(trace) } })
    })?;
    Ok(outcome.map_err(Failure::from)?)
}
