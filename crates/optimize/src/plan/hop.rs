//! Flights between two vertiports as the planner reckons with them.

use vertifleet_core::VertiportIx;
use vertifleet_sim::Landed;

/// A flight from a vertiport that aircraft of one type can make.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hop {
    pub(super) to: VertiportIx,
    /// Seconds from leaving the stand to arrival.
    pub(super) flight_s: u32,
    /// Seconds from leaving the stand until the aircraft is ready again.
    pub(super) block_s: u32,
    pub(super) energy_kwh: f64,
    /// Cost of the flight, without its energy, dollars.
    pub(super) flight_cost_usd: f64,
}

/// The latest landing of an aircraft, or the start of the day.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Arrival {
    pub(super) second: u32,
    /// What its battery held then, mWh; 0 on days that charge to full.
    pub(super) mwh: u64,
}

/// An aircraft that stands at a vertiport and decides.
#[derive(Debug, Clone, Copy)]
pub(super) struct Standing {
    /// Second of the decision.
    pub(super) decided_s: u32,
    /// Seconds by which a flight that it decides leaves after its take-off.
    pub(super) late_s: u32,
    /// On days that charge as needed.
    pub(super) charge: Option<Charge>,
}

/// The charge of an aircraft that stands at a vertiport and decides.
#[derive(Debug, Clone, Copy)]
pub(super) struct Charge {
    pub(super) landed: Landed,
    /// What its battery holds at the decision, mWh.
    pub(super) decides_mwh: u64,
    /// What it holds when a flight leaves that need not wait for charge, mWh.
    pub(super) leaves_mwh: u64,
}

/// The end of a flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Landing {
    /// Second at which the aircraft decides again.
    pub(super) ready_s: u32,
    pub(super) arrival: Arrival,
}
