//! Plays a day to its end with one policy.

use vertifleet_sim::{Refusal, Simulation, TraceRow};

use crate::{Policy, PolicyError};

/// The reason why a day could not be played to its end.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PlayError {
    /// The policy has no answer.
    #[error(transparent)]
    NoAnswer(#[from] PolicyError),
    /// The policy chose outside the mask.
    #[error("the decision was refused: {0}")]
    Refused(#[from] Refusal),
}

/// Plays the rest of the day. `record` is called with every decision that was carried out, in
/// order.
///
/// # Errors
/// [`PlayError`] if the policy has no answer or an infeasible one. The day then stands at that
/// decision.
pub fn play<P: Policy + ?Sized>(
    simulation: &mut Simulation,
    policy: &mut P,
    mut record: impl FnMut(&TraceRow),
) -> Result<(), PlayError> {
    while let Some(decision) = simulation.next_decision() {
        let choice = policy.choose(&decision, &simulation.view())?;
        record(&simulation.apply(choice)?);
    }
    Ok(())
}
