//! The time, energy and charging of a flight between two vertiports (Eq. 7, 9, 13-15), computed
//! once a day.

use vertifleet_core::{
    AircraftType, ChargeRate, Charging, Need, Operations, Scenario, TypeIx, Vertiport, VertiportIx,
    whole_mwh,
};

use crate::VertiportSet;

/// The flight of one aircraft type from one vertiport to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    /// Energy of the flight, kWh: e d_ij and the battery's own losses. It is charged again after
    /// landing (Eq. 13, 15).
    pub energy_kwh: f64,
    /// g_ij: mean power drawn from the battery over the flight, kW (the interpretation under which
    /// Eq. 13 and 17 agree).
    pub mean_power_kw: f64,
    /// Seconds from leaving the stand to arrival: take-off, cruise, landing (Eq. 7).
    pub flight_s: u32,
    /// Seconds from arrival until the aircraft is ready again: until its turnaround is over and,
    /// where days charge to full, its battery is full (Eq. 14).
    pub ground_s: u32,
}

impl Leg {
    /// Seconds from take-off until the aircraft is ready for the next decision (Eq. 9).
    #[inline]
    pub fn block_s(&self) -> u32 {
        self.flight_s + self.ground_s
    }

    fn between(
        distance_mi: f64,
        kind: &AircraftType,
        to: &Vertiport,
        operations: &Operations,
    ) -> Self {
        let cruise_s = nearest_second(3600.0 * distance_mi / kind.speed_mph);
        let flight_s = operations.takeoff_s + cruise_s + operations.landing_s;
        let flight_h = f64::from(flight_s) / 3600.0;
        let lost_kwh = kind.battery_kwh * kind.self_discharge_per_h * flight_h;
        let energy_kwh = kind.energy_kwh_per_mi * distance_mi + lost_kwh;
        Self {
            energy_kwh,
            mean_power_kw: energy_kwh / flight_h,
            flight_s,
            ground_s: match operations.charging {
                Charging::ToFull => kind.turnaround_s.max(refill_s(energy_kwh, kind, to)),
                Charging::AsNeeded => kind.turnaround_s,
            },
        }
    }
}

/// Seconds to charge the last `energy_kwh` of a full battery at a vertiport (Eq. 14).
pub fn refill_s(energy_kwh: f64, kind: &AircraftType, at: &Vertiport) -> u32 {
    if kind.charge_curve.is_some() {
        let left_kwh = kind.battery_kwh - energy_kwh;
        return nearest_second(
            ChargeRate::of(kind, at).seconds_between(left_kwh, kind.battery_kwh),
        );
    }
    let most_kw = kind.charge_kw.min(at.charger_kw.unwrap_or(f64::INFINITY));
    nearest_second(3600.0 * energy_kwh / most_kw)
}

/// Rounds to the nearest second, halves up. A leg that no battery lasts for may take absurdly long.
/// It cannot be flown, and the bound keeps the sums of its parts within `u32`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "bounded and never negative"
)]
fn nearest_second(seconds: f64) -> u32 {
    seconds.round().min(1e9) as u32
}

/// What a leg takes from a battery, on days that charge as needed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LegCharge {
    /// Milliwatt-hours.
    pub(crate) energy_mwh: u64,
    /// What the battery holds at take-off at least.
    pub(crate) need: Need,
}

/// The legs of every aircraft type between every pair of vertiports.
#[derive(Debug, Clone)]
pub struct Legs {
    vertiports: usize,
    /// By type, then from, then to.
    by_pair: Vec<Leg>,
    /// By type, then from: the other vertiports that a corridor leads to and a full battery
    /// reaches.
    within_range: Vec<VertiportSet>,
    /// By type, then vertiport, on days that charge as needed; empty on others.
    rates: Vec<ChargeRate>,
    /// By type, from, then to, on days that charge as needed; empty on others.
    charges: Vec<LegCharge>,
}

impl Legs {
    /// Computes every leg of a day.
    pub fn of(scenario: &Scenario) -> Self {
        let vertiports = scenario.vertiports.len();
        let mut legs = Vec::with_capacity(scenario.aircraft_types.len() * vertiports * vertiports);
        let mut within_range = Vec::with_capacity(scenario.aircraft_types.len() * vertiports);
        for kind in &scenario.aircraft_types {
            for from in VertiportIx::all(vertiports) {
                let row = scenario.distance_mi.row(from);
                let ends = row.iter().zip(&scenario.vertiports);
                let leg = |(&mi, to)| Leg::between(mi, kind, to, &scenario.operations);
                legs.extend(ends.map(leg));
                let row = &legs[legs.len() - vertiports..];
                within_range.push(
                    VertiportIx::all(vertiports)
                        .filter(|&to| to != from && kind.lasts_for(row[to.at()].energy_kwh))
                        .filter(|&to| scenario.is_corridor(from, to))
                        .collect(),
                );
            }
        }
        let rates = rates(scenario);
        let charges = charges(scenario, &legs, &rates);
        Self { vertiports, by_pair: legs, within_range, rates, charges }
    }

    /// The leg of one type between two vertiports.
    #[inline]
    pub fn leg(&self, kind: TypeIx, from: VertiportIx, to: VertiportIx) -> &Leg {
        &self.legs_from(kind, from)[to.at()]
    }

    /// The legs of one type from a vertiport to each vertiport.
    #[inline]
    pub fn legs_from(&self, kind: TypeIx, from: VertiportIx) -> &[Leg] {
        &self.by_pair[(kind.at() * self.vertiports + from.at()) * self.vertiports..]
            [..self.vertiports]
    }

    /// How fast a type charges at a vertiport, on days that charge as needed.
    ///
    /// # Panics
    /// Panics on days that charge to full.
    #[inline]
    pub fn rate(&self, kind: TypeIx, at: VertiportIx) -> &ChargeRate {
        &self.rates[kind.at() * self.vertiports + at.at()]
    }

    /// What a leg takes from a battery, on days that charge as needed.
    #[inline]
    pub(crate) fn charge_of(
        &self,
        kind: TypeIx,
        (from, to): (VertiportIx, VertiportIx),
    ) -> &LegCharge {
        &self.charges[(kind.at() * self.vertiports + from.at()) * self.vertiports + to.at()]
    }

    /// Whether aircraft decide before they are full.
    #[inline]
    pub fn charge_as_needed(&self) -> bool {
        !self.rates.is_empty()
    }

    /// The other vertiports that a corridor leads to and a full battery reaches.
    #[inline]
    pub fn within_range(&self, kind: TypeIx, from: VertiportIx) -> &VertiportSet {
        &self.within_range[kind.at() * self.vertiports + from.at()]
    }
}

/// How fast each type charges at each vertiport, on days that charge as needed.
fn rates(scenario: &Scenario) -> Vec<ChargeRate> {
    if scenario.operations.charging == Charging::ToFull {
        return Vec::new();
    }
    let at_all = |kind| scenario.vertiports.iter().map(move |at| ChargeRate::of(kind, at));
    scenario.aircraft_types.iter().flat_map(at_all).collect()
}

/// What each leg takes from a battery; nothing without rates.
fn charges(scenario: &Scenario, legs: &[Leg], rates: &[ChargeRate]) -> Vec<LegCharge> {
    let vertiports = scenario.vertiports.len();
    let mut charges = Vec::new();
    for (legs, (row, rate)) in legs.chunks(vertiports).zip(rates.iter().enumerate()) {
        let kind = &scenario.aircraft_types[row / vertiports];
        charges.extend(legs.iter().map(|leg| LegCharge {
            energy_mwh: whole_mwh(leg.energy_kwh),
            need: rate.need(kind.needed_mwh(leg.energy_kwh)),
        }));
    }
    charges
}
