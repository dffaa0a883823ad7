//! A decision with the view of the day at that moment.

use vertifleet_core::TypeIx;
use vertifleet_sim::{Decision, VertiportSet, View};

use crate::Sizes;

/// A decision, and the state of the day that its observation needs.
#[derive(Debug, Clone, Copy)]
pub struct Scene<'a> {
    pub(crate) view: View<'a>,
    pub(crate) decision: &'a Decision,
    pub(crate) feasible: VertiportSet,
    pub(crate) over: bool,
}

impl<'a> Scene<'a> {
    /// A decision that is pending.
    pub fn of(view: View<'a>, decision: &'a Decision) -> Self {
        Self { view, decision, feasible: view.feasible(decision), over: false }
    }

    /// The view of an aircraft that does not decide now, from the vertiport where it stands or will
    /// land: only hold is feasible.
    pub fn waiting(view: View<'a>, decision: &'a Decision) -> Self {
        let mut feasible = VertiportSet::EMPTY;
        feasible.insert(decision.at);
        Self { view, decision, feasible, over: false }
    }

    /// A finished day in the view of the aircraft that decided last: only hold is feasible, and no
    /// time is left.
    pub fn over(view: View<'a>, decision: &'a Decision) -> Self {
        Self { over: true, ..Self::waiting(view, decision) }
    }

    /// The view of the day.
    pub fn view(&self) -> View<'a> {
        self.view
    }

    /// The decision.
    pub fn decision(&self) -> &'a Decision {
        self.decision
    }

    /// Whether the day is over.
    pub fn is_over(&self) -> bool {
        self.over
    }

    /// The feasible choices.
    pub fn feasible(&self) -> VertiportSet {
        self.feasible
    }

    /// The sizes of the day.
    pub fn sizes(&self) -> Sizes {
        Sizes {
            vertiports: self.view.vertiports(),
            aircraft: self.view.places().len(),
            types: self.view.aircraft_types().len(),
            periods: self.view.period_starts().len(),
        }
    }

    /// The type of the deciding aircraft.
    pub(crate) fn kind(&self) -> TypeIx {
        self.view.kind(self.decision.aircraft)
    }
}
