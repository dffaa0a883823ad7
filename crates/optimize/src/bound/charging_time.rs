//! The charging time of a day that charges as needed, and its prices.
//!
//! Levels of charge (`charge_levels.rs`) round up what an aircraft has, and so give energy away
//! that no charger delivers. Prices take it back, because a battery only fills while its aircraft
//! stands. Energy is measured in seconds of charging at the type's greatest power. In each demand
//! period, the energy of the flights that leave and the time in the air add up to no more than the
//! period lasts and the battery loses meanwhile, and between two periods it holds no more than its
//! capacity. Aircraft pay a price for the seconds that their flights use in each period. They are
//! given it for the seconds that they have, and for what a battery can hold from one period to a
//! dearer one. Any prices from 0 on prove a bound (docs/src/concepts/bound.md has the proof).

use std::ops::Range;

use vertifleet_core::{
    AircraftType, ChargeCurve, ChargeRate, Charging, Scenario, TypeIx, whole_mwh,
};
use vertifleet_sim::Leg;

use super::itinerary::Itinerary;

/// The most that a second of charging may cost, micro-dollars. It keeps the sums of
/// `certificate.rs` within `i64`.
pub(super) const MOST_A_SECOND: i64 = 100_000_000;
/// The most seconds of charging that a flight pays for, for the same reason. What aircraft are
/// given has no such limit: it must not be less than they may use.
const MOST_SECONDS: i64 = 1_000_000;

/// What a flight uses of the charging time of its type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Use {
    /// The seconds in which its energy is charged, and those in the air before the end of
    /// operations.
    energy_s: u32,
    air_s: u32,
    /// The position of the price of the first period in which it may leave, and the number of
    /// periods after that in which it may leave, and land.
    first: u32,
    leaves: u16,
    lands: u16,
}

impl Use {
    /// The positions of the lowest prices at which it may use its seconds, with the seconds: it
    /// pays for no more, whenever it leaves.
    pub(super) fn at(&self, prices: &[i64]) -> [(usize, u32); 2] {
        [(self.energy_s, self.leaves), (self.air_s, self.lands)].map(|(seconds, later)| {
            let first = self.first as usize;
            let lowest = (first..=first + usize::from(later)).min_by_key(|&at| prices[at]);
            (lowest.expect("it leaves in some period"), seconds)
        })
    }

    /// What the flight pays, micro-dollars.
    pub(super) fn payment(&self, prices: &[i64]) -> i64 {
        self.at(prices).into_iter().map(|(at, seconds)| prices[at] * i64::from(seconds)).sum()
    }
}

/// The charging time of the types of a day.
#[derive(Debug, Clone, Default)]
pub(super) struct ChargingTime {
    /// First second of each demand period within operations, and the end of operations. Empty on
    /// days that charge to full.
    bounds_s: Vec<u32>,
    /// By type.
    types: Vec<OfType>,
}

/// The charging time of one type.
#[derive(Debug, Clone)]
struct OfType {
    /// The greatest power at which it charges anywhere, kW.
    greatest_kw: f64,
    reserve_kwh: f64,
    /// The seconds of charging that a battery holds above the reserve.
    store_s: i64,
    /// Number of aircraft.
    count: u32,
    /// The least charge with which one decides, mWh.
    least_mwh: u64,
}

impl ChargingTime {
    /// The charging time of a day.
    pub(super) fn of(scenario: &Scenario) -> Self {
        if scenario.operations.charging == Charging::ToFull {
            return Self::default();
        }
        let (start, end) = (scenario.operations.start, scenario.operations.end);
        let within = scenario.periods.iter().filter(|&&period| start < period && period < end);
        let bounds = std::iter::once(&start).chain(within).chain([&end]);
        let types = scenario.aircraft_types.iter().enumerate();
        Self {
            bounds_s: bounds.map(|bound| bound.seconds()).collect(),
            types: types.map(|(at, of_type)| OfType::of(scenario, of_type, at)).collect(),
        }
    }

    /// Number of periods.
    fn periods(&self) -> usize {
        self.bounds_s.len().saturating_sub(1)
    }

    /// Number of prices: by type, then period. None on days that charge to full.
    pub(super) fn prices(&self) -> usize {
        self.types.len() * self.periods()
    }

    /// The positions of the prices of a type.
    pub(super) fn of_kind(&self, kind: TypeIx) -> Range<usize> {
        kind.at() * self.periods()..(kind.at() + 1) * self.periods()
    }

    /// The length of the period of a price, seconds.
    pub(super) fn length_s(&self, at: usize) -> u32 {
        let period = at % self.periods();
        self.bounds_s[period + 1] - self.bounds_s[period]
    }

    /// The period that contains a second, or the last one.
    fn period(&self, second: u32) -> usize {
        let later = &self.bounds_s[1..self.periods()];
        later.partition_point(|&begins_s| begins_s <= second)
    }

    /// What a flight uses that leaves between two seconds.
    pub(super) fn of_flight(&self, kind: TypeIx, leg: &Leg, (first_s, last_s): (u32, u32)) -> Use {
        let end_s = self.bounds_s[self.periods()];
        let period = |second: u32| self.period(second.min(end_s));
        let later = |second| {
            u16::try_from(period(second) - period(first_s)).expect("a day has few periods")
        };
        // Charges are rounded to the nearest milliwatt-hour, at take-off and in the air.
        let energy_s = self.types[kind.at()].seconds(leg.energy_kwh - 2e-6).min(MOST_SECONDS);
        let air_s = leg.flight_s.min(end_s.saturating_sub(last_s));
        Use {
            energy_s: u32::try_from(energy_s).expect("within the limits"),
            air_s,
            first: u32::try_from(self.of_kind(kind).start + period(first_s)).expect("few prices"),
            leaves: later(last_s),
            lands: later(last_s + air_s),
        }
    }

    /// The most seconds that a flight may wait for charge, however little its aircraft has.
    pub(super) fn longest_wait_s(&self, rate: &ChargeRate, kind: TypeIx, needed_mwh: u64) -> u32 {
        rate.needed_s(rate.battery(self.types[kind.at()].least_mwh), rate.need(needed_mwh))
    }

    /// The seconds of charging above the reserve that an aircraft has which starts with a charge.
    pub(super) fn at_start_s(&self, kind: TypeIx, charge_kwh: f64) -> i64 {
        let of_type = &self.types[kind.at()];
        of_type.seconds(charge_kwh - of_type.reserve_kwh + 2e-6) + 1
    }

    /// What an aircraft is given at some prices that has some seconds of charging at the start,
    /// micro-dollars: for the time of operations, its charge, and what a battery can hold from one
    /// period to the next.
    pub(super) fn gift(&self, prices: &[i64], kind: TypeIx, at_start_s: i64) -> i64 {
        let own = self.of_kind(kind);
        let open = own.clone().map(|at| prices[at] * i64::from(self.length_s(at)));
        let rises = prices[own.clone()].windows(2).map(|pair| (pair[1] - pair[0]).max(0));
        let stored = rises.map(|rise| rise * self.types[kind.at()].store_s);
        let first = prices[own].first().map_or(0, |price| price * at_start_s);
        open.sum::<i64>() + stored.sum::<i64>() + first
    }

    /// The positions of the [stores](Self::stores) of a type.
    pub(super) fn stores_of(&self, kind: TypeIx) -> Range<usize> {
        let types = &self.types[..kind.at().min(self.types.len())];
        let before = types.iter().filter(|of_type| of_type.count > 0).count();
        let each = self.periods().saturating_sub(1);
        before * each..(before + 1) * each
    }

    /// The batteries of each type from each period to the next, full or not, whichever is worth
    /// more at some prices, and the number of aircraft.
    pub(super) fn stores(&self, prices: &[i64]) -> impl Iterator<Item = (u32, Itinerary)> {
        let kinds = TypeIx::all(self.types.len()).filter(|kind| self.types[kind.at()].count > 0);
        kinds.flat_map(move |kind| {
            let OfType { store_s, count, .. } = self.types[kind.at()];
            self.of_kind(kind).skip(1).map(move |at| {
                let is_full = prices[at] > prices[at - 1];
                (count, Itinerary::of_store(at - 1, if is_full { store_s as f64 } else { 0.0 }))
            })
        })
    }
}

impl OfType {
    fn of(scenario: &Scenario, of_type: &AircraftType, at: usize) -> Self {
        let points = of_type.charge_curve.iter().flat_map(ChargeCurve::points);
        let on_curve = points.map(|point| point.kw).reduce(f64::max).unwrap_or(f64::INFINITY);
        let vertiports = scenario.vertiports.iter();
        let chargers = vertiports.map(|at| at.charger_kw.unwrap_or(f64::INFINITY));
        let greatest_kw = of_type.charge_kw.min(on_curve).min(chargers.fold(0.0, f64::max));
        let fleet = || scenario.aircraft.iter().filter(|aircraft| aircraft.kind.at() == at);
        let starts = fleet().map(|aircraft| whole_mwh(scenario.start_charge_kwh(aircraft)));
        let mut made = Self {
            greatest_kw,
            reserve_kwh: of_type.reserve_kwh,
            store_s: 0,
            count: u32::try_from(fleet().count()).expect("at most 10,000 aircraft"),
            // No flight takes more than what is above the reserve.
            least_mwh: starts.fold(whole_mwh(of_type.reserve_kwh), u64::min),
        };
        made.store_s = made.seconds(of_type.battery_kwh - of_type.reserve_kwh + 2e-6) + 1;
        made
    }

    /// The whole seconds in which an energy is charged, at least 0.
    #[expect(clippy::cast_possible_truncation, reason = "`as` saturates; checked days have less")]
    fn seconds(&self, kwh: f64) -> i64 {
        ((kwh * 3600.0 / self.greatest_kw).floor() as i64).max(0)
    }
}
