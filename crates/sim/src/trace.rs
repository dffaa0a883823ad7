//! The trace: every decision of a day, one CSV row each, in the order in which they were taken.
//!
//! A trace is a complete schedule: it can be replayed and judged without the program that made it.
//! Numbers are written in the fewest digits that read back as the same `f64`, so that sums over a
//! trace that was read are the same bit for bit.

mod error;
mod read;
mod write;

use vertifleet_core::{AircraftIx, Charging, Scenario, Time, VertiportIx};

pub use error::TraceError;

/// The members of a row that every file has, in the order of its columns.
const COLUMNS: [&str; 11] = [
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
];

/// The column on days on which flights have a cost besides their energy.
const FLIGHT_COST: &str = "flight_cost";
/// The columns on days that charge as needed.
const CHARGE: [&str; 2] = ["charge_kwh", "takeoff"];

/// The columns of the traces of a day.
fn columns(scenario: &Scenario) -> Vec<&'static str> {
    let mut columns = COLUMNS.to_vec();
    if scenario.has_flight_costs() {
        columns.push(FLIGHT_COST);
    }
    if scenario.operations.charging == Charging::AsNeeded {
        columns.extend(CHARGE);
    }
    columns
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
    /// What the battery holds at the decision, kWh. Only on days that charge as needed; 0 on
    /// others.
    pub charge_kwh: f64,
    /// The time at which the battery suffices for the flight: that of the decision on days that
    /// charge to full, and for a hold. A flight that is delayed takes off later.
    pub takeoff: Time,
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
