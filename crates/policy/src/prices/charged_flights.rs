//! What a flight does to the charge of its aircraft, in tables: decisions look at every
//! destination, and logarithms would take most of their time.
//!
//! A charge is measured in the seconds that are left to a full battery where the aircraft stands.

use vertifleet_core::{TypeIx, VertiportIx, whole_mwh};
use vertifleet_sim::View;

/// Number of parts of a table, between which it is linear.
const PARTS: usize = 8;

/// The flight of one type from one vertiport to another.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChargedFlight {
    /// Seconds to a full battery with which it may take off at the latest.
    pub(super) most_s: f32,
    /// Parts of the table a second.
    parts_a_second: f32,
    /// By the seconds at take-off, from 0 to `most_s`: the seconds left when the aircraft is ready.
    ready_s: [f32; PARTS + 1],
}

impl ChargedFlight {
    /// The seconds to a full battery when the aircraft is ready, by those at take-off.
    #[inline]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the table")]
    pub(super) fn when_ready_s(&self, takeoff_s: f32) -> f32 {
        let place = (takeoff_s * self.parts_a_second).clamp(0.0, PARTS as f32);
        let part = (place as usize).min(PARTS - 1);
        let (low, high) = (self.ready_s[part], self.ready_s[part + 1]);
        low + (place - part as f32) * (high - low)
    }
}

/// The flights of a day that charges as needed; none on other days.
#[derive(Debug, Clone)]
pub(super) struct ChargedFlights {
    vertiports: usize,
    /// By type, from, then to.
    all: Vec<ChargedFlight>,
}

impl ChargedFlights {
    pub(super) fn of(view: View<'_>) -> Self {
        let vertiports = view.vertiports();
        let mut all = Vec::new();
        if view.charges_as_needed() {
            for kind in TypeIx::all(view.aircraft_types().len()) {
                for from in VertiportIx::all(vertiports) {
                    let tos = VertiportIx::all(vertiports);
                    all.extend(tos.map(|to| flight(view, kind, from, to)));
                }
            }
        }
        Self { vertiports, all }
    }

    /// The flights of a type from a vertiport, by destination.
    #[inline]
    pub(super) fn from(&self, kind: TypeIx, from: VertiportIx) -> &[ChargedFlight] {
        let first = (kind.at() * self.vertiports + from.at()) * self.vertiports;
        &self.all[first..first + self.vertiports]
    }
}

#[expect(clippy::cast_possible_truncation, reason = "seconds to a tenth are enough")]
fn flight(view: View<'_>, kind: TypeIx, from: VertiportIx, to: VertiportIx) -> ChargedFlight {
    let leg = view.leg(kind, from, to);
    let (here, there) = (view.charge_rate(kind, from), view.charge_rate(kind, to));
    let energy_mwh = whole_mwh(leg.energy_kwh);
    let needed_mwh = view.aircraft_type(kind).needed_mwh(leg.energy_kwh);
    let most_s = here.to_full_s(here.battery(needed_mwh), 0);
    let mut ready_s = [0.0; PARTS + 1];
    for (part, ready_s) in ready_s.iter_mut().enumerate() {
        let charge_mwh = here.with_to_full_mwh(most_s * part as f64 / PARTS as f64);
        let landed = there.battery(charge_mwh.saturating_sub(energy_mwh));
        *ready_s = there.to_full_s(landed, leg.ground_s) as f32;
    }
    let most_s = most_s as f32;
    let parts_a_second = if most_s > 0.0 { PARTS as f32 / most_s } else { 0.0 };
    ChargedFlight { most_s, parts_a_second, ready_s }
}
