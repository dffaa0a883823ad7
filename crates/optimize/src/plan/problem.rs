//! What all searches of one plan share: the day's numbers, the stand prices, and what the plan's end is worth.

use std::sync::Arc;

use vertifleet_core::{Scenario, Time, TypeIx, VertiportIx};
use vertifleet_sim::{Simulation, View};

use super::day::Day;
use super::fleet_state::FleetState;
use super::stand_prices::StandPrices;

/// What it is worth, in dollars, that an aircraft of a type is ready at a vertiport at a time past the plan's end.
pub type WorthAtEnd<'a> = &'a (dyn Fn(TypeIx, VertiportIx, Time) -> f64 + Sync);

/// A planning problem, ready to be searched.
pub(super) struct Problem<'a> {
    pub(super) day: Day,
    pub(super) state: FleetState,
    pub(super) prices: StandPrices,
    /// When the first aircraft decides, or the plan's end if that is earlier.
    pub(super) first_s: u32,
    worth_at_end: Option<WorthAtEnd<'a>>,
}

impl<'a> Problem<'a> {
    /// A whole day.
    pub(super) fn of_day(scenario: &Arc<Scenario>) -> Self {
        let simulation = Simulation::new(Arc::clone(scenario));
        let end = scenario.operations.end;
        Self::new(simulation.view(), FleetState::at_start(scenario), end, None)
    }

    /// The rest of a day from `state` on, with decisions up to and including `end`.
    pub(super) fn new(
        view: View<'_>,
        state: FleetState,
        end: Time,
        worth_at_end: Option<WorthAtEnd<'a>>,
    ) -> Self {
        let day = Day::of(view, end);
        let worth = |kind, place, ready_s| worth_usd(worth_at_end, kind, place, ready_s);
        let ready_s = state.aircraft.iter().map(|aircraft| aircraft.ready_at.seconds());
        let first_s = ready_s.min().unwrap_or(day.end_s).min(day.end_s);
        let prices = StandPrices::balancing(&day, &state, first_s, &worth);
        Self { day, state, prices, first_s, worth_at_end }
    }

    /// What it is worth to be ready past the end, dollars.
    #[inline]
    pub(super) fn worth_at_end_usd(&self, kind: TypeIx, place: VertiportIx, ready_s: u32) -> f64 {
        worth_usd(self.worth_at_end, kind, place, ready_s)
    }
}

#[inline]
fn worth_usd(worth: Option<WorthAtEnd<'_>>, kind: TypeIx, place: VertiportIx, ready_s: u32) -> f64 {
    worth.map_or(0.0, |worth| worth(kind, place, Time::from_seconds(ready_s)))
}
