//! What all searches of one plan share: the day's numbers, where it begins, and the stand prices.

use std::sync::Arc;

use vertifleet_core::Scenario;
use vertifleet_sim::{Simulation, View};

use super::day::Day;
use super::fleet_state::FleetState;
use super::stand_prices::StandPrices;

/// A planning problem, ready to be searched.
pub(super) struct Problem {
    pub(super) day: Day,
    pub(super) state: FleetState,
    pub(super) prices: StandPrices,
    /// When the first aircraft decides, or the day's end if that is earlier.
    pub(super) first_s: u32,
}

impl Problem {
    /// A whole day.
    pub(super) fn of_day(scenario: &Arc<Scenario>) -> Self {
        Self::of(Simulation::new(Arc::clone(scenario)).view())
    }

    /// The rest of a day.
    pub(super) fn of(view: View<'_>) -> Self {
        let day = Day::of(view);
        let state = FleetState::of(view);
        let ready_s = state.aircraft.iter().map(|aircraft| aircraft.ready_at.seconds());
        let first_s = ready_s.min().unwrap_or(day.end_s).min(day.end_s);
        let prices = StandPrices::balancing(&day, &state, first_s);
        Self { day, state, prices, first_s }
    }
}
