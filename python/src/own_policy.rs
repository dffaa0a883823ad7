//! Policies that call a Python object: about one decision at a time, or about the decisions of many
//! days at once.

use std::sync::{Arc, Mutex};

use pyo3::prelude::*;
use vertifleet_core::VertiportIx;
use vertifleet_observe::{Observer, Scene};
use vertifleet_policy::{Policy, PolicyError};
use vertifleet_sim::{DayKey, Decision, View};

use crate::policy_source::OwnCalls;
use crate::whole_number::WholeNumber;

/// The data for calls of the Python object.
#[derive(Clone)]
pub(crate) struct Caller {
    /// Makes the function that chooses.
    pub(crate) make: Arc<Py<PyAny>>,
    /// Creates the observer of a new day.
    pub(crate) observer: Observer,
    /// The name of the policy in warnings.
    pub(crate) name: String,
    pub(crate) calls: OwnCalls,
}

impl Caller {
    fn new_observer(&self) -> Arc<Mutex<Observer>> {
        Arc::new(Mutex::new(self.observer.clone()))
    }

    /// Keeps the exception, which stops all play.
    fn stopped_by(&self, error: PyErr) -> PolicyError {
        self.calls.raise(error);
        PolicyError::Stopped
    }

    /// The choice that an action means. As in an environment, an infeasible action holds.
    fn feasible(&self, decision: &Decision, view: View<'_>, action: WholeNumber) -> VertiportIx {
        let feasible = view.feasible(decision);
        let asked = action.of::<u16>("what a policy returns").ok().map(VertiportIx);
        asked.filter(|&asked| feasible.contains(asked)).unwrap_or_else(|| {
            self.calls.count_infeasible(&self.name);
            decision.at
        })
    }
}

/// A policy that calls a function from a view to an action, which is created for each day.
pub(crate) struct OwnPolicy {
    caller: Caller,
    /// The day that is being played.
    playing: Option<Playing>,
}

struct Playing {
    day: DayKey,
    choose: Py<PyAny>,
    observer: Arc<Mutex<Observer>>,
}

impl OwnPolicy {
    pub(crate) fn new(caller: Caller) -> Self {
        Self { caller, playing: None }
    }

    fn ask(
        &mut self,
        py: Python<'_>,
        decision: &Decision,
        view: View<'_>,
    ) -> PyResult<VertiportIx> {
        let playing = match &self.playing {
            Some(playing) if playing.day == view.day() && decision.index > 0 => playing,
            _ => self.playing.insert(Playing {
                day: view.day(),
                choose: self.caller.make.call0(py)?,
                observer: self.caller.new_observer(),
            }),
        };
        let seen = crate::view::View::of(&Scene::of(view, decision), &playing.observer);
        let action: WholeNumber = playing.choose.call1(py, (seen,))?.extract(py)?;
        Ok(self.caller.feasible(decision, view, action))
    }
}

impl Policy for OwnPolicy {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        if self.caller.calls.have_raised() {
            return Err(PolicyError::Stopped);
        }
        Python::attach(|py| self.ask(py, decision, *view))
            .map_err(|error| self.caller.stopped_by(error))
    }
}

/// A policy that calls a function from many views to as many actions.
pub(crate) struct OwnBatchPolicy {
    caller: Caller,
    choose: Option<Py<PyAny>>,
    /// The observers of the days in play, and of some that are over.
    observers: Vec<(DayKey, Arc<Mutex<Observer>>)>,
}

impl OwnBatchPolicy {
    pub(crate) fn new(caller: Caller) -> Self {
        Self { caller, choose: None, observers: Vec::new() }
    }

    fn ask(
        &mut self,
        py: Python<'_>,
        asked: &[(Decision, View<'_>)],
    ) -> PyResult<Vec<VertiportIx>> {
        self.forget_days_other_than(asked);
        let mut seen = |(decision, view): &(Decision, View<'_>)| {
            let observer = self.observer(view.day(), decision.index == 0);
            crate::view::View::of(&Scene::of(*view, decision), &observer)
        };
        let seen: Vec<crate::view::View> = asked.iter().map(&mut seen).collect();
        let choose = match &self.choose {
            Some(choose) => choose,
            None => self.choose.insert(self.caller.make.call0(py)?),
        };
        // The Python side has checked that there is an action for each decision.
        let actions: Vec<WholeNumber> = choose.call1(py, (seen,))?.extract(py)?;
        let choice = |((decision, view), action): (&(Decision, View<'_>), WholeNumber)| {
            self.caller.feasible(decision, *view, action)
        };
        Ok(asked.iter().zip(actions).map(choice).collect())
    }

    fn forget_days_other_than(&mut self, asked: &[(Decision, View<'_>)]) {
        if self.observers.len() > 2 * asked.len() {
            let days: Vec<DayKey> = asked.iter().map(|(_, view)| view.day()).collect();
            self.observers.retain(|(day, _)| days.contains(day));
        }
    }

    /// The observer of a day, which is created when the day begins.
    fn observer(&mut self, day: DayKey, begins: bool) -> Arc<Mutex<Observer>> {
        if begins {
            self.observers.retain(|(known, _)| *known != day);
        }
        if let Some((_, observer)) = self.observers.iter().find(|(known, _)| *known == day) {
            return Arc::clone(observer);
        }
        let observer = self.caller.new_observer();
        self.observers.push((day, Arc::clone(&observer)));
        observer
    }
}

impl Policy for OwnBatchPolicy {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let mut choices = Vec::new();
        self.choose_batch(&mut std::iter::once((*decision, *view)), &mut choices)?;
        Ok(choices[0])
    }

    fn choose_batch(
        &mut self,
        asked: &mut dyn Iterator<Item = (Decision, View<'_>)>,
        choices: &mut Vec<VertiportIx>,
    ) -> Result<(), PolicyError> {
        let asked: Vec<(Decision, View<'_>)> = asked.collect();
        if asked.is_empty() {
            return Ok(());
        }
        if self.caller.calls.have_raised() {
            return Err(PolicyError::Stopped);
        }
        let chosen = Python::attach(|py| self.ask(py, &asked));
        choices.extend(chosen.map_err(|error| self.caller.stopped_by(error))?);
        Ok(())
    }
}
