//! A bound for every design of a network: any fleet, and any number of stands and chargers.
//!
//! The prices of one bound (`prices.rs`) prove more than this bound. What an aircraft earns at most
//! after it has paid, and what a stand costs over the day, depend on neither the number of aircraft
//! nor that of stands. So the same prices bound the day with any number of them, by a sum in which
//! every aircraft and every stand counts alike (docs/src/concepts/bound.md, "Other designs").

use std::iter::Sum;
use std::ops::AddAssign;

use vertifleet_core::{
    Aircraft, AircraftIx, Day, Fares, Matrix, Outage, Scenario, Stop, TypeIx, VertiportIx,
};

use super::certificate::Certificate;
use super::money;
use super::prices::Prices;
use super::time_expanded_day::TimeExpandedDay;
use super::{Bound, Step};
use crate::Error;

/// What a day can earn at most before fixed costs, with any number of aircraft of each type,
/// wherever they start, and any number of stands and chargers. Several of them add up to one for
/// several days with the same designs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DesignBound {
    /// The surplus of the passengers, micro-dollars.
    passengers: i128,
    /// The most that an aircraft earns after it has paid, by type; micro-dollars.
    aircraft: Vec<i128>,
    /// The price of a stand, or of a charger, over the day, by vertiport; micro-dollars.
    places: Vec<i128>,
}

impl DesignBound {
    /// What can be earned at most before fixed costs with `aircraft` of each type and `places` at
    /// each vertiport, stands and chargers together; dollars.
    pub fn upper_bound_usd(&self, aircraft: &[u32], places: &[u32]) -> f64 {
        let of_all = |worths: &[i128], numbers: &[u32]| -> i128 {
            worths.iter().zip(numbers).map(|(&worth, &number)| worth * i128::from(number)).sum()
        };
        let micro_usd =
            self.passengers + of_all(&self.aircraft, aircraft) + of_all(&self.places, places);
        money::usd_up(micro_usd)
    }

    /// By how much one more aircraft of a type raises this bound, dollars.
    pub fn aircraft_shadow_price_usd(&self, kind: TypeIx) -> f64 {
        money::usd_up(self.aircraft[kind.at()])
    }

    /// By how much one more stand or charger at a vertiport raises this bound, dollars.
    pub fn place_shadow_price_usd(&self, vertiport: VertiportIx) -> f64 {
        money::usd_up(self.places[vertiport.at()])
    }
}

impl AddAssign<&Self> for DesignBound {
    fn add_assign(&mut self, other: &Self) {
        self.passengers += other.passengers;
        for (sum, one) in self.aircraft.iter_mut().zip(&other.aircraft) {
            *sum += one;
        }
        for (sum, one) in self.places.iter_mut().zip(&other.places) {
            *sum += one;
        }
    }
}

impl Sum for DesignBound {
    /// The sum of the bounds of several days; of none it bounds nothing and is 0.
    fn sum<I: Iterator<Item = Self>>(mut bounds: I) -> Self {
        let none = || Self { passengers: 0, aircraft: Vec::new(), places: Vec::new() };
        let mut sum = bounds.next().unwrap_or_else(none);
        bounds.for_each(|bound| sum += &bound);
        sum
    }
}

impl Bound {
    /// The bound of all designs that the prices of this bound prove. `scenario` is the day of the
    /// bound; `may_fail` is whether aircraft of other designs may have outages, as they may on any
    /// day of a network that has them.
    ///
    /// # Errors
    /// [`Error::TooManyFlights`] if the day with aircraft of every type is too large for the
    /// bound's step.
    ///
    /// # Panics
    /// If `scenario` is not the day of the bound.
    pub fn of_designs(&self, scenario: &Scenario, may_fail: bool) -> Result<DesignBound, Error> {
        let probe = one_of_each_type(scenario, may_fail);
        // With every type, fewer levels may fit than on the day. Any number proves a bound.
        let levels = Step { levels: self.levels, ..self.step }.all_levels(&probe);
        let levels = *levels.last().expect("there is one");
        let day = TimeExpandedDay::of(&probe, &[], self.step_s(), levels)?;
        let size = day.size();
        assert_eq!(self.prices.stand.len(), day.slices.len() * size, "the prices are of this day");
        let flight = self.market.prices_with_more_flights(&day.market, &self.prices.flight);
        let prices = Prices { flight, ..self.prices.clone() };
        let mut certificate = Certificate::new(&day);
        let evaluated = certificate.evaluate(&day, &prices, &Stop::default());
        evaluated.expect("it is not stopped");
        let mut aircraft = vec![0; probe.aircraft_types.len()];
        for (number, layer) in day.layers.iter().enumerate() {
            // Where it starts is drawn again for every design, so the best start counts.
            let starts = (0..size).map(|at| day.place(at, day.full()));
            let worths = starts.map(|place| certificate.worth_less_paid(&day, number, place, 0));
            // A full battery at the start, which the probe has, is the most that a design may have.
            let charged_s = layer.starts.iter().map(|start| start.charged_s).max().unwrap_or(0);
            let gift = day.charging.gift(&prices.charging, layer.kind, charged_s);
            aircraft[layer.kind.at()] = worths.max().map_or(0, |worth| i128::from(worth + gift));
        }
        let mut places = vec![0; size];
        for (at, &price) in self.prices.stand.iter().enumerate() {
            places[at % size] += i128::from(price);
        }
        let passengers = day.market.surplus(&prices.flight);
        Ok(DesignBound { passengers, aircraft, places })
    }
}

/// The day with one aircraft of each type. Where aircraft may fail, each of them has an outage,
/// with or without one on the day itself: other fleets may have theirs anywhere, and an aircraft
/// with an outage is worth no less (`time_expanded_day.rs`).
fn one_of_each_type(scenario: &Scenario, may_fail: bool) -> Scenario {
    let mut day = scenario.clone().into_day();
    let types = day.aircraft_types.len();
    let aircraft = |kind| Aircraft {
        id: format!("{kind}"),
        kind: TypeIx::new(kind),
        at: VertiportIx::new(0),
        start_charge_kwh: None,
    };
    day.aircraft = (0..types).map(aircraft).collect();
    for vertiport in &mut day.vertiports {
        vertiport.chargers = None;
        vertiport.stands = u16::try_from(types).expect("few types").max(vertiport.stands);
    }
    // The bound drops outages, so it does not matter when they are.
    let (start, end) = (day.operations.start, day.operations.end);
    let outage = |at| Outage { aircraft: AircraftIx::new(at), start, end };
    let failing = if may_fail { types } else { 0 };
    day.disturbances.outages = (0..failing).map(outage).collect();
    day.check("a day with one aircraft of each type").expect("a day within the rules")
}

/// The same day on which each passenger pays one dollar and nothing costs anything: its bound is
/// the number of passengers that can be carried at most.
pub fn day_of_passengers(scenario: &Scenario) -> Scenario {
    let mut day = scenario.clone().into_day();
    let size = day.vertiports.len();
    let free = || Matrix::from_fn(size, |_, _| 0.0);
    day.fare_usd = Fares::from(Matrix::from_fn(size, |from, to| f64::from(u8::from(from != to))));
    day.passenger_cost_usd = free();
    day.flight_cost_usd = free();
    day.energy_price_usd.fill(0.0);
    without_fixed_costs(&mut day);
    day.check("a day of passengers").expect("a day within the rules")
}

fn without_fixed_costs(day: &mut Day) {
    day.aircraft_cost_usd = 0.0;
    for vertiport in &mut day.vertiports {
        vertiport.stand_cost_usd = 0.0;
        vertiport.charger_cost_usd = 0.0;
    }
}
