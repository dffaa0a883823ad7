//! What a sweep finds out about each cell, before any statistics.

use serde::{Deserialize, Serialize};
use vertifleet_core::Network;
use vertifleet_sim::DayTotals;

/// The results of one cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CellRecord {
    /// The number of the cell in the design, from 0.
    pub cell: usize,
    /// The upper bound of each day in dollars; empty if none was asked for.
    pub upper_bounds_usd: Vec<f64>,
    /// The numbers of each day by policy: `[policy][day]`.
    pub totals: Vec<Vec<DayTotals>>,
}

/// What a cell's network has, and what that costs whatever is flown.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Size {
    /// Aircraft of all types.
    pub aircraft: usize,
    /// Stands of all vertiports.
    pub stands: u32,
    /// Chargers that are counted apart from stands.
    pub chargers: u32,
    /// What fleet, stands and chargers cost, dollars a day.
    pub fixed_cost_usd: f64,
}

impl Size {
    /// The size of a network.
    pub fn of(network: &Network) -> Self {
        let vertiports = network.vertiports().iter();
        Self {
            aircraft: network.fleet_size(),
            stands: vertiports.clone().map(|one| u32::from(one.stands)).sum(),
            chargers: vertiports.map(|one| u32::from(one.chargers.unwrap_or(0))).sum(),
            fixed_cost_usd: network.fixed_cost_usd(),
        }
    }
}
