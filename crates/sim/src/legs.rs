//! The time, energy and charging of a flight between two vertiports (Eq. 7, 9, 13-15), computed
//! once a day.

use vertifleet_core::{AircraftType, Operations, Scenario, TypeIx, VertiportIx};

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
    /// Seconds from the decision to arrival: take-off, cruise, landing (Eq. 7).
    pub flight_s: u32,
    /// Seconds from arrival until the battery is full again (Eq. 14).
    pub charge_s: u32,
}

impl Leg {
    /// Seconds from the decision until the aircraft is ready for the next one (Eq. 9).
    #[inline]
    pub fn block_s(&self) -> u32 {
        self.flight_s + self.charge_s
    }

    fn between(distance_mi: f64, kind: &AircraftType, operations: &Operations) -> Self {
        let cruise_s = nearest_second(3600.0 * distance_mi / kind.speed_mph);
        let flight_s = operations.takeoff_s + cruise_s + operations.landing_s;
        let flight_h = f64::from(flight_s) / 3600.0;
        let lost_kwh = kind.battery_kwh * kind.self_discharge_per_h * flight_h;
        let energy_kwh = kind.energy_kwh_per_mi * distance_mi + lost_kwh;
        Self {
            energy_kwh,
            mean_power_kw: energy_kwh / flight_h,
            flight_s,
            charge_s: nearest_second(3600.0 * energy_kwh / kind.charge_kw),
        }
    }
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

/// The legs of every aircraft type between every pair of vertiports.
#[derive(Debug, Clone)]
pub struct Legs {
    vertiports: usize,
    /// By type, then from, then to.
    by_pair: Vec<Leg>,
    /// By type, then from: the other vertiports that a corridor leads to and a full battery
    /// reaches.
    within_range: Vec<VertiportSet>,
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
                legs.extend(row.iter().map(|&mi| Leg::between(mi, kind, &scenario.operations)));
                let row = &legs[legs.len() - vertiports..];
                within_range.push(
                    VertiportIx::all(vertiports)
                        .filter(|&to| to != from && kind.lasts_for(row[to.at()].energy_kwh))
                        .filter(|&to| scenario.is_corridor(from, to))
                        .collect(),
                );
            }
        }
        Self { vertiports, by_pair: legs, within_range }
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

    /// The other vertiports that a corridor leads to and a full battery reaches.
    #[inline]
    pub fn within_range(&self, kind: TypeIx, from: VertiportIx) -> &VertiportSet {
        &self.within_range[kind.at() * self.vertiports + from.at()]
    }
}
