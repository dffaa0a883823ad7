//! The one interface behind which every way of deciding stands.

use vertifleet_core::{Time, VertiportIx};
use vertifleet_sim::{Decision, View};

/// Decides where an aircraft flies next.
///
/// A choice depends on the decision, the view and the policy's own settings, and on nothing that the policy did on another
/// day. So days that are played from their first decision to their last have the same outcome in any order, on any number
/// of threads. Most policies remember nothing, and can play many days by turns with that outcome too. One that looks
/// ahead may remember the day it is playing ([`DayMemory`](crate::DayMemory)), to go on from what it worked out before; it
/// must be able to take up any day in its middle without.
pub trait Policy: Send {
    /// Chooses a vertiport of [`View::feasible`]; the aircraft's own vertiport means hold.
    ///
    /// # Errors
    /// [`PolicyError`] if the policy has no answer, as a replay of another day's trace has none.
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError>;

    /// Chooses for many days at once, one choice pushed per decision asked. Learned policies answer a batch much
    /// faster than its parts; the rest answer one by one.
    ///
    /// Views borrow their days, so a list of them cannot outlive a step in which the days move on; an iterator spares
    /// the caller to make one anew for every step.
    ///
    /// # Errors
    /// As [`choose`](Self::choose), for the first decision that has no answer.
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

/// A policy that has no answer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PolicyError {
    /// The caller asked to stop.
    #[error("it was stopped")]
    Stopped,
    /// The trace ends before the day does.
    #[error("the trace has {rows} rows, but the day asks for another decision at {time}")]
    TraceTooShort {
        /// Rows of the trace.
        rows: usize,
        /// When the day asks.
        time: Time,
    },
    /// The trace's next row is about another aircraft or another time.
    #[error(
        "row {row} of the trace is aircraft {found_aircraft:?} at {found_time}, but aircraft {aircraft:?} decides at {time}",
        found_aircraft = found.0, found_time = found.1, aircraft = asked.0, time = asked.1
    )]
    TraceOfAnotherDay {
        /// Row, counted from 1 below the header.
        row: usize,
        /// What the row says; the aircraft by its id.
        found: (String, Time),
        /// What the day asks; the aircraft by its id.
        asked: (String, Time),
    },
}
