//! The values in Python that the name of a policy may refer to: a weight file, a model, or a function of the caller.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use pyo3::prelude::*;
use vertifleet_core::VertiportIx;
use vertifleet_observe::{Observer, Scene};
use vertifleet_policy::{Policy, PolicyError};
use vertifleet_sim::{DayKey, Decision, View};
use vertifleet_study::{Error, PolicyFactory, PolicySource, Sees};

use crate::days::Days;
use crate::failure::Failure;
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

    /// The outcome of work that made these calls: an exception that one of them raised goes before an error.
    pub(crate) fn answered<T>(&self, outcome: Result<T, Error>) -> PyResult<T> {
        match self.raised() {
            Some(error) => Err(error),
            None => Ok(outcome.map_err(Failure::from)?),
        }
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
    let (make, shows_present_only, days, in_batches): (
        Py<PyAny>,
        bool,
        Option<PyRef<'_, Days>>,
        bool,
    ) = adapt.call1((value, network.cloned()))?.extract()?;
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
            observers: Vec::new(),
            observer: observer.clone(),
            in_batches,
            name: name.clone(),
            calls: calls.clone(),
        })
    };
    Ok(PolicyFactory { make: Arc::new(make_policy), sees, in_batches })
}

/// A policy that calls a Python object.
struct OwnPolicy {
    /// Makes the function from a view to an action when a day begins, or the one from many views to as many actions.
    make: Arc<Py<PyAny>>,
    /// That function, and the day that it plays.
    choose: Option<(DayKey, Py<PyAny>)>,
    /// What observes each day that is being played, and some that are over.
    observers: Vec<(DayKey, Arc<Mutex<Observer>>)>,
    /// What observes a new day.
    observer: Observer,
    in_batches: bool,
    name: String,
    calls: OwnCalls,
}

impl Policy for OwnPolicy {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        if self.in_batches {
            let mut choices = Vec::new();
            self.choose_batch(&mut std::iter::once((*decision, *view)), &mut choices)?;
            return Ok(choices[0]);
        }
        Python::attach(|py| self.ask(py, decision, *view)).map_err(|error| self.stopped_by(error))
    }

    fn choose_batch(
        &mut self,
        asked: &mut dyn Iterator<Item = (Decision, View<'_>)>,
        choices: &mut Vec<VertiportIx>,
    ) -> Result<(), PolicyError> {
        if !self.in_batches {
            for (decision, view) in asked {
                choices.push(self.choose(&decision, &view)?);
            }
            return Ok(());
        }
        let asked: Vec<(Decision, View<'_>)> = asked.collect();
        if asked.is_empty() {
            return Ok(());
        }
        let chosen = Python::attach(|py| self.ask_many(py, &asked));
        choices.extend(chosen.map_err(|error| self.stopped_by(error))?);
        Ok(())
    }
}

impl OwnPolicy {
    fn stopped_by(&self, error: PyErr) -> PolicyError {
        self.calls.raise(error);
        PolicyError::Stopped
    }

    /// What observes the day of a view.
    fn observer(&mut self, view: View<'_>, begins: bool) -> Arc<Mutex<Observer>> {
        let day = view.day();
        if begins {
            self.observers.retain(|(known, _)| *known != day);
        }
        if let Some((_, observer)) = self.observers.iter().find(|(known, _)| *known == day) {
            return Arc::clone(observer);
        }
        if !self.in_batches {
            self.observers.clear();
        }
        let observer = Arc::new(Mutex::new(self.observer.clone()));
        self.observers.push((day, Arc::clone(&observer)));
        observer
    }

    fn seen(&mut self, decision: &Decision, view: View<'_>) -> crate::view::View {
        let observer = self.observer(view, decision.index == 0);
        crate::view::View::of(&Scene::of(view, decision), &observer)
    }

    /// Calls the function. As in an environment, an action that is not feasible holds.
    fn ask(
        &mut self,
        py: Python<'_>,
        decision: &Decision,
        view: View<'_>,
    ) -> PyResult<VertiportIx> {
        let seen = self.seen(decision, view);
        let choose = match &self.choose {
            Some((day, choose)) if *day == view.day() && decision.index > 0 => choose,
            _ => &self.choose.insert((view.day(), self.make.call0(py)?)).1,
        };
        let action: WholeNumber = choose.call1(py, (seen,))?.extract(py)?;
        Ok(self.feasible(decision, view, action))
    }

    /// Calls the function for many decisions at once.
    fn ask_many(
        &mut self,
        py: Python<'_>,
        asked: &[(Decision, View<'_>)],
    ) -> PyResult<Vec<VertiportIx>> {
        if self.observers.len() > 2 * asked.len() {
            let days: Vec<DayKey> = asked.iter().map(|(_, view)| view.day()).collect();
            self.observers.retain(|(day, _)| days.contains(day));
        }
        let seen: Vec<crate::view::View> =
            asked.iter().map(|(decision, view)| self.seen(decision, *view)).collect();
        if self.choose.is_none() {
            self.choose = Some((asked[0].1.day(), self.make.call0(py)?));
        }
        let (_, choose) = self.choose.as_ref().expect("it was made just now");
        // The Python side has checked that there is an action for each decision.
        let actions: Vec<WholeNumber> = choose.call1(py, (seen,))?.extract(py)?;
        let pairs = asked.iter().zip(actions);
        Ok(pairs.map(|((decision, view), action)| self.feasible(decision, *view, action)).collect())
    }

    fn feasible(&self, decision: &Decision, view: View<'_>, action: WholeNumber) -> VertiportIx {
        let feasible = view.feasible(decision);
        let asked = action.of::<u16>("what a policy returns").ok().map(VertiportIx);
        asked.filter(|&asked| feasible.contains(asked)).unwrap_or_else(|| {
            *self.calls.lock().infeasible.entry(self.name.clone()).or_default() += 1;
            decision.at
        })
    }
}
