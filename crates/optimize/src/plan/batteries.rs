//! What is in the battery of an aircraft on days that charge as needed, as the simulator has it.

use vertifleet_core::{
    AircraftIx, AircraftType, Charging, Scenario, TypeIx, VertiportIx, whole_mwh,
};
use vertifleet_sim::Legs;

use super::hop::{Hop, Landed};

/// The batteries of a day that charges as needed.
#[derive(Debug)]
pub(super) struct Batteries {
    legs: Legs,
    types: Vec<AircraftType>,
    /// By aircraft.
    start_mwh: Vec<u64>,
}

impl Batteries {
    /// The batteries of a day; `None` if it charges to full.
    pub(super) fn of(scenario: &Scenario) -> Option<Self> {
        if scenario.operations.charging == Charging::ToFull {
            return None;
        }
        let fleet = scenario.aircraft.iter();
        let start_mwh = fleet.map(|aircraft| whole_mwh(scenario.start_charge_kwh(aircraft)));
        Some(Self {
            legs: Legs::of(scenario),
            types: scenario.aircraft_types.clone(),
            start_mwh: start_mwh.collect(),
        })
    }

    /// The charge with which an aircraft starts the day, mWh.
    pub(super) fn start_mwh(&self, aircraft: AircraftIx) -> u64 {
        self.start_mwh[aircraft.at()]
    }

    /// The charge at a second of a type that stands at a vertiport, mWh.
    pub(super) fn charge_mwh(
        &self,
        kind: TypeIx,
        at: VertiportIx,
        landed: Landed,
        time_s: u32,
    ) -> u64 {
        self.legs.rate(kind, at).charged_mwh(landed.charge_mwh, time_s - landed.arrival_s)
    }

    /// The second at which a battery is full.
    pub(super) fn full_s(&self, kind: TypeIx, at: VertiportIx, landed: Landed) -> u32 {
        let rate = self.legs.rate(kind, at);
        landed.arrival_s + rate.needed_s(landed.charge_mwh, rate.full_mwh())
    }

    /// The part of a full battery that a charge is, as one of `of` numbers from 0.
    pub(super) fn part(&self, kind: TypeIx, charge_mwh: u64, of: usize) -> usize {
        let full_mwh = self.legs.rate(kind, VertiportIx::new(0)).full_mwh();
        let part = charge_mwh.min(full_mwh) * of as u64 / (full_mwh + 1);
        usize::try_from(part).expect("a small number")
    }

    /// The second at which a flight takes off that is decided at a second.
    pub(super) fn takeoff_s(
        &self,
        kind: TypeIx,
        from: VertiportIx,
        hop: &Hop,
        landed: Landed,
        decided_s: u32,
    ) -> u32 {
        let needed_mwh = self.types[kind.at()].needed_mwh(hop.energy_kwh);
        let needed_s = self.legs.rate(kind, from).needed_s(landed.charge_mwh, needed_mwh);
        decided_s.max(landed.arrival_s + needed_s)
    }

    /// The charge with which a flight lands that leaves at a second, mWh.
    pub(super) fn lands_with_mwh(
        &self,
        kind: TypeIx,
        from: VertiportIx,
        hop: &Hop,
        landed: Landed,
        left_s: u32,
    ) -> u64 {
        self.charge_mwh(kind, from, landed, left_s) - whole_mwh(hop.energy_kwh)
    }
}
