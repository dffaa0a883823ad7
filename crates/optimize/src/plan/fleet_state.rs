//! Where a planning problem begins: the fleet's state at some moment of a day, the morning or any later one.
//!
//! Between decisions an aircraft is where it stands or will land, and ready at a known time; taken stands follow from
//! that (Eq. 16), and nothing else of the past matters but the demand it used up.

use vertifleet_core::{Matrix, Scenario, Time, VertiportIx};
use vertifleet_sim::{Decision, View};

/// One aircraft between two decisions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AircraftState {
    /// Where it stands or will land.
    pub place: VertiportIx,
    /// When it can decide next.
    pub ready_at: Time,
}

/// The whole fleet between two decisions, and the passengers still waiting.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FleetState {
    /// One entry an aircraft, in the scenario's order.
    pub aircraft: Vec<AircraftState>,
    /// Passengers left by period, then from, then to.
    pub demand_left: Vec<u32>,
}

impl FleetState {
    /// The fleet before the first decision of a day.
    pub fn at_start(scenario: &Scenario) -> Self {
        let ready_at = scenario.operations.start;
        Self {
            aircraft: scenario
                .aircraft
                .iter()
                .map(|aircraft| AircraftState { place: aircraft.at, ready_at })
                .collect(),
            demand_left: scenario.demand.iter().flat_map(Matrix::cells).copied().collect(),
        }
    }

    /// The fleet at a decision, before it is taken.
    pub fn at_decision(decision: &Decision, view: &View<'_>) -> Self {
        let mut state = Self { aircraft: Vec::new(), demand_left: Vec::new() };
        state.update(decision, view);
        state
    }

    /// As [`at_decision`](Self::at_decision), in the memory of an earlier state.
    pub fn update(&mut self, decision: &Decision, view: &View<'_>) {
        let places = view.places();
        self.aircraft.clear();
        self.aircraft.extend(vertifleet_core::AircraftIx::all(places.len()).map(|aircraft| {
            AircraftState { place: places[aircraft.at()], ready_at: view.ready_at(aircraft) }
        }));
        let first = view.period();
        let pairs = view.vertiports() * view.vertiports();
        self.demand_left.clear();
        self.demand_left.resize(first * pairs, 0);
        for period in first..=view.period_at(view.day_end()) {
            self.demand_left.extend_from_slice(view.demand_left_in(period));
        }
        debug_assert!(self.aircraft[decision.aircraft.at()].ready_at == decision.time);
    }
}
