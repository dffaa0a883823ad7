//! A day as it was at one moment.

use crate::{Simulation, View};

/// A day at one moment. It is read-only, and shows what its [`View`] showed at that moment.
#[derive(Debug, Clone)]
pub struct Snapshot(Simulation);

impl Snapshot {
    pub(crate) fn of(day: &Simulation) -> Self {
        Self(day.clone())
    }

    /// The view of a policy at that moment.
    #[inline]
    pub fn view(&self) -> View<'_> {
        View::of(&self.0)
    }
}
