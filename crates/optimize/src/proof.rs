//! A bound that is being proven while something else goes on, such as the search for a plan.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use vertifleet_core::Scenario;

use crate::{Bound, Error, Step, upper_bound_unless};

/// Minutes of the bound's slices, finest first; those after the first are for days that are too large for it.
const STEPS_MIN: [u32; 4] = [3, 5, 15, 60];

/// The finest bound that a day is not too large for, being proven on a thread of its own.
pub struct Proof {
    stopped: Arc<AtomicBool>,
    from: Receiver<Result<Bound, Error>>,
    outcome: Option<Result<Bound, Error>>,
}

impl Proof {
    /// Begins to prove.
    pub fn begin(scenario: &Arc<Scenario>) -> Self {
        let (to, from) = channel();
        let stopped = Arc::new(AtomicBool::new(false));
        let (scenario, flag) = (Arc::clone(scenario), Arc::clone(&stopped));
        // Not joined: whoever is in a hurry need not wait for it.
        std::thread::spawn(move || {
            if let Some(outcome) = finest_bound(&flag, &scenario).transpose() {
                // Nobody listens any more if the plan was stopped.
                let _ = to.send(outcome);
            }
        });
        Self { stopped, from, outcome: None }
    }

    /// Waits until it is proven, but no longer than `patience`; whether it has come to an end.
    ///
    /// # Panics
    /// If the thread that proves did.
    pub fn wait(&mut self, patience: Duration) -> bool {
        if self.outcome.is_none() {
            self.outcome = match self.from.recv_timeout(patience) {
                Ok(outcome) => Some(outcome),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => {
                    panic!("a proof ends with a bound or with an error")
                }
            };
        }
        self.outcome.is_some()
    }

    /// The bound, if it is proven by now.
    pub fn bound(&self) -> Option<&Bound> {
        self.outcome.as_ref()?.as_ref().ok()
    }

    /// What came of it; nothing if it has not come to an end.
    ///
    /// # Errors
    /// [`Error::TooManyFlights`] if the day is too large for any bound.
    pub fn outcome(mut self) -> Result<Option<Bound>, Error> {
        self.outcome.take().transpose()
    }
}

impl Drop for Proof {
    fn drop(&mut self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}

impl Bound {
    /// [`gap`] of a profit to this bound.
    pub fn gap(&self, profit_usd: f64) -> f64 {
        gap(self.upper_bound_usd(), profit_usd)
    }
}

/// Share of a bound by which a profit is below it; 0 where nothing can be earned.
pub fn gap(bound_usd: f64, profit_usd: f64) -> f64 {
    if bound_usd > 0.0 { (bound_usd - profit_usd) / bound_usd } else { 0.0 }
}

/// The bound with the finest slices that the day is not too large for.
fn finest_bound(stopped: &AtomicBool, scenario: &Scenario) -> Result<Option<Bound>, Error> {
    let bound = |minutes| upper_bound_unless(stopped, scenario, Step::from_minutes(minutes)?);
    let too_large = |outcome: &Result<Option<Bound>, Error>| {
        matches!(outcome, Err(Error::TooManyFlights { .. }))
    };
    let [finest, coarser @ ..] = STEPS_MIN;
    coarser.into_iter().fold(bound(finest), |outcome, minutes| {
        if too_large(&outcome) { bound(minutes) } else { outcome }
    })
}
