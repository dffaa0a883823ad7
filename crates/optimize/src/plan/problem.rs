//! The data that all searches of one plan share: the day's numbers, and its start.

use std::sync::Arc;

use vertifleet_core::{Matrix, Scenario, VertiportIx};
use vertifleet_sim::Simulation;

use super::day::Day;

/// A planning problem, ready to be searched.
pub(super) struct Problem {
    pub(super) day: Day,
    /// The vertiport of each aircraft when operations start.
    pub(super) places: Vec<VertiportIx>,
    /// Passengers by period, then from, then to.
    pub(super) demand: Vec<u32>,
    /// Mean over pairs and periods of the margin of a flight with every seat taken, before the cost
    /// of flying; dollars.
    pub(super) full_flight_usd: f64,
}

impl Problem {
    /// The problem of a day that is known in full.
    pub(super) fn of(scenario: &Arc<Scenario>) -> Self {
        let simulation = Simulation::new(Arc::clone(scenario));
        let view = simulation.view();
        let day = Day::of(scenario, view);
        let demand: Vec<u32> = scenario.demand.iter().flat_map(Matrix::cells).copied().collect();
        let seats = day.fleet().map(|aircraft| day.seats(aircraft)).max().unwrap_or(1);
        let margins_usd = (0..demand.len()).map(|cell| day.margin_usd(cell)).sum::<f64>();
        let full_flight_usd = seats as f64 * margins_usd / demand.len().max(1) as f64;
        Self { day, places: view.places().to_vec(), demand, full_flight_usd }
    }
}
