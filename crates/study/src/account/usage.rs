//! What aircraft and stands were used for.

use serde::Serialize;
use vertifleet_core::{AircraftIx, Scenario, Time, VertiportIx};
use vertifleet_optimize::Bound;
use vertifleet_picture::{Charged, Occupancy};
use vertifleet_sim::TraceRow;

const HOUR_S: f64 = 3_600.0;

/// How full a vertiport was, from the start to the end of operations.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VertiportUse {
    /// Its id.
    pub id: String,
    /// Aircraft that it has room for: stands and chargers.
    pub room: u32,
    /// Flights that left.
    pub departures: u32,
    /// Flights that came.
    pub arrivals: u32,
    /// Mean share of the room that was taken by aircraft there or on their way there.
    pub taken_share: f64,
    /// Share of the time in which all of it was taken.
    pub full_share: f64,
    /// What one more stand would be worth; `None` without a bound.
    #[serde(flatten)]
    pub stand_worth: Option<StandWorth>,
}

/// What one more stand of a vertiport would be worth by a bound of the day.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StandWorth {
    /// Shadow price of one more stand all day, dollars: by how much the bound rises at most.
    pub stand_shadow_price_usd: f64,
    /// The same by demand period, dollars.
    pub stand_shadow_price_by_period_usd: Vec<f64>,
}

impl StandWorth {
    /// The worth at the vertiport in this position, on a day with this number of demand periods.
    pub(super) fn of(bound: &Bound, at: usize, periods: usize) -> Self {
        let at = VertiportIx::new(at);
        Self {
            stand_shadow_price_usd: bound.stand_shadow_price_usd(at),
            stand_shadow_price_by_period_usd: bound.stand_shadow_prices_by_period_usd(at, periods),
        }
    }
}

/// What an aircraft did, from the start to the end of operations.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AircraftUse {
    /// Its id.
    pub id: String,
    /// Its type.
    pub kind: String,
    /// Flights.
    pub flights: u32,
    /// Flights without passengers.
    pub repositioning_flights: u32,
    /// Hours from decisions to fly until arrivals.
    pub flying_h: f64,
    /// Hours of charging.
    pub charging_h: f64,
    /// Hours for which an outage kept it on the ground after it was charged.
    pub out_of_service_h: f64,
    /// All other hours of operations: on a stand, charged and ready.
    pub waiting_h: f64,
    /// Profit of its flights, before what the aircraft costs, dollars.
    pub profit_usd: f64,
}

/// The use of every vertiport, as long as nothing is known of what its stands are worth.
pub(super) fn of_vertiports(day: &Scenario, rows: &[TraceRow]) -> Vec<VertiportUse> {
    VertiportIx::all(day.vertiports.len()).map(|at| of_vertiport(day, rows, at)).collect()
}

fn of_vertiport(day: &Scenario, rows: &[TraceRow], at: VertiportIx) -> VertiportUse {
    let occupancy = Occupancy::of(day, rows, at);
    let flights = || rows.iter().filter(|row| row.from != row.to);
    VertiportUse {
        id: day.vertiports[at.at()].id.clone(),
        room: occupancy.room,
        departures: number(flights().filter(|row| row.from == at)),
        arrivals: number(flights().filter(|row| row.to == at)),
        taken_share: occupancy.mean_share(),
        full_share: occupancy.full_share(),
        stand_worth: None,
    }
}

fn number<'a>(rows: impl Iterator<Item = &'a TraceRow>) -> u32 {
    u32::try_from(rows.count()).expect("a day has a bounded number of decisions")
}

/// The use of every aircraft.
pub(super) fn of_aircraft(day: &Scenario, rows: &[TraceRow]) -> Vec<AircraftUse> {
    let all_h = f64::from(day.operations.end.since(day.operations.start)) / HOUR_S;
    let mut uses: Vec<AircraftUse> = day
        .aircraft
        .iter()
        .map(|aircraft| AircraftUse {
            id: aircraft.id.clone(),
            kind: day.aircraft_types[aircraft.kind.at()].id.clone(),
            flights: 0,
            repositioning_flights: 0,
            flying_h: 0.0,
            charging_h: 0.0,
            out_of_service_h: 0.0,
            waiting_h: all_h,
            profit_usd: 0.0,
        })
        .collect();
    let end = day.operations.end;
    let within_h = |from: Time, to: Time| {
        f64::from(to.min(end).seconds().saturating_sub(from.min(end).seconds())) / HOUR_S
    };
    let charged = Charged::of(day);
    for row in rows.iter().filter(|row| row.from != row.to) {
        let AircraftIx(at) = row.aircraft;
        let one = &mut uses[at as usize];
        one.flights += 1;
        one.repositioning_flights += u32::from(row.passengers == 0);
        one.flying_h += within_h(row.takeoff, row.arrival);
        one.charging_h += within_h(row.time, row.takeoff) + within_h(row.arrival, charged.at(row));
        one.out_of_service_h += within_h(charged.at(row), row.ready);
        one.waiting_h -= within_h(row.time, row.ready);
        one.profit_usd += row.profit_usd();
    }
    uses
}
