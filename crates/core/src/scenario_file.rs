//! Reads the scenario file, JSON of format `vertifleet-scenario/1`, into a checked [`Scenario`].

mod write;

use std::path::Path;

use serde::Deserialize;

use crate::limits::{self, entries};
use crate::parse::or_default;
use crate::paths::origin;
use crate::raw::{
    Positions, RawAircraftType, RawClosure, RawOperations, RawOutage, RawRoute, RawTakeoffDelays,
    RawVertiport, each,
};
use crate::{
    Aircraft, Day, Disturbances, Error, Fares, FormatError, Matrix, Scenario, Time, TypeIx,
    VertiportIx, check, input, parse,
};

/// The format and version that the file's `format` member names.
const FORMAT: &str = "vertifleet-scenario/1";

impl Scenario {
    /// Reads and checks a scenario file.
    ///
    /// # Errors
    /// The file cannot be read, is longer than 64 MiB, or breaks a rule of the format; the message
    /// names the member.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let text = input::read_at_most(path, input::LONGEST_SCENARIO)?;
        Self::from_json(&text, &origin(path))
    }

    /// Reads and checks the text of a scenario file; `origin` names the text in messages.
    ///
    /// # Errors
    /// The text is longer than 64 MiB or breaks a rule of the format; the message names the member.
    pub fn from_json(text: &[u8], origin: &str) -> Result<Self, Error> {
        scenario(text).map_err(|error| error.in_file(origin))
    }
}

/// Reads and checks the text of a scenario file.
fn scenario(text: &[u8]) -> Result<Scenario, FormatError> {
    input::check_length(text, input::LONGEST_SCENARIO)?;
    let text = parse::without_mark(text);
    parse::refuse_network(text)?;
    let raw: RawScenario = parse::json(text, FORMAT)?;
    raw.day()?.checked()
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a scenario")]
struct RawScenario {
    #[serde(rename = "format")]
    _format: String,
    name: String,
    seed: f64,
    operations: RawOperations,
    vertiports: Vec<RawVertiport>,
    aircraft_types: Vec<RawAircraftType>,
    aircraft: Vec<RawAircraft>,
    distance_mi: Vec<Vec<f64>>,
    corridors: Option<Vec<RawRoute>>,
    fare: Vec<Vec<RawFare>>,
    passenger_cost: Vec<Vec<f64>>,
    flight_cost: Option<Vec<Vec<f64>>>,
    #[serde(default, deserialize_with = "or_default")]
    aircraft_cost: f64,
    periods: Vec<Time>,
    demand: Vec<Vec<Vec<f64>>>,
    energy_price: Vec<f64>,
    forecast: Option<Vec<Vec<Vec<f64>>>>,
    takeoff_delays: Option<RawTakeoffDelays>,
    #[serde(default, deserialize_with = "or_default")]
    closures: Vec<RawClosure>,
    #[serde(default, deserialize_with = "or_default")]
    outages: Vec<RawOutage>,
}

/// An entry of a single table of fares, or a row of one of several tables.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a number, or a row of numbers in a table for each period")]
enum RawFare {
    Cell(f64),
    Row(Vec<f64>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of an aircraft")]
struct RawAircraft {
    id: String,
    #[serde(rename = "type")]
    kind: String,
    at: String,
    start_charge_kwh: Option<f64>,
}

impl RawScenario {
    /// Converts the file to the open form of a day: ids become positions, rows become tables,
    /// counts become whole numbers.
    fn day(self) -> Result<Day, FormatError> {
        // Positions are 16 bits wide, so lengths are checked before any position is made.
        check::entry_count("vertiports", self.vertiports.len(), entries::VERTIPORTS)?;
        check::entry_count("aircraft_types", self.aircraft_types.len(), entries::AIRCRAFT_TYPES)?;
        check::entry_count("aircraft", self.aircraft.len(), entries::AIRCRAFT)?;

        let size = self.vertiports.len();
        let table = |rows, member: &str| table(rows, size, member);
        let distance_mi = table(self.distance_mi, "distance_mi")?;
        let fare_usd = fares(self.fare, size)?;
        let passenger_cost_usd = table(self.passenger_cost, "passenger_cost")?;
        let flight_cost_usd = match self.flight_cost {
            Some(rows) => table(rows, "flight_cost")?,
            None => Matrix::from_fn(size, |_, _| 0.0),
        };
        let passengers = |tables: Vec<Vec<Vec<f64>>>, member: &str| {
            each(tables, |rows, period| {
                let member = format!("{member}[{period}]");
                passengers(&table(rows, &member)?, &member)
            })
        };
        let demand = passengers(self.demand, "demand")?;
        let forecast = self.forecast.map(|tables| passengers(tables, "forecast")).transpose()?;

        let vertiports = each(self.vertiports, RawVertiport::check)?;
        let aircraft_types = each(self.aircraft_types, RawAircraftType::check)?;
        let places = Positions::of_vertiports(&vertiports)?;
        let kinds = Positions::of_types(&aircraft_types)?;
        let aircraft = each(self.aircraft, |raw, at| raw.check(at, &kinds, &places))?;
        let fleet = Positions::of_aircraft(&aircraft)?;
        let route = |raw: RawRoute, member: String| raw.check(&places, &member);
        let corridors = self
            .corridors
            .map(|routes| each(routes, |raw, at| route(raw, format!("corridors[{at}]"))));
        let disturbances = Disturbances {
            forecast,
            takeoff_delays: self.takeoff_delays.map(RawTakeoffDelays::check).transpose()?,
            closures: each(self.closures, |raw, at| raw.check(at, &places))?,
            outages: each(self.outages, |raw, at| raw.check(at, &fleet))?,
        };

        Ok(Day {
            name: self.name,
            seed: seed(self.seed)?,
            operations: self.operations.check()?,
            vertiports,
            aircraft_types,
            aircraft,
            distance_mi,
            corridors: corridors.transpose()?,
            fare_usd,
            passenger_cost_usd,
            flight_cost_usd,
            aircraft_cost_usd: self.aircraft_cost,
            periods: self.periods,
            demand,
            energy_price_usd: self.energy_price,
            disturbances,
        })
    }
}

impl RawAircraft {
    fn check(
        self,
        at: usize,
        kinds: &Positions,
        places: &Positions,
    ) -> Result<Aircraft, FormatError> {
        check::id(|| format!("aircraft[{at}]: id"), &self.id)?;
        let member = |member: &str| format!("aircraft {:?}: {member}", self.id);
        let kind = TypeIx::new(kinds.position(&self.kind, || member("type"))?);
        let at = VertiportIx::new(places.position(&self.at, || member("at"))?);
        Ok(Aircraft { id: self.id, kind, at, start_charge_kwh: self.start_charge_kwh })
    }
}

/// Converts rows to a square table.
fn table(rows: Vec<Vec<f64>>, size: usize, member: &str) -> Result<Matrix<f64>, FormatError> {
    let wrong = |member: String, part: &str, found| FormatError::WrongShape {
        member,
        expected: format!("a {part} for each of {size} vertiports"),
        found,
    };
    if rows.len() != size {
        return Err(wrong(member.to_owned(), "row", rows.len()));
    }
    if let Some(at) = rows.iter().position(|row| row.len() != size) {
        return Err(wrong(format!("{member}[{at}]"), "column", rows[at].len()));
    }
    Ok(Matrix::from_rows(size, rows).expect("as many rows as columns, just checked"))
}

/// Converts fares: one table for all day, or several, one for each period.
fn fares(raw: Vec<Vec<RawFare>>, size: usize) -> Result<Fares, FormatError> {
    let by_period = raw.iter().flatten().any(|fare| matches!(fare, RawFare::Row(_)));
    let wrong = |member: String, expected: &str| FormatError::WrongShape {
        member,
        expected: expected.to_owned(),
        found: 1,
    };
    if by_period {
        let tables = each(raw, |rows, period| {
            let rows = each(rows, |row, at| match row {
                RawFare::Row(row) => Ok(row),
                RawFare::Cell(_) => Err(wrong(format!("fare[{period}][{at}]"), "a row")),
            })?;
            table(rows, size, &format!("fare[{period}]"))
        })?;
        return Ok(Fares::by_period(tables));
    }
    let rows = raw.into_iter().map(|row| {
        let cell = |fare| if let RawFare::Cell(cell) = fare { Some(cell) } else { None };
        row.into_iter().filter_map(cell).collect()
    });
    Ok(table(rows.collect(), size, "fare")?.into())
}

/// Converts a table of one period's demand to whole passengers.
fn passengers(table: &Matrix<f64>, member: &str) -> Result<Matrix<u32>, FormatError> {
    let mut rows = Vec::with_capacity(table.size());
    for (from, row) in table.rows().enumerate() {
        let count = |(to, &cell): (usize, &f64)| {
            let member = || format!("{member}[{from}][{to}]");
            limits::PASSENGERS.whole_number(cell, member)
        };
        rows.push(row.iter().enumerate().map(count).collect::<Result<Vec<u32>, FormatError>>()?);
    }
    Ok(Matrix::from_rows(table.size(), rows).expect("rows of a square table"))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "checked: whole and below 2^53"
)]
fn seed(value: f64) -> Result<u64, FormatError> {
    if value >= 0.0 && value.fract() == 0.0 && value < limits::SEED_LIMIT as f64 {
        return Ok(value as u64);
    }
    Err(FormatError::SeedOutOfRange { found: limits::number(value) })
}
