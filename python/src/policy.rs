//! `Policy`: one of the program's policies, which can be called for any decision.

use std::sync::{Mutex, PoisonError};

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use vertifleet_policy as policy;
use vertifleet_study::{Error, PolicySource, PolicySpec, ResolveFor, ResolvedPolicy};

use crate::failure::Failure;
use crate::policy_source::Weights;
use crate::view::View;
use crate::whole_number::WholeNumber;

/// One of the program's policies, which can be called for any decision:
/// `vertifleet.policy("rolling").values(env.view)`.
///
/// Called for the decisions of a day in order, it keeps the day's bid prices as in play, so it
/// makes the choices of `vertifleet simulate`.
#[pyclass(frozen, module = "vertifleet")]
pub(crate) struct Policy {
    name: String,
    resolved: ResolvedPolicy,
    /// It may contain state of the last day.
    built: Mutex<Box<dyn policy::Policy>>,
}

#[pymethods]
impl Policy {
    /// The policy's name.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// The information that it uses: "present", "forecast" or "whole day".
    #[getter]
    fn sees(&self) -> String {
        self.resolved.sees().to_string()
    }

    /// The position of the vertiport that it chooses.
    fn choose(&self, py: Python<'_>, view: &View) -> PyResult<u16> {
        let outcome = py.detach(|| {
            let scene = view.scene();
            let mut policy = self.built.lock().unwrap_or_else(PoisonError::into_inner);
            policy.choose(scene.decision(), &scene.view())
        });
        Ok(outcome.map_err(|error| self.stuck(&error))?.0)
    }

    /// The values by which it compares choices, the higher the better; NaN for a choice that it
    /// does not consider [N].
    fn values<'py>(&self, py: Python<'py>, view: &View) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let array = PyArray1::zeros(py, view.scene().sizes().vertiports, false);
        let mut guard = array.readwrite();
        let values = guard.as_slice_mut()?;
        let outcome = py.detach(|| {
            let scene = view.scene();
            let mut policy = self.built.lock().unwrap_or_else(PoisonError::into_inner);
            policy.values(scene.decision(), &scene.view(), values)
        });
        drop(guard);
        outcome.map_err(|error| self.stuck(&error))?;
        Ok(array)
    }

    fn __repr__(&self) -> String {
        format!("<Policy {}, sees {}>", self.name, self.resolved.sees())
    }
}

impl Policy {
    fn stuck(&self, error: &policy::PolicyError) -> Failure {
        Failure::argument(format!("policy {:?} has no answer: {error}", self.name))
    }
}

/// Finds a policy by its name, as `simulate` does. `network` is the name of the network whose
/// shipped weights are used, `seed` that of the random policy, and `model` a weight file or a
/// `Model`.
#[pyfunction]
#[pyo3(signature = (name, network, seed, model))]
pub(crate) fn find_policy(
    name: &str,
    network: &str,
    seed: WholeNumber,
    model: Option<Weights<'_>>,
) -> Result<Policy, Failure> {
    let source = model.map(PolicySource::from);
    let seed = seed.of("seed")?;
    let spec = PolicySpec::parse(name)?;
    if spec.is_planner() {
        let rule = "the planner plans the whole day in advance, and cannot take a single decision";
        return Err(Failure::hinted(rule.to_owned(), "vertifleet.plan plans a day".to_owned()));
    }
    let resolved = spec.resolve(source.as_ref(), ResolveFor::DaysOf(network), seed)?;
    let built = Mutex::new(resolved.build());
    Ok::<_, Error>(Policy { name: name.to_owned(), resolved, built }).map_err(Failure::from)
}
