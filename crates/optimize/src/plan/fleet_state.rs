//! Where a planning problem begins: the fleet's state at some moment of a day, the morning or any later one.
//!
//! Between decisions an aircraft is where it stands or will land, and ready at a known time; taken stands follow from
//! that (Eq. 16), and nothing else of the past matters but the demand it used up.

use vertifleet_core::{AircraftIx, Time, VertiportIx};
use vertifleet_sim::View;

/// One aircraft between two decisions.
#[derive(Debug, Clone, Copy)]
pub(super) struct AircraftState {
    /// Where it stands or will land.
    pub(super) place: VertiportIx,
    /// When it can decide next.
    pub(super) ready_at: Time,
}

/// The whole fleet between two decisions, and the passengers still waiting.
#[derive(Debug)]
pub(super) struct FleetState {
    /// One entry an aircraft, in the scenario's order.
    pub(super) aircraft: Vec<AircraftState>,
    /// Passengers left by period, then from, then to; none in periods that are over.
    pub(super) demand_left: Vec<u32>,
}

impl FleetState {
    /// The fleet as a view shows it.
    pub(super) fn of(view: View<'_>) -> Self {
        let places = view.places();
        let aircraft = AircraftIx::all(places.len())
            .map(|aircraft| AircraftState {
                place: places[aircraft.at()],
                ready_at: view.ready_at(aircraft),
            })
            .collect();
        let first = view.period();
        let mut demand_left = vec![0; first * view.vertiports() * view.vertiports()];
        for period in first..=view.period_at(view.day_end()) {
            demand_left.extend_from_slice(view.demand_left_in(period));
        }
        Self { aircraft, demand_left }
    }
}
