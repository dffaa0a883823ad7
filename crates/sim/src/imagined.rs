//! The rest of a day as a policy may imagine it at a decision, to play out the consequences of a
//! choice.

use vertifleet_core::VertiportIx;

use crate::{DayTotals, Decision, Ledger, Refusal, Simulation, TraceRow, View};

/// A day that continues from a decision as expected: demand comes as forecast, aircraft are ready
/// when they are expected to be, and known closures begin and end at their times. A flight is as
/// late as the latest one that left the same vertiport in the same quarter of an hour, and on time
/// if none has. Unknown closures no longer begin, and those in force stay in force. An imagined day
/// is made by [`View::imagined`]. The day that it was made from does not change, and the imagined
/// day reveals nothing that is not known yet.
///
/// [`Clone::clone_from`] copies one imagined day into the memory of another, and allocates none if
/// both are of the same day.
#[derive(Debug)]
pub struct Imagined(Simulation);

impl Clone for Imagined {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }

    fn clone_from(&mut self, other: &Self) {
        self.0.clone_from(&other.0);
    }
}

impl Imagined {
    pub(crate) fn of(day: &Simulation) -> Self {
        Self::of_expected(day.clone().without_surprises())
    }

    /// A day that goes on as expected already.
    pub(crate) fn of_expected(mut day: Simulation) -> Self {
        day.delays.expect();
        Self(day)
    }

    pub(crate) fn restart(&mut self, day: &Simulation) {
        self.0.clone_from(day);
        self.0.expect_no_surprises();
        self.0.delays.expect();
    }

    /// The same as [`Simulation::next_decision`].
    #[inline]
    pub fn next_decision(&mut self) -> Option<Decision> {
        self.0.next_decision()
    }

    /// The same as [`Simulation::apply`].
    ///
    /// # Errors
    /// [`Refusal`] names the rule that the choice breaks; nothing has changed then.
    #[inline]
    pub fn apply(&mut self, choice: VertiportIx) -> Result<TraceRow, Refusal> {
        self.0.apply(choice)
    }

    /// The view of a policy.
    #[inline]
    pub fn view(&self) -> View<'_> {
        self.0.view()
    }

    /// The numbers of the real day so far and of the imagined one since.
    pub fn totals(&self) -> DayTotals {
        self.0.totals()
    }

    /// The account of the real day so far and of the imagined one since.
    #[inline]
    pub fn ledger(&self) -> &Ledger {
        self.0.ledger()
    }
}
