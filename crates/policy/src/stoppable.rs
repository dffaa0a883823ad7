//! A policy that answers until it is asked to stop: how a day that is being played is stopped.

use vertifleet_core::{Stop, VertiportIx};
use vertifleet_sim::{Decision, View};

use crate::{Policy, PolicyError};

/// Another policy, as long as the flag is not raised; [`PolicyError::Stopped`] from then on.
pub struct Stoppable<'a, P: ?Sized> {
    /// Who answers.
    pub policy: &'a mut P,
    /// Raised, from any thread, to stop.
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
}
