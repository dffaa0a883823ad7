//! What all searches of one plan share: the day's numbers, where it begins, and the stand prices.

use std::sync::Arc;

use vertifleet_core::{Matrix, Scenario, VertiportIx};
use vertifleet_policy::DayPrices;
use vertifleet_sim::Simulation;

use super::day::Day;
use super::foresight::Foresight;
use super::stand_prices::StandPrices;

/// A planning problem, ready to be searched.
pub(super) struct Problem {
    pub(super) day: Day,
    /// Where each aircraft is when operations start.
    pub(super) places: Vec<VertiportIx>,
    /// Passengers by period, then from, then to.
    pub(super) demand: Vec<u32>,
    pub(super) prices: StandPrices,
    /// When operations start.
    pub(super) first_s: u32,
}

impl Problem {
    /// A day that is known in full. Prices come from its forecast: they guide the search and bound nothing.
    pub(super) fn of(scenario: &Arc<Scenario>) -> Self {
        let simulation = Simulation::new(Arc::clone(scenario));
        let view = simulation.view();
        let day = Day::of(view, Foresight::of(scenario));
        let start = scenario.operations.start;
        let prices = StandPrices::of(&day, &DayPrices::of(view, start), start);
        Self {
            day,
            places: view.places().to_vec(),
            demand: scenario.demand.iter().flat_map(Matrix::cells).copied().collect(),
            prices,
            first_s: start.seconds(),
        }
    }
}
