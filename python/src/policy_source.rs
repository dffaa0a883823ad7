//! The values in Python that the name of a policy may refer to: a weight file, a model, or a function of the caller.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use pyo3::prelude::*;
use vertifleet_core::VertiportIx;
use vertifleet_observe::{Observer, Scene};
use vertifleet_policy::{Policy, PolicyError};
use vertifleet_sim::{DayKey, Decision, View};
use vertifleet_study::{PolicyFactory, PolicySource, Sees};

use crate::days::Days;
use crate::model::Model;
use crate::network::Network;
use crate::whole_number::WholeNumber;

/// Weights: a model, or the path of a weight file.
#[derive(FromPyObject)]
pub(crate) enum Weights<'py> {
    Model(PyRef<'py, Model>),
    Path(PathBuf),
}

impl From<Weights<'_>> for PolicySource {
    fn from(weights: Weights<'_>) -> Self {
        match weights {
            Weights::Model(model) => Self::Model(Arc::clone(&model.model)),
            Weights::Path(path) => Self::File(path),
        }
    }
}

/// What calls of the caller's own Python code leave behind, on whatever threads they were made.
#[derive(Clone, Default)]
pub(crate) struct OwnCalls(Arc<Mutex<Left>>);

#[derive(Default)]
struct Left {
    /// The first exception that was raised. It is raised again when all threads have stopped.
    raised: Option<PyErr>,
    /// Number of choices that were not feasible, by policy.
    infeasible: BTreeMap<String, u64>,
}

impl OwnCalls {
    fn lock(&self) -> MutexGuard<'_, Left> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Keeps an exception, if it is the first.
    pub(crate) fn raise(&self, error: PyErr) {
        self.lock().raised.get_or_insert(error);
    }

    /// The first exception.
    pub(crate) fn raised(&self) -> Option<PyErr> {
        self.lock().raised.take()
    }

    /// A warning about each policy that made choices that were not feasible.
    pub(crate) fn warnings(&self) -> Vec<String> {
        let text = |(name, count): (&String, &u64)| {
            let choices = if *count == 1 { "1 choice" } else { &format!("{count} choices") };
            format!("policy {name:?}: {choices} outside the mask; the aircraft held instead")
        };
        self.lock().infeasible.iter().map(text).collect()
    }
}

/// Converts a Python value into a policy source: weights, or a policy of the caller ([`of_own`]), which sees days as
/// days of `network`.
pub(crate) fn policy_source(
    value: &Bound<'_, PyAny>,
    name: &str,
    network: Option<&Network>,
    calls: &OwnCalls,
) -> PyResult<PolicySource> {
    if let Ok(weights) = value.extract::<Weights<'_>>() {
        return Ok(weights.into());
    }
    Ok(PolicySource::Own(of_own(value, name, network, calls)?))
}

/// A policy from a Python object: a function from an observation to an action, or an object that chooses. The Python
/// side of the package says which objects these are, and how views are shown to them.
pub(crate) fn of_own(
    value: &Bound<'_, PyAny>,
    name: &str,
    network: Option<&Network>,
    calls: &OwnCalls,
) -> PyResult<PolicyFactory> {
    let adapt = value.py().import("vertifleet._own_policy")?.getattr("adapted")?;
    let (make, shows_present_only, days): (Py<PyAny>, bool, Option<PyRef<'_, Days>>) =
        adapt.call1((value, network.cloned()))?.extract()?;
    let sees = if shows_present_only { Sees::Present } else { Sees::Forecast };
    let (make, calls) = (Arc::new(make), calls.clone());
    let name = name.to_owned();
    let observer = match (days, network) {
        (Some(days), _) => days.observer(),
        (None, Some(network)) => Observer::of(&network.network),
        (None, None) => Observer::default(),
    };
    let make_policy = move || -> Box<dyn Policy> {
        Box::new(OwnPolicy {
            make: Arc::clone(&make),
            choose: None,
            observer: Arc::new(Mutex::new(observer.clone())),
            name: name.clone(),
            calls: calls.clone(),
        })
    };
    Ok(PolicyFactory { make: Arc::new(make_policy), sees })
}

/// A policy that calls a Python object.
struct OwnPolicy {
    /// Makes the function from a view to an action, when a day begins.
    make: Arc<Py<PyAny>>,
    /// That function, and the day that it plays.
    choose: Option<(DayKey, Py<PyAny>)>,
    observer: Arc<Mutex<Observer>>,
    name: String,
    calls: OwnCalls,
}

impl Policy for OwnPolicy {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        Python::attach(|py| self.ask(py, decision, *view)).map_err(|error| {
            self.calls.raise(error);
            PolicyError::Stopped
        })
    }
}

impl OwnPolicy {
    /// Calls the function. As in an environment, an action that is not feasible holds.
    fn ask(
        &mut self,
        py: Python<'_>,
        decision: &Decision,
        view: View<'_>,
    ) -> PyResult<VertiportIx> {
        let seen = crate::view::View::of(&Scene::of(view, decision), &self.observer);
        let choose = match &self.choose {
            Some((day, choose)) if *day == view.day() && decision.index > 0 => choose,
            _ => &self.choose.insert((view.day(), self.make.call0(py)?)).1,
        };
        let action: WholeNumber = choose.call1(py, (seen,))?.extract(py)?;
        let feasible = view.feasible(decision);
        let asked = action.of::<u16>("what a policy returns").ok().map(VertiportIx);
        Ok(asked.filter(|&asked| feasible.contains(asked)).unwrap_or_else(|| {
            *self.calls.lock().infeasible.entry(self.name.clone()).or_default() += 1;
            decision.at
        }))
    }
}
