//! What a policy's name may stand for: a weight file, a model, or a function of the caller's own.

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

/// Weights: a model, or the path of a file.
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

/// What a function of the caller's raised, to be raised again once all threads have stopped.
#[derive(Clone, Default)]
pub(crate) struct Raised(pub(crate) Arc<Mutex<Option<PyErr>>>);

impl Raised {
    pub(crate) fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// What a value in Python stands for: weights, or a function ([`of_function`]), which takes the scales of a network.
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

/// A function from an observation, as the environment shows it, to an action.
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

/// A policy that is a function in Python.
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
    /// An action that no vertiport has is an error here; one that is not feasible is refused by the day.
    fn ask(&self, py: Python<'_>, decision: &Decision, view: View<'_>) -> PyResult<VertiportIx> {
        let arrays = Arrays::of(py, decision, view, &self.scales, Observer::Deciding)?;
        let (observation, _) = arrays.into_observation(py)?;
        let answer = self.call.bind(py).call1((observation,))?;
        let action: WholeNumber = answer.extract()?;
        Ok(VertiportIx(action.of("what the function returns")?))
    }
}
