//! The values in Python that the name of a policy may refer to: a weight file, a model, or a
//! function of the caller.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use pyo3::prelude::*;
use vertifleet_core as core;
use vertifleet_observe::Observer;
use vertifleet_policy::Policy;
use vertifleet_study::{Error, PolicyFactory, PolicySource, Sees};

use crate::days::Days;
use crate::failure::Failure;
use crate::model::Model;
use crate::network::Network;
use crate::own_policy::{Caller, OwnBatchPolicy, OwnPolicy};

/// Weights: a model, or the path of a weight file.
#[derive(FromPyObject)]
pub(crate) enum Weights<'py> {
    Model(PyRef<'py, Model>),
    Path(PathBuf),
}

impl Weights<'_> {
    /// The model, read from its file if only the path is known.
    pub(crate) fn model(&self) -> Result<Arc<vertifleet_learn::Model>, Failure> {
        match self {
            Self::Model(model) => Ok(Arc::clone(&model.model)),
            Self::Path(path) => Ok(Arc::new(vertifleet_learn::Model::read(path)?)),
        }
    }

    /// The path of the file, if that is what was given.
    pub(crate) fn path(&self) -> Option<&Path> {
        match self {
            Self::Model(_) => None,
            Self::Path(path) => Some(path),
        }
    }
}

impl From<Weights<'_>> for PolicySource {
    fn from(weights: Weights<'_>) -> Self {
        match weights {
            Weights::Model(model) => Self::Model(Arc::clone(&model.model)),
            Weights::Path(path) => Self::File(path),
        }
    }
}

/// What calls of the caller's own Python code leave behind, on whichever threads they were made.
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

    /// Whether an exception was raised, after which no function is called any more.
    pub(crate) fn have_raised(&self) -> bool {
        self.lock().raised.is_some()
    }

    /// The outcome of work that made these calls: an exception that one of them raised goes before
    /// an error.
    pub(crate) fn answered<T>(&self, outcome: Result<T, Error>) -> PyResult<T> {
        match self.raised() {
            Some(error) => Err(error),
            None => Ok(outcome.map_err(Failure::from)?),
        }
    }

    /// Counts a choice that was not feasible.
    pub(crate) fn count_infeasible(&self, policy: &str) {
        *self.lock().infeasible.entry(policy.to_owned()).or_default() += 1;
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

/// Converts a Python value into a policy source: weights, or a policy of the caller ([`of_own`]),
/// which sees days as days of `network`.
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

/// A policy from a Python object: a function from an observation to an action, or an object that
/// chooses. The Python side of the package says which objects these are, and how views are shown to
/// them.
pub(crate) fn of_own(
    value: &Bound<'_, PyAny>,
    name: &str,
    network: Option<&Network>,
    calls: &OwnCalls,
) -> PyResult<PolicyFactory> {
    let adapt = value.py().import("vertifleet._own_policy")?.getattr("adapted")?;
    let (make, shows_present_only, days, in_batches): (
        Py<PyAny>,
        bool,
        Option<PyRef<'_, Days>>,
        bool,
    ) = adapt.call1((value, network.cloned()))?.extract()?;
    let sees = if shows_present_only { Sees::Present } else { Sees::Forecast };
    let observer = match (days, network) {
        (Some(days), _) => days.observer(),
        (None, Some(network)) => Observer::of(&network.network),
        (None, None) => Observer::default(),
    };
    let of_value = (value.clone().unbind(), name.to_owned(), calls.clone());
    let on = move |network: &core::Network| {
        let (value, name, calls) = &of_value;
        let of_network = |py: Python<'_>| {
            let network = Network::of(network.clone(), network.name().to_owned());
            of_own(value.bind(py), name, Some(&network), calls)
        };
        Python::attach(of_network).map_err(|error| {
            calls.raise(error);
            Error::Stopped
        })
    };
    let caller =
        Caller { make: Arc::new(make), observer, name: name.to_owned(), calls: calls.clone() };
    let make_policy = move || -> Box<dyn Policy> {
        if in_batches {
            Box::new(OwnBatchPolicy::new(caller.clone()))
        } else {
            Box::new(OwnPolicy::new(caller.clone()))
        }
    };
    let identity = identity(value)?;
    Ok(PolicyFactory { identity, make: Arc::new(make_policy), on: Arc::new(on), sees, in_batches })
}

/// The name of a function or class, or of the class of an object, whose `repr` would differ from
/// run to run.
fn identity(value: &Bound<'_, PyAny>) -> PyResult<String> {
    match value.getattr("__qualname__") {
        Ok(name) => name.extract(),
        Err(_) => value.get_type().getattr("__qualname__")?.extract(),
    }
}
