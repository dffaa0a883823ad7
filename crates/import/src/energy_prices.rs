//! Energy prices from a planner's table, and the price of each demand period.
//!
//! A price holds from its time until the next one that the table gives, the last one for the rest
//! of the day. A network has one price for each demand period, so a period in which the price
//! changes has the mean over its time.

use std::collections::{BTreeMap, BTreeSet};

use vertifleet_core::{Operations, Time};

use crate::clock::StatedEnds;
use crate::error::shortened;
use crate::input_file::InputFile;
use crate::row::{Column, required};
use crate::table;
use crate::{Error, Warning};

/// The greatest price of electricity, dollars per kWh.
const MOST_USD: f64 = 1e3;

const COLUMNS: [Column; 2] = [required(&["period"]), required(&["price_usd_per_kwh"])];

/// The prices of a day.
#[derive(Debug)]
pub(crate) struct EnergyPrices {
    origin: String,
    /// Dollars per kWh from each time on.
    from: BTreeMap<Time, f64>,
    ends: StatedEnds,
}

impl EnergyPrices {
    /// Reads a table.
    pub(crate) fn read(file: &InputFile<'_>, warnings: &mut Vec<Warning>) -> Result<Self, Error> {
        let origin = file.origin();
        let mut rows: BTreeMap<Time, (f64, usize)> = BTreeMap::new();
        let mut ends = StatedEnds::default();
        table::rows(file, &COLUMNS, warnings, |row| {
            let period = row.time(0)?;
            ends.add(row.cells[0]);
            let price = row.number(1, 0.0, MOST_USD)?;
            match rows.insert(period, (price, row.position)) {
                Some((_, before)) => Err(row.given_twice(format!("the period {period}"), before)),
                None => Ok(()),
            }
        })?;
        if rows.is_empty() {
            return Err(Error::Nothing { origin, what: "prices" });
        }
        let from = rows.into_iter().map(|(time, (price, _))| (time, price)).collect();
        Ok(Self { origin, from, ends })
    }

    /// The price of each demand period, dollars per kWh.
    pub(crate) fn of_periods(
        &self,
        periods: &[Time],
        operations: &Operations,
    ) -> Result<Vec<f64>, Error> {
        spans(periods, operations).map(|(begin, end)| self.mean(begin, end)).collect()
    }

    /// The warning that prices change within demand periods.
    pub(crate) fn warning(&self, periods: &[Time], operations: &Operations) -> Option<Warning> {
        let changes = spans(periods, operations).flat_map(|span| self.changes(span));
        let times: Vec<String> = changes.map(|(time, _)| time.to_string()).collect();
        let problem = format!(
            "prices change within demand periods, which have their mean over time: at {}",
            shortened(&times.join(", "), 120)
        );
        let origin = self.origin.clone();
        (!times.is_empty()).then_some(Warning::EnergyPrices { origin, problem })
    }

    /// The warning that a price holds until another time than the table states.
    pub(crate) fn other_end(&self, operations: &Operations) -> Option<Warning> {
        let starts: BTreeSet<Time> = self.from.keys().copied().collect();
        // The last price may hold for longer than operations last.
        let (begin, stated, next) =
            self.ends.other(&starts, |stated| operations.end.max(stated))?;
        let problem = format!(
            "the price of {begin} ends at {stated} in the table, and holds until {next}, when the next one begins or \
             operations end: give each time a price"
        );
        Some(Warning::EnergyPrices { origin: self.origin.clone(), problem })
    }

    /// The price at a time.
    fn at(&self, time: Time) -> Option<f64> {
        self.from.range(..=time).next_back().map(|(_, price)| *price)
    }

    /// The times after the first one of a span at which the price becomes another, with the new
    /// price.
    fn changes(&self, (begin, end): (Time, Time)) -> impl Iterator<Item = (Time, f64)> {
        let later = self.from.iter().map(|(time, price)| (*time, *price));
        let mut before = self.at(begin);
        later.filter(move |(time, price)| {
            let within = begin < *time && *time < end;
            within && before.replace(*price) != Some(*price)
        })
    }

    /// The mean price over a span of time.
    fn mean(&self, begin: Time, end: Time) -> Result<f64, Error> {
        let Some(first) = self.at(begin) else {
            let first = self.from.keys().next().copied().unwrap_or_default();
            let problem = format!(
                "there is no price for the demand period {begin}: the first one begins at {first}"
            );
            return Err(Error::PricePeriods { origin: self.origin.clone(), problem });
        };
        let changes: Vec<(Time, f64)> = self.changes((begin, end)).collect();
        if changes.is_empty() {
            return Ok(first);
        }
        let ends = changes.iter().map(|(time, _)| *time).chain([end]);
        let steps = std::iter::once((begin, first)).chain(changes.iter().copied()).zip(ends);
        let sum: f64 = steps.map(|((from, price), to)| price * f64::from(to.since(from))).sum();
        Ok((sum / f64::from(end.since(begin)) * 1e6).round() / 1e6)
    }
}

/// The begin and end of each demand period within operations. The last period ends with operations.
fn spans(periods: &[Time], operations: &Operations) -> impl Iterator<Item = (Time, Time)> {
    let last = operations.end;
    let ends = periods.iter().skip(1).copied().chain([last]);
    periods.iter().copied().zip(ends).map(move |(begin, end)| (begin, end.min(last).max(begin)))
}
