//! The data that all searches of one plan share: the day's numbers, its start, and the stand prices.

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
    /// The vertiport of each aircraft when operations start.
    pub(super) places: Vec<VertiportIx>,
    /// Passengers by period, then from, then to.
    pub(super) demand: Vec<u32>,
    pub(super) prices: StandPrices,
    /// Mean over pairs and periods of the margin of a flight with every seat taken, before the cost of flying; dollars.
    pub(super) full_flight_usd: f64,
    /// First second of operations.
    pub(super) first_s: u32,
}

impl Problem {
    /// The problem of a day that is known in full. Its prices come from the forecast; they guide the search and prove
    /// no bound.
    pub(super) fn of(scenario: &Arc<Scenario>) -> Self {
        let simulation = Simulation::new(Arc::clone(scenario));
        let view = simulation.view();
        let day = Day::of(view, Foresight::of(scenario));
        let start = scenario.operations.start;
        let demand: Vec<u32> = scenario.demand.iter().flat_map(Matrix::cells).copied().collect();
        let seats = day.fleet().map(|aircraft| day.seats(aircraft)).max().unwrap_or(1);
        let margins_usd = (0..demand.len()).map(|cell| day.margin_usd(cell)).sum::<f64>();
        let full_flight_usd = seats as f64 * margins_usd / demand.len().max(1) as f64;
        let prices = StandPrices::of(&day, &DayPrices::of(view, start), start);
        Self {
            day,
            places: view.places().to_vec(),
            demand,
            prices,
            full_flight_usd,
            first_s: start.seconds(),
        }
    }
}
