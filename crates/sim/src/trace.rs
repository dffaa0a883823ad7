//! The trace: every decision of a day, one CSV row each, in the order in which they were taken.
//!
//! A trace is a complete schedule: it can be replayed and judged without the program that made it.
//! Numbers are written in the fewest digits that read back as the same `f64`, so that sums over a
//! trace that was read are the same bit for bit.

mod error;
mod read;
mod write;

use vertifleet_core::{AircraftIx, Scenario, Time, VertiportIx};

pub use error::TraceError;

/// The members of a row, in the order of the file's columns. The last one exists only on days on
/// which flights have a cost besides their energy.
const COLUMNS: [&str; 12] = [
    "time",
    "aircraft",
    "from",
    "to",
    "passengers",
    "revenue",
    "passenger_cost",
    "energy_kwh",
    "energy_cost",
    "arrival",
    "ready",
    "flight_cost",
];

/// The columns of the traces of a day.
fn columns(scenario: &Scenario) -> &'static [&'static str] {
    if scenario.has_flight_costs() { &COLUMNS } else { &COLUMNS[..COLUMNS.len() - 1] }
}

/// One decision and what came of it. A hold goes from a vertiport to itself, has no passengers and
/// no costs, arrives when it is decided, and is ready once the hold is over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraceRow {
    /// The time of the decision.
    pub time: Time,
    /// The aircraft that decided.
    pub aircraft: AircraftIx,
    /// The vertiport where it stood.
    pub from: VertiportIx,
    /// The vertiport that it flies to; `from` means that it holds.
    pub to: VertiportIx,
    /// Passengers on board.
    pub passengers: u16,
    /// Fares paid, dollars.
    pub revenue_usd: f64,
    /// Cost of carrying the passengers, dollars.
    pub passenger_cost_usd: f64,
    /// Energy of the flight, which is charged again after landing, kWh.
    pub energy_kwh: f64,
    /// Cost of charging, dollars.
    pub energy_cost_usd: f64,
    /// Cost of the flight without its energy, with or without passengers; dollars.
    pub flight_cost_usd: f64,
    /// The time at which the flight ends.
    pub arrival: Time,
    /// The time at which the aircraft can decide again.
    pub ready: Time,
}

/// The decisions of one day, in the order in which they were taken.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trace {
    /// One row for each decision.
    pub rows: Vec<TraceRow>,
}

impl TraceRow {
    /// Profit of the flight: fares less passenger cost, energy cost and flight cost; dollars.
    #[inline]
    pub fn profit_usd(&self) -> f64 {
        self.revenue_usd - self.passenger_cost_usd - self.energy_cost_usd - self.flight_cost_usd
    }
}
