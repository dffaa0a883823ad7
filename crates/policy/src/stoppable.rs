//! A policy that answers until it is asked to stop, so that a day that is being played can be
//! stopped.

use vertifleet_core::{Stop, VertiportIx};
use vertifleet_sim::{Decision, View};

use crate::{Policy, PolicyError};

/// Answers like another policy until a stop is requested, and with [`PolicyError::Stopped`] from
/// then on.
pub struct Stoppable<'a, P: ?Sized> {
    /// The policy that answers.
    pub policy: &'a mut P,
    /// The handle that requests the stop, from any thread.
    pub stop: &'a Stop,
}

impl<P: Policy + ?Sized> Policy for Stoppable<'_, P> {
    #[inline]
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        if self.stop.is_requested() {
            return Err(PolicyError::Stopped);
        }
        self.policy.choose(decision, view)
    }

    fn values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<(), PolicyError> {
        self.policy.values(decision, view, values)
    }

    fn choose_with_values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<VertiportIx, PolicyError> {
        if self.stop.is_requested() {
            return Err(PolicyError::Stopped);
        }
        self.policy.choose_with_values(decision, view, values)
    }
}
