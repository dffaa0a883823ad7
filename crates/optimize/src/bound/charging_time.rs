//! The price of charging time, on days that charge as needed.
//!
//! Levels of charge (`charge_levels.rs`) round up what an aircraft has, and so give energy away
//! that no charger delivers. A price takes it back, because a battery only fills while its aircraft
//! stands: until it takes off last, an aircraft uses no more energy than it had above the reserve
//! at the start, and charged while it stood. In seconds of charging at the type's greatest power,
//! the energy of all flights and the time that they are in the air add up to no more than the
//! charge at the start and the time of operations. Aircraft pay this price for the seconds of their
//! flights and are given it for the seconds that they have. Any price from 0 on proves a bound
//! (docs/src/concepts/bound.md has the proof).

use vertifleet_core::{Battery, ChargeCurve, Scenario, TypeIx, VertiportIx};
use vertifleet_sim::{Leg, Legs};

/// The most that a second of charging may cost, micro-dollars. It keeps the sums of
/// `certificate.rs` within `i64`.
pub(super) const MOST_A_SECOND: i64 = 100_000_000;
/// The most seconds of charging that a flight pays for, for the same reason.
const MOST_SECONDS: i64 = 1_000_000;

/// How the charge of aircraft is relaxed on days that charge as needed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Charge {
    /// The price of a second of charging, micro-dollars.
    pub(super) price: i64,
    /// The number of levels of charge, at least 1.
    pub(super) levels: u16,
}

impl Charge {
    /// Every aircraft is full whenever it decides, and charging is free.
    pub(super) const IGNORED: Self = Self { price: 0, levels: 1 };
}

/// A price for the charging time of a day.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChargingTime<'a> {
    scenario: &'a Scenario,
    legs: &'a Legs,
    /// Micro-dollars a second.
    price: i64,
}

impl<'a> ChargingTime<'a> {
    /// The charging time of a day that charges as needed, at a price.
    pub(super) fn of(scenario: &'a Scenario, legs: &'a Legs, price: i64) -> Self {
        Self { scenario, legs, price: price.clamp(0, MOST_A_SECOND) }
    }

    /// The most seconds that a flight may wait for charge, however little its aircraft has.
    pub(super) fn longest_wait_s(
        &self,
        kind: TypeIx,
        (from, to): (VertiportIx, VertiportIx),
    ) -> u32 {
        let rate = self.legs.rate(kind, from);
        let energy_kwh = self.legs.leg(kind, from, to).energy_kwh;
        let needed_mwh = self.scenario.aircraft_types[kind.at()].needed_mwh(energy_kwh);
        rate.needed_s(Battery::default(), rate.need(needed_mwh))
    }

    /// What a flight pays at least that takes off no later than a second, micro-dollars: for its
    /// energy, and for its time in the air until the end of operations.
    pub(super) fn payment(&self, kind: TypeIx, leg: &Leg, takeoff_s: u32) -> i64 {
        let end_s = self.scenario.operations.end.seconds();
        let in_the_air_s = leg.flight_s.min(end_s.saturating_sub(takeoff_s));
        // Charges are rounded to the nearest milliwatt-hour, at take-off and in the air.
        let energy_s = (leg.energy_kwh - 2e-6) * 3600.0 / self.greatest_kw(kind);
        self.price * (i64::from(in_the_air_s) + floor(energy_s).clamp(0, MOST_SECONDS))
    }

    /// What an aircraft is given that starts with a charge, micro-dollars: for the charge above the
    /// reserve, and for the time of operations.
    pub(super) fn gift(&self, kind: TypeIx, charge_kwh: f64) -> i64 {
        let of_type = &self.scenario.aircraft_types[kind.at()];
        let usable_kwh = charge_kwh - of_type.reserve_kwh;
        let charge_s = (usable_kwh + 2e-6) * 3600.0 / self.greatest_kw(kind);
        let operations = &self.scenario.operations;
        let open_s = i64::from(operations.end.since(operations.start));
        // One that never leaves pays for nothing, however little it has.
        self.price * (open_s + floor(charge_s) + 1).max(0)
    }

    /// The greatest power at which a type charges anywhere, kW.
    fn greatest_kw(&self, kind: TypeIx) -> f64 {
        let of_type = &self.scenario.aircraft_types[kind.at()];
        let points = of_type.charge_curve.iter().flat_map(ChargeCurve::points);
        let on_curve = points.map(|point| point.kw).reduce(f64::max).unwrap_or(f64::INFINITY);
        let vertiports = self.scenario.vertiports.iter();
        let chargers = vertiports.map(|at| at.charger_kw.unwrap_or(f64::INFINITY));
        of_type.charge_kw.min(on_curve).min(chargers.fold(0.0, f64::max))
    }
}

#[expect(clippy::cast_possible_truncation, reason = "`as` saturates; checked days have less")]
fn floor(seconds: f64) -> i64 {
    seconds.floor() as i64
}
