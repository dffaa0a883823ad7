//! What is in the battery of an aircraft on days that charge as needed, as the simulator has it.

use vertifleet_core::{
    AircraftIx, ChargeRate, Charging, Scenario, Time, TypeIx, VertiportIx, whole_mwh,
};
use vertifleet_sim::{Landed, Legs};

use super::hop::Arrival;

/// Parts of a full battery, of each of which a search keeps the best label.
pub(super) const PARTS: usize = 12;
/// Charges whose time to charge is kept for telling parts apart.
const CHARGES: usize = 256;

/// The batteries of a day that charges as needed.
#[derive(Debug)]
pub(super) struct Batteries {
    pub(super) legs: Legs,
    /// By aircraft: the charge with which it starts the day, mWh.
    start_mwh: Vec<u64>,
    vertiports: usize,
    /// By type, then vertiport.
    scales: Vec<Scale>,
}

/// The parts of a full battery of a type at a vertiport, by the time that it takes to charge.
#[derive(Debug)]
struct Scale {
    charge_mwh: f64,
    a_second: f64,
    /// The part that each charge is in, not rounded; the next charge holds `charge_mwh` more.
    parts: [f64; CHARGES],
}

impl Scale {
    fn of(rate: &ChargeRate) -> Self {
        let charge_mwh = rate.full_mwh() as f64 / (CHARGES - 1) as f64;
        let a_second = PARTS as f64 / rate.full_s();
        let full_kwh = rate.full_mwh() as f64 / 1e6;
        let part = |charge: usize| {
            let kwh = charge as f64 * charge_mwh / 1e6;
            PARTS as f64 - rate.seconds_between(kwh.min(full_kwh), full_kwh) * a_second
        };
        Self { charge_mwh, a_second, parts: std::array::from_fn(part) }
    }
}

impl Batteries {
    /// The batteries of a day; `None` if it charges to full.
    pub(super) fn of(scenario: &Scenario) -> Option<Self> {
        if scenario.operations.charging == Charging::ToFull {
            return None;
        }
        let legs = Legs::of(scenario);
        let vertiports = scenario.vertiports.len();
        let scales = TypeIx::all(scenario.aircraft_types.len()).flat_map(|kind| {
            let legs = &legs;
            VertiportIx::all(vertiports).map(move |at| Scale::of(legs.rate(kind, at)))
        });
        let scales = scales.collect();
        let fleet = scenario.aircraft.iter();
        let start = fleet.map(|aircraft| whole_mwh(scenario.start_charge_kwh(aircraft)));
        Some(Self { start_mwh: start.collect(), legs, vertiports, scales })
    }

    /// The charge with which an aircraft starts the day, mWh.
    pub(super) fn start_mwh(&self, aircraft: AircraftIx) -> u64 {
        self.start_mwh[aircraft.at()]
    }

    /// The landing of a type at a vertiport.
    #[inline]
    pub(super) fn landed(&self, kind: TypeIx, at: VertiportIx, arrival: Arrival) -> Landed {
        let battery = self.legs.battery(kind, at, arrival.mwh);
        Landed { arrival: Time::from_seconds(arrival.second), battery }
    }

    /// The second at which a battery is full.
    pub(super) fn full_s(&self, kind: TypeIx, at: VertiportIx, arrival: Arrival) -> u32 {
        let rate = self.legs.rate(kind, at);
        arrival.second + rate.needed_s(rate.battery(arrival.mwh), rate.need(rate.full_mwh()))
    }

    /// About the part of a full battery that a type has charged at a second, below [`PARTS`], by
    /// the time that the battery takes to charge.
    #[inline]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small numbers")]
    pub(super) fn part(
        &self,
        kind: TypeIx,
        at: VertiportIx,
        arrival: Arrival,
        second: u32,
    ) -> usize {
        let scale = &self.scales[kind.at() * self.vertiports + at.at()];
        let charge = (arrival.mwh as f64 / scale.charge_mwh) as usize;
        let charged_s = f64::from(second - arrival.second);
        let part = scale.parts[charge.min(CHARGES - 1)] + charged_s * scale.a_second;
        (part as usize).min(PARTS - 1)
    }
}
