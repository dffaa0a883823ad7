//! What aircraft and stands were used for.

use serde::Serialize;
use vertifleet_core::{Aircraft, Scenario, VertiportIx};
use vertifleet_optimize::Bound;
use vertifleet_picture::{Activity, Occupancy, activities};
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
    /// Hours from leaving a stand until arrival.
    pub flying_h: f64,
    /// Hours in which its battery charged, also while it held or waited for its take-off.
    pub charging_h: f64,
    /// Hours for which an outage kept it on the ground with a full battery.
    pub out_of_service_h: f64,
    /// All other hours of operations: on the ground with a full battery.
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
    let all_s = day.operations.end.since(day.operations.start);
    let mut seconds = vec![Seconds::default(); day.aircraft.len()];
    for span in activities(day, rows, day.operations.end) {
        let of_aircraft = &mut seconds[span.aircraft.at()];
        let of_activity = match span.activity {
            Activity::Flight(_) => &mut of_aircraft.flying,
            Activity::Charging => &mut of_aircraft.charging,
            Activity::OutOfService => &mut of_aircraft.out_of_service,
        };
        *of_activity += span.end.since(span.start);
    }
    let in_hours = |seconds: u32| f64::from(seconds) / HOUR_S;
    let of_one = |(aircraft, spent): (&Aircraft, &Seconds)| AircraftUse {
        id: aircraft.id.clone(),
        kind: day.aircraft_types[aircraft.kind.at()].id.clone(),
        flights: 0,
        repositioning_flights: 0,
        flying_h: in_hours(spent.flying),
        charging_h: in_hours(spent.charging),
        out_of_service_h: in_hours(spent.out_of_service),
        waiting_h: in_hours(all_s - spent.flying - spent.charging - spent.out_of_service),
        profit_usd: 0.0,
    };
    let mut uses: Vec<AircraftUse> = day.aircraft.iter().zip(&seconds).map(of_one).collect();
    for row in rows.iter().filter(|row| row.from != row.to) {
        let one = &mut uses[row.aircraft.at()];
        one.flights += 1;
        one.repositioning_flights += u32::from(row.passengers == 0);
        one.profit_usd += row.profit_usd();
    }
    uses
}

/// The seconds that an aircraft spends on each activity within the hours of operations.
#[derive(Clone, Default)]
struct Seconds {
    flying: u32,
    charging: u32,
    out_of_service: u32,
}
