//! The trace: every decision of a day, one CSV row each, in the order they were taken.
//!
//! A trace is a complete schedule: it can be replayed and judged without the program that made it. Numbers are written
//! in the fewest digits that read back as the same `f64`, so that what is read sums up bit for bit.

mod error;
mod read;
mod write;

use vertifleet_core::{AircraftIx, Scenario, Time, VertiportIx};

pub use error::TraceError;

/// The members of a row, in the order of the file's columns. The last is there only on days on which a flight costs
/// something beside its energy.
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

/// One decision and what it came to. A hold goes from a vertiport to itself, carries and costs nothing, arrives when
/// it is decided and is ready once the hold is over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraceRow {
    /// When the aircraft decided.
    pub time: Time,
    /// Who decided.
    pub aircraft: AircraftIx,
    /// Where it stood.
    pub from: VertiportIx,
    /// Where it flies; `from` means that it holds.
    pub to: VertiportIx,
    /// Passengers on board.
    pub passengers: u16,
    /// What they pay, dollars.
    pub revenue_usd: f64,
    /// What carrying them costs, dollars.
    pub passenger_cost_usd: f64,
    /// Energy of the flight, charged again after landing, kWh.
    pub energy_kwh: f64,
    /// What charging costs, dollars.
    pub energy_cost_usd: f64,
    /// What the flight costs with or without passengers, beside its energy; dollars.
    pub flight_cost_usd: f64,
    /// When the flight ends.
    pub arrival: Time,
    /// When the aircraft can decide again.
    pub ready: Time,
}

/// The decisions of one day, in the order they were taken.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trace {
    /// One row a decision.
    pub rows: Vec<TraceRow>,
}

impl TraceRow {
    /// What the flight earns: fares less passenger cost, energy cost and its own cost; dollars.
    #[inline]
    pub fn profit_usd(&self) -> f64 {
        self.revenue_usd - self.passenger_cost_usd - self.energy_cost_usd - self.flight_cost_usd
    }
}
