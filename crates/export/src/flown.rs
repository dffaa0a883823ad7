//! A day with the decisions that were taken on it, checked once, so that no format has to refuse a
//! row.

use vertifleet_core::{Aircraft, AircraftType, Degrees, Scenario, Time, Vertiport};
use vertifleet_sim::TraceRow;

use crate::Error;

/// The first time that is too late for a row. A trace file writes four digits for hours, and
/// Parquet has 32 bits for seconds.
const TOO_LATE: Time = Time::from_seconds(10_000 * 3600);

/// A played or planned day: a scenario and the rows of its trace.
///
/// The rows are those that can be written in every format. Whether they keep the rules of the day
/// is the question of `vertifleet check`, and is not asked here: a live day may have arrivals that
/// no rule foresees.
#[derive(Debug, Clone, Copy)]
pub struct Flown<'a> {
    day: &'a Scenario,
    rows: &'a [TraceRow],
}

impl<'a> Flown<'a> {
    /// Joins a day and the rows of its trace.
    ///
    /// # Errors
    /// [`Error::UnknownEntry`] (V724) if a row belongs to a day with more aircraft or vertiports,
    /// and [`Error::WrongValue`] (V725) if a row goes back in time, continues after 9999:59:59, or
    /// has an amount that is not finite.
    pub fn new(day: &'a Scenario, rows: &'a [TraceRow]) -> Result<Self, Error> {
        for (at, row) in rows.iter().enumerate() {
            Check { day, row, number: at + 1 }.everything()?;
        }
        Ok(Self { day, rows })
    }

    /// The scenario of the day.
    pub(crate) fn day(&self) -> &'a Scenario {
        self.day
    }

    /// Every decision, in the order of the trace.
    pub(crate) fn decisions(&self) -> impl Iterator<Item = Taken<'a>> + use<'a> {
        let day = self.day;
        self.rows.iter().map(move |row| Taken::new(day, row))
    }

    /// The decisions to fly, in the order of the trace.
    pub(crate) fn flights(&self) -> impl Iterator<Item = Taken<'a>> + use<'a> {
        self.decisions().filter(|taken| !taken.is_hold())
    }

    /// The place of every vertiport on the globe, in file order.
    ///
    /// # Errors
    /// [`Error::NoDegrees`] (V721) with the first vertiport that has none.
    pub(crate) fn places(&self, format: &'static str) -> Result<Vec<Degrees>, Error> {
        let place = |vertiport: &Vertiport| {
            vertiport.degrees.ok_or_else(|| Error::NoDegrees {
                day: self.day.name.clone(),
                vertiport: vertiport.id.clone(),
                format,
            })
        };
        self.day.vertiports.iter().map(place).collect()
    }
}

/// One decision, with the entries of the day that its row refers to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Taken<'a> {
    pub(crate) row: &'a TraceRow,
    pub(crate) aircraft: &'a Aircraft,
    pub(crate) kind: &'a AircraftType,
    pub(crate) from: &'a Vertiport,
    pub(crate) to: &'a Vertiport,
    pub(crate) distance_mi: f64,
}

impl<'a> Taken<'a> {
    fn new(day: &'a Scenario, row: &'a TraceRow) -> Self {
        let aircraft = &day.aircraft[row.aircraft.at()];
        Self {
            row,
            aircraft,
            kind: &day.aircraft_types[aircraft.kind.at()],
            from: &day.vertiports[row.from.at()],
            to: &day.vertiports[row.to.at()],
            distance_mi: day.distance_mi[(row.from, row.to)],
        }
    }

    /// Whether the aircraft stays where it is.
    pub(crate) fn is_hold(&self) -> bool {
        self.row.from == self.row.to
    }

    /// Whether the aircraft flies without passengers.
    pub(crate) fn is_reposition(&self) -> bool {
        !self.is_hold() && self.row.passengers == 0
    }
}

/// A row that is being checked.
struct Check<'a> {
    day: &'a Scenario,
    row: &'a TraceRow,
    number: usize,
}

impl Check<'_> {
    fn everything(&self) -> Result<(), Error> {
        let &Self { day, row, .. } = self;
        self.entry("aircraft", row.aircraft.at(), "aircraft", day.aircraft.len())?;
        self.entry("from", row.from.at(), "vertiports", day.vertiports.len())?;
        self.entry("to", row.to.at(), "vertiports", day.vertiports.len())?;
        self.not_before("arrival", row.arrival, row.time)?;
        self.not_before("ready", row.ready, row.arrival)?;
        self.not_too_late(row.ready)?;
        for (member, amount) in [
            ("revenue", row.revenue_usd),
            ("passenger_cost", row.passenger_cost_usd),
            ("energy_kwh", row.energy_kwh),
            ("energy_cost", row.energy_cost_usd),
            ("flight_cost", row.flight_cost_usd),
            ("profit", row.profit_usd()),
        ] {
            if !amount.is_finite() {
                return Err(self.wrong(member, "finite".to_owned(), amount.to_string()));
            }
        }
        Ok(())
    }

    fn entry(
        &self,
        member: &'static str,
        at: usize,
        list: &'static str,
        found: usize,
    ) -> Result<(), Error> {
        if at < found {
            return Ok(());
        }
        let day = self.day.name.clone();
        Err(Error::UnknownEntry { day, row: self.number, member, entry: at + 1, list, found })
    }

    fn not_before(&self, member: &'static str, time: Time, earliest: Time) -> Result<(), Error> {
        if time >= earliest {
            return Ok(());
        }
        Err(self.wrong(member, format!("{earliest} or later"), time.to_string()))
    }

    /// The times before this one are no later, so that one check is enough.
    fn not_too_late(&self, ready: Time) -> Result<(), Error> {
        if ready < TOO_LATE {
            return Ok(());
        }
        Err(self.wrong("ready", format!("before {TOO_LATE}"), ready.to_string()))
    }

    fn wrong(&self, member: &'static str, rule: String, found: String) -> Error {
        Error::WrongValue { day: self.day.name.clone(), row: self.number, member, rule, found }
    }
}
