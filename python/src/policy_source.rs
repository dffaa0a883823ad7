//! The values in Python that the name of a policy may refer to: a weight file, a model, or a function of the caller.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use vertifleet_core::VertiportIx;
use vertifleet_learn::Scales;
use vertifleet_policy::{Policy, PolicyError};
use vertifleet_sim::{Decision, View};
use vertifleet_study::{PolicyFactory, PolicySource};

use crate::failure::Failure;
use crate::model::Model;
use crate::observation::{Arrays, Observer};
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

/// The first exception that a function of the caller raised. It is raised again when all threads have stopped.
#[derive(Clone, Default)]
pub(crate) struct Raised(pub(crate) Arc<Mutex<Option<PyErr>>>);

impl Raised {
    pub(crate) fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Converts a Python value into a policy source: weights, or a function ([`of_function`]), which needs the scales of a
/// network.
pub(crate) fn policy_source(
    value: &Bound<'_, PyAny>,
    scales: Option<Scales>,
    raised: &Raised,
) -> PyResult<PolicySource> {
    match (value.extract::<Weights<'_>>(), scales) {
        (Ok(weights), _) => Ok(weights.into()),
        (Err(_), Some(scales)) if value.is_callable() => {
            Ok(PolicySource::Own(of_function(value, scales, raised)))
        }
        (Err(_), None) if value.is_callable() => {
            let message = "a function takes a network, as which it sees the days";
            Err(Failure::argument(message.to_owned()).into())
        }
        (Err(_), _) => Err(PyTypeError::new_err(
            "a model is a path, a vertifleet.Model, or a function from an observation to an action",
        )),
    }
}

/// A policy from a Python function that maps an observation, as the environment shows it, to an action.
pub(crate) fn of_function(
    function: &Bound<'_, PyAny>,
    scales: Scales,
    raised: &Raised,
) -> PolicyFactory {
    let (function, raised) = (Arc::new(function.clone().unbind()), raised.clone());
    PolicyFactory(Arc::new(move || {
        let (call, raised) = (Arc::clone(&function), raised.clone());
        Box::new(Function { call, scales, raised })
    }))
}

/// A policy that calls a Python function.
struct Function {
    call: Arc<Py<PyAny>>,
    scales: Scales,
    raised: Raised,
}

impl Policy for Function {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        Python::attach(|py| self.ask(py, decision, *view)).map_err(|error| {
            self.raised.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            PolicyError::Stopped
        })
    }
}

impl Function {
    /// Calls the function. An action that cannot be the position of a vertiport, such as a negative number, is an error
    /// here. Any other action that is not feasible is refused later by the simulation.
    fn ask(&self, py: Python<'_>, decision: &Decision, view: View<'_>) -> PyResult<VertiportIx> {
        let arrays = Arrays::of(py, decision, view, &self.scales, Observer::Deciding)?;
        let (observation, _) = arrays.into_observation(py)?;
        let answer = self.call.bind(py).call1((observation,))?;
        let action: WholeNumber = answer.extract()?;
        Ok(VertiportIx(action.of("what the function returns")?))
    }
}
