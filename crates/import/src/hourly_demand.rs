//! Mean passengers of each pair and period, and the table that a planner may give them in.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;

use vertifleet_core::Time;

use crate::row::{Column, required};
use crate::table;
use crate::vertiports::Vertiports;
use crate::{Error, Warning};

/// The most cells of demand that a network takes: pairs of vertiports times periods.
const MOST_CELLS: usize = 4_000_000;
/// The most passengers of a pair and period on the mean.
const MOST_PASSENGERS: f64 = 1e5;

const PERIOD: usize = 0;
const FROM: usize = 1;
const TO: usize = 2;
const PASSENGERS: usize = 3;
const COLUMNS: [Column; 4] =
    [required(&["period"]), required(&["from"]), required(&["to"]), required(&["passengers"])];

/// Mean passengers by pair and period.
#[derive(Debug, PartialEq)]
pub(crate) struct HourlyDemand {
    /// Start of each period, rising.
    pub(crate) periods: Vec<Time>,
    /// The position of the first period that the planner gave; an empty one may come before it.
    pub(crate) first_given: usize,
    /// For each pair with passengers, by the positions of its vertiports, the passengers of each
    /// period.
    pub(crate) pairs: BTreeMap<(usize, usize), Vec<f64>>,
}

impl HourlyDemand {
    /// Reads a table. Operations begin at `start`; where the table begins later, an empty period
    /// comes first.
    pub(crate) fn read(
        path: &Path,
        vertiports: &Vertiports,
        start: Time,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, Error> {
        // The value and position of each cell that the table gives.
        let mut cells: HashMap<(Time, (usize, usize)), (f64, usize)> = HashMap::new();
        let mut starts = BTreeSet::new();
        table::rows(path, &COLUMNS, warnings, |row| {
            let ends = row.pair(FROM, TO, vertiports)?;
            let period = row.time(PERIOD)?;
            let passengers = row.number(PASSENGERS, 0.0, MOST_PASSENGERS)?;
            if let Some((_, before)) = cells.insert((period, ends), (passengers, row.position)) {
                let (from, to) = (&vertiports.list[ends.0].id, &vertiports.list[ends.1].id);
                let what = format!("the demand from {from:?} to {to:?} at {period}");
                return Err(row.given_twice(what, before));
            }
            starts.insert(period);
            Ok(())
        })?;
        let origin = || path.display().to_string();
        let Some(&first) = starts.first() else {
            return Err(Error::Nothing { origin: origin(), what: "demand" });
        };
        let first_given = usize::from(first > start && starts.insert(start));
        let found = starts.len() * vertiports.list.len().pow(2);
        if found > MOST_CELLS {
            let what = "the number of pairs of vertiports times periods";
            return Err(Error::TooMany { origin: origin(), what, most: MOST_CELLS, found });
        }
        let periods: Vec<Time> = starts.into_iter().collect();
        let position: HashMap<Time, usize> = periods.iter().copied().zip(0..).collect();
        let mut pairs = BTreeMap::new();
        for ((period, ends), (passengers, _)) in cells {
            let means = pairs.entry(ends).or_insert_with(|| vec![0.0; periods.len()]);
            means[position[&period]] = passengers;
        }
        Ok(Self { periods, first_given, pairs })
    }

    /// Passengers of all pairs and periods together.
    pub(crate) fn passengers(&self) -> f64 {
        self.pairs.values().flatten().sum()
    }
}
