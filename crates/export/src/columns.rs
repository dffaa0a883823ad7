//! The columns of the tables: the values of a decision in CSV and Parquet, under the same names and
//! in the same order.

use vertifleet_core::{Degrees, Time};

use crate::flown::Taken;

/// One column: its name, with the unit, and where its values come from.
pub(crate) struct Column {
    pub(crate) name: &'static str,
    pub(crate) values: Values,
}

/// How the values of a column are found, by the type that they have.
#[derive(Clone, Copy)]
pub(crate) enum Values {
    Text(for<'a> fn(&Taken<'a>) -> &'a str),
    /// A time as people read it, such as `25:10:00`.
    Clock(fn(&Taken) -> Time),
    /// A time as seconds since midnight.
    Seconds(fn(&Taken) -> Time),
    /// A time as an instant, which exists if the day has a calendar.
    Instant(fn(&Taken) -> Time),
    Count(fn(&Taken) -> u16),
    Number(fn(&Taken) -> f64),
    /// Degrees, which a vertiport may lack.
    Degrees(fn(&Taken) -> Option<f64>),
}

/// Every column in order. Those of instants are left out where the day has no calendar.
pub(crate) fn columns(with_instants: bool) -> impl Iterator<Item = &'static Column> {
    COLUMNS
        .iter()
        .filter(move |column| with_instants || !matches!(column.values, Values::Instant(_)))
}

const fn column(name: &'static str, values: Values) -> Column {
    Column { name, values }
}

const COLUMNS: [Column; 27] = [
    column("aircraft", Values::Text(|taken| &taken.aircraft.id)),
    column("type", Values::Text(|taken| &taken.kind.id)),
    column("kind", Values::Text(kind)),
    column("from", Values::Text(|taken| &taken.from.id)),
    column("to", Values::Text(|taken| &taken.to.id)),
    column("departure", Values::Clock(|taken| taken.row.takeoff)),
    column("arrival", Values::Clock(|taken| taken.row.arrival)),
    column("ready", Values::Clock(|taken| taken.row.ready)),
    column("passengers", Values::Count(|taken| taken.row.passengers)),
    column("seats", Values::Count(|taken| taken.kind.seats)),
    column("distance_mi", Values::Number(|taken| taken.distance_mi)),
    column("revenue_usd", Values::Number(|taken| taken.row.revenue_usd)),
    column("passenger_cost_usd", Values::Number(|taken| taken.row.passenger_cost_usd)),
    column("energy_kwh", Values::Number(|taken| taken.row.energy_kwh)),
    column("energy_cost_usd", Values::Number(|taken| taken.row.energy_cost_usd)),
    column("flight_cost_usd", Values::Number(|taken| taken.row.flight_cost_usd)),
    column("profit_usd", Values::Number(|taken| taken.row.profit_usd())),
    column("departure_s", Values::Seconds(|taken| taken.row.takeoff)),
    column("arrival_s", Values::Seconds(|taken| taken.row.arrival)),
    column("ready_s", Values::Seconds(|taken| taken.row.ready)),
    column("departure_utc", Values::Instant(|taken| taken.row.takeoff)),
    column("arrival_utc", Values::Instant(|taken| taken.row.arrival)),
    column("ready_utc", Values::Instant(|taken| taken.row.ready)),
    column("from_latitude_deg", Values::Degrees(|taken| latitude(taken.from.degrees))),
    column("from_longitude_deg", Values::Degrees(|taken| longitude(taken.from.degrees))),
    column("to_latitude_deg", Values::Degrees(|taken| latitude(taken.to.degrees))),
    column("to_longitude_deg", Values::Degrees(|taken| longitude(taken.to.degrees))),
];

fn kind<'a>(taken: &Taken<'a>) -> &'a str {
    if taken.is_hold() {
        "hold"
    } else if taken.is_reposition() {
        "reposition"
    } else {
        "flight"
    }
}

fn latitude(degrees: Option<Degrees>) -> Option<f64> {
    degrees.map(|degrees| degrees.latitude)
}

fn longitude(degrees: Option<Degrees>) -> Option<f64> {
    degrees.map(|degrees| degrees.longitude)
}
