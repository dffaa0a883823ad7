//! What is in the battery of an aircraft on days that charge as needed, as the simulator has it.

use vertifleet_core::{
    AircraftIx, ChargeRate, Charging, Scenario, Time, TypeIx, VertiportIx, whole_mwh,
};
use vertifleet_sim::{Landed, Legs};

use super::hop::{Arrival, Charge};

/// Parts of a full battery, of each of which a search keeps the best label.
pub(super) const PARTS: usize = 12;
/// Charges whose time to charge is kept for telling parts apart.
const CHARGES: usize = 256;
/// Bits after the binary point in numbers of charges, and in numbers of parts. They are kept as
/// whole numbers, which are faster to compare and round down.
const CHARGE_BITS: u32 = 40;
const PART_BITS: u32 = 32;

/// The batteries of a day that charges as needed.
#[derive(Debug)]
pub(super) struct Batteries {
    legs: Legs,
    /// By aircraft: the charge with which it starts the day, mWh.
    start_mwh: Vec<u64>,
    vertiports: usize,
    /// By type, then vertiport.
    scales: Vec<Scale>,
}

/// The parts of a full battery of a type at a vertiport, by the time that it takes to charge.
#[derive(Debug)]
struct Scale {
    /// Charges in a milliwatt-hour, with [`CHARGE_BITS`] after the point.
    a_mwh: u64,
    /// Parts that are charged in a second, with [`PART_BITS`] after the point.
    a_second: u64,
    /// The part that each charge is in, with [`PART_BITS`] after the point.
    parts: [u64; CHARGES],
}

impl Scale {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a battery holds at least a milliwatt-hour and takes at least a second"
    )]
    fn of(rate: &ChargeRate) -> Self {
        let fixed = |number: f64, bits: u32| (number * (1_u64 << bits) as f64) as u64;
        let full_kwh = rate.full_mwh() as f64 / 1e6;
        let part = |charge: usize| {
            let kwh = full_kwh * (charge as f64 / (CHARGES - 1) as f64);
            let to_full_s = rate.seconds_between(kwh, full_kwh);
            fixed(PARTS as f64 * (1.0 - to_full_s / rate.full_s()).max(0.0), PART_BITS)
        };
        Self {
            a_mwh: fixed((CHARGES - 1) as f64 / rate.full_mwh() as f64, CHARGE_BITS),
            a_second: fixed(PARTS as f64 / rate.full_s().max(1.0), PART_BITS),
            parts: std::array::from_fn(part),
        }
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

    /// The charge of a type that has landed at a vertiport, decides there at a second, and leaves
    /// some seconds late.
    #[inline]
    pub(super) fn charge(
        &self,
        (kind, at): (TypeIx, VertiportIx),
        arrival: Arrival,
        (decided_s, late_s): (u32, u32),
    ) -> Charge {
        let battery = self.legs.battery(kind, at, arrival.mwh);
        let landed = Landed { arrival: Time::from_seconds(arrival.second), battery };
        let charged = |second| self.legs.charge_mwh(kind, at, landed, Time::from_seconds(second));
        let decides_mwh = charged(decided_s);
        let leaves_mwh = if late_s == 0 { decides_mwh } else { charged(decided_s + late_s) };
        Charge { landed, decides_mwh, leaves_mwh }
    }

    /// The take-off of a flight that is decided at a second and leaves some seconds after its
    /// take-off, and what is left in the battery when it lands, mWh.
    #[inline]
    pub(super) fn fly(
        &self,
        (kind, from, to): (TypeIx, VertiportIx, VertiportIx),
        Charge { landed, decides_mwh, leaves_mwh }: Charge,
        (decided_s, late_s): (u32, u32),
    ) -> (u32, u64) {
        let (legs, pair) = (&self.legs, (from, to));
        if legs.need(kind, pair).is_met_by(decides_mwh) {
            return (decided_s, legs.left_mwh(kind, pair, leaves_mwh));
        }
        let takeoff = legs.takeoff(kind, pair, landed, Time::from_seconds(decided_s));
        let leaves_mwh = legs.charge_mwh(kind, from, landed, takeoff + late_s);
        (takeoff.seconds(), legs.left_mwh(kind, pair, leaves_mwh))
    }

    /// The second at which a battery is full.
    pub(super) fn full_s(&self, kind: TypeIx, at: VertiportIx, arrival: Arrival) -> u32 {
        let rate = self.legs.rate(kind, at);
        arrival.second + rate.needed_s(rate.battery(arrival.mwh), rate.need(rate.full_mwh()))
    }

    /// About the part of a full battery that a type has charged at a second, below [`PARTS`], by
    /// the time that the battery takes to charge.
    #[inline]
    pub(super) fn part(
        &self,
        kind: TypeIx,
        at: VertiportIx,
        arrival: Arrival,
        second: u32,
    ) -> usize {
        let scale = &self.scales[kind.at() * self.vertiports + at.at()];
        let charge = ((arrival.mwh * scale.a_mwh) >> CHARGE_BITS) as usize;
        let charged_s = u64::from(second - arrival.second);
        let part = scale.parts[charge.min(CHARGES - 1)] + charged_s * scale.a_second;
        ((part >> PART_BITS) as usize).min(PARTS - 1)
    }
}
