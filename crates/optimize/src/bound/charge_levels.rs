//! Levels of charge, on days that charge as needed: the bound knows of an aircraft only its level.
//!
//! What an aircraft has is rounded up to a level. With more charge an aircraft can do all that it
//! can do with less (docs/src/concepts/bound.md has the proof), so the bound stays one. With one
//! level, every aircraft is full whenever it decides.

use vertifleet_core::{Scenario, TypeIx, VertiportIx, whole_mwh};
use vertifleet_sim::Legs;

/// A level, counted from the lowest up.
pub(super) type Level = u16;

/// More than two charges differ by that are computed in different ways, mWh.
const ROUNDING_MWH: u64 = 2;

/// The levels of all types.
#[derive(Debug, Clone)]
pub(super) struct ChargeLevels<'a> {
    scenario: &'a Scenario,
    legs: &'a Legs,
    pub(super) count: usize,
    /// By type, then level: the charge, mWh.
    charge_mwh: Vec<u64>,
    /// By type: what a type charges in a second at most, mWh. An aircraft that waits for charge
    /// takes off with less than this above what it needs.
    second_mwh: Vec<u64>,
}

/// A flight or a hold from one level to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Charged {
    /// Seconds from the decision to take-off.
    pub(super) wait_s: u32,
    /// The level at the next decision.
    pub(super) level: Level,
}

impl<'a> ChargeLevels<'a> {
    /// Some levels, at least one, of a day that charges as needed.
    pub(super) fn of(scenario: &'a Scenario, legs: &'a Legs, count: u16) -> Self {
        let count = usize::from(count.max(1));
        let (mut charge_mwh, mut second_mwh) = (Vec::new(), Vec::new());
        for (at, kind) in scenario.aircraft_types.iter().enumerate() {
            let of_type = TypeIx::new(at);
            let rates = VertiportIx::all(scenario.vertiports.len());
            let in_a_second = |at| legs.rate(of_type, at).most_in_a_second_mwh();
            let second = rates.map(in_a_second).max().unwrap_or(0) + ROUNDING_MWH;
            let full = legs.rate(of_type, VertiportIx::new(0)).full_mwh();
            // What is left after a flight that had to wait for its charge is a level.
            let lowest = (whole_mwh(kind.reserve_kwh) + second).min(full);
            let charge = |level: usize| match count - 1 {
                0 => full,
                most => lowest + (full - lowest) * level as u64 / most as u64,
            };
            charge_mwh.extend((0..count).map(charge));
            second_mwh.push(second);
        }
        Self { scenario, legs, count, charge_mwh, second_mwh }
    }

    /// The lowest level that a charge does not exceed.
    fn up(&self, kind: TypeIx, mwh: u64) -> Level {
        let levels = &self.charge_mwh[kind.at() * self.count..][..self.count];
        let level = levels.partition_point(|&level_mwh| level_mwh < mwh).min(self.count - 1);
        Level::try_from(level).expect("there are few levels")
    }

    /// The level of an aircraft of a type that starts with a charge.
    pub(super) fn at_start(&self, kind: TypeIx, charge_kwh: f64) -> Level {
        self.up(kind, whole_mwh(charge_kwh))
    }

    /// The highest level.
    pub(super) fn full(&self) -> Level {
        Level::try_from(self.count - 1).expect("there are few levels")
    }

    /// A flight from a level that leaves `late_s` seconds after its take-off.
    pub(super) fn flight(
        &self,
        kind: TypeIx,
        (from, to): (VertiportIx, VertiportIx),
        level: Level,
        late_s: u32,
    ) -> Charged {
        let leg = self.legs.leg(kind, from, to);
        let (here, there) = (self.legs.rate(kind, from), self.legs.rate(kind, to));
        let charge_mwh = self.charge_mwh[kind.at() * self.count + usize::from(level)];
        let energy_mwh = whole_mwh(leg.energy_kwh);
        let needed_mwh = self.scenario.aircraft_types[kind.at()].needed_mwh(leg.energy_kwh);
        let wait_s = here.needed_s(here.battery(charge_mwh), here.need(needed_mwh));
        let takeoff_mwh = charge_mwh.max(needed_mwh + self.second_mwh[kind.at()]);
        let takeoff = here.battery(takeoff_mwh.min(here.full_mwh()));
        let left_mwh = here.charged_mwh(takeoff, late_s) + ROUNDING_MWH;
        let ready_mwh = there.charged_mwh(there.battery(left_mwh - energy_mwh), leg.ground_s);
        Charged { wait_s, level: self.up(kind, ready_mwh) }
    }

    /// The level after a hold.
    pub(super) fn hold(&self, kind: TypeIx, at: VertiportIx, level: Level) -> Level {
        let charge_mwh = self.charge_mwh[kind.at() * self.count + usize::from(level)];
        let hold_s = self.scenario.operations.hold_s;
        let rate = self.legs.rate(kind, at);
        let held_mwh = rate.charged_mwh(rate.battery(charge_mwh), hold_s);
        self.up(kind, held_mwh + ROUNDING_MWH)
    }
}
