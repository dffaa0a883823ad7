//! The interface of every policy.

use vertifleet_core::{Time, VertiportIx};
use vertifleet_sim::{Decision, View};

use crate::{DayPrices, PriceMemory};

/// Decides where an aircraft flies next.
///
/// A choice depends on the decision, the view and the policy's own settings, and on nothing that
/// the policy did on another day. Days that are played from their first decision to their last
/// therefore have the same outcome in any order and on any number of threads. Most policies keep no
/// state and can also play many days in turn with the same outcome. A policy that looks ahead may
/// keep results of the day that it is playing ([`PriceMemory`](crate::PriceMemory)), to continue
/// from its earlier results; it must be able to start in the middle of any day without that memory.
pub trait Policy: Send {
    /// Chooses a vertiport of [`View::feasible`], where the aircraft's own vertiport means hold.
    ///
    /// # Errors
    /// [`PolicyError`] if the policy has no answer, as for example when it replays another day's
    /// trace.
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError>;

    /// Writes the numbers by which the policy compares choices, one for each vertiport, the higher
    /// the better; NaN for a choice that it does not consider. They are dollars, dollars an hour or
    /// logits, as each policy documents. A policy without such numbers, as by default, writes NaN
    /// for all.
    ///
    /// # Errors
    /// The errors of [`choose`](Self::choose).
    ///
    /// # Panics
    /// May panic unless there is a number for each vertiport.
    fn values(
        &mut self,
        _decision: &Decision,
        _view: &View<'_>,
        values: &mut [f64],
    ) -> Result<(), PolicyError> {
        values.fill(f64::NAN);
        Ok(())
    }

    /// Chooses, and writes the numbers by which the choices were compared, as
    /// [`values`](Self::values) does. Policies for which both are one computation carry it out
    /// once.
    ///
    /// # Errors
    /// The errors of [`choose`](Self::choose).
    ///
    /// # Panics
    /// May panic unless there is a number for each vertiport.
    fn choose_with_values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<VertiportIx, PolicyError> {
        self.values(decision, view, values)?;
        self.choose(decision, view)
    }

    /// The bid prices that it decides by, refreshed for this decision; `None` for a policy that has
    /// none, as by default.
    fn prices(&mut self, _decision: &Decision, _view: &View<'_>) -> Option<&DayPrices> {
        None
    }

    /// Its memory of bid prices, so that a service can recompute them in the background; `None` for
    /// a policy that has none, as by default.
    fn price_memory(&mut self) -> Option<&mut PriceMemory> {
        None
    }

    /// Chooses for many days at once, and pushes one choice for each decision. Learned policies
    /// answer a batch much faster than its parts; the other policies answer one by one.
    ///
    /// Views borrow their days, so a list of them could not outlive a step in which the days move
    /// on. Taking an iterator spares the caller from making a new list for every step.
    ///
    /// # Errors
    /// The errors of [`choose`](Self::choose), for the first decision that has no answer.
    fn choose_batch(
        &mut self,
        asked: &mut dyn Iterator<Item = (Decision, View<'_>)>,
        choices: &mut Vec<VertiportIx>,
    ) -> Result<(), PolicyError> {
        for (decision, view) in asked {
            choices.push(self.choose(&decision, &view)?);
        }
        Ok(())
    }
}

/// The reason why a policy has no answer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PolicyError {
    /// The policy was asked to stop.
    #[error("it was stopped")]
    Stopped,
    /// The trace ends before the day does.
    #[error("the trace has {rows} rows, but the day asks for another decision at {time}")]
    TraceTooShort {
        /// Number of rows of the trace.
        rows: usize,
        /// Time of the next decision.
        time: Time,
    },
    /// The trace's next row has another aircraft or another time than the decision.
    #[error(
        "row {row} of the trace is aircraft {found_aircraft:?} at {found_time}, but aircraft {aircraft:?} decides at {time}",
        found_aircraft = found.0, found_time = found.1, aircraft = asked.0, time = asked.1
    )]
    TraceOfAnotherDay {
        /// Number of the row, from 1 below the header.
        row: usize,
        /// Aircraft, by its id, and time of the row.
        found: (String, Time),
        /// Aircraft, by its id, and time of the decision.
        asked: (String, Time),
    },
}
