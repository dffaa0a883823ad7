//! Mean passengers of each pair and period, and the table that a planner may give them in.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use vertifleet_core::Time;

use crate::cell::Cell;
use crate::clock;
use crate::input_file::InputFile;
use crate::row::{Column, Row, required};
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
        file: &InputFile<'_>,
        vertiports: &Vertiports,
        start: Time,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, Error> {
        let mut cells = Cells::default();
        match Layout::of(&table::csv_names(file)?, vertiports) {
            Layout::Long => {
                table::rows(file, &COLUMNS, warnings, |row| cells.add(row, vertiports))?;
            }
            Layout::Periods(wide) => {
                cells.starts.extend(wide.iter().filter_map(|one| clock::begin(one.cell())));
                let at: Vec<usize> = wide.iter().map(|one| one.at).collect();
                table::wide_rows(file, (&COLUMNS[FROM..=TO], &at), warnings, |row| {
                    wide.iter().zip(row.wide).try_for_each(|(one, value)| {
                        let values = [one.cell(), row.cells[0], row.cells[1], *value];
                        cells.add_wide(row, &values, vertiports)
                    })
                })?;
            }
            Layout::Destinations(wide) => {
                let at: Vec<usize> = wide.iter().map(|one| one.at).collect();
                table::wide_rows(file, (&COLUMNS[PERIOD..=FROM], &at), warnings, |row| {
                    cells.starts.insert(row.time(0)?);
                    wide.iter().zip(row.wide).try_for_each(|(one, value)| {
                        let values = [row.cells[0], row.cells[1], one.cell(), *value];
                        cells.add_wide(row, &values, vertiports)
                    })
                })?;
            }
        }
        warnings.extend(cells.other_ends(&file.origin()));
        let Cells { given: cells, mut starts, .. } = cells;
        let origin = || file.origin();
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

/// The columns that a table of demand has besides the names of its rows.
enum Layout {
    /// A row for each period and pair.
    Long,
    /// A column for each period.
    Periods(Vec<WideColumn>),
    /// A column for each destination.
    Destinations(Vec<WideColumn>),
}

/// A column whose name is a value of its rows.
struct WideColumn {
    at: usize,
    name: String,
}

impl WideColumn {
    /// Its name as a value.
    fn cell(&self) -> Cell<'_> {
        Cell::text(self.name.as_bytes())
    }
}

impl Layout {
    fn of(names: &[String], vertiports: &Vertiports) -> Self {
        let has =
            |at: usize| names.iter().any(|name| name.eq_ignore_ascii_case(COLUMNS[at].names[0]));
        let columns = |is_one: &dyn Fn(&str) -> bool| -> Vec<WideColumn> {
            let chosen = names.iter().enumerate().filter(|(_, name)| is_one(name));
            chosen.map(|(at, name)| WideColumn { at, name: name.clone() }).collect()
        };
        if has(PASSENGERS) || !has(FROM) {
            return Self::Long;
        }
        let is_time = |name: &str| clock::begin(Cell::text(name.as_bytes())).is_some();
        let is_destination =
            |name: &str| vertiports.find(name, Cell::text(name.as_bytes()).whole()).is_some();
        let wide = match (has(PERIOD), has(TO)) {
            (false, true) => Self::Periods(columns(&is_time)),
            (true, false) => Self::Destinations(columns(&is_destination)),
            _ => Self::Long,
        };
        match &wide {
            Self::Periods(columns) | Self::Destinations(columns) if columns.is_empty() => {
                Self::Long
            }
            _ => wide,
        }
    }
}

/// The cells of a table of demand while it is read.
#[derive(Default)]
struct Cells {
    /// The value and position of each cell that the table gives.
    given: HashMap<(Time, (usize, usize)), (f64, usize)>,
    starts: BTreeSet<Time>,
    /// The ends of periods that the table states.
    ends: BTreeMap<Time, Time>,
}

impl Cells {
    fn add(&mut self, row: &Row<'_>, vertiports: &Vertiports) -> Result<(), Error> {
        let ends = row.pair(FROM, TO, vertiports)?;
        let period = row.time(PERIOD)?;
        let passengers = row.number(PASSENGERS, 0.0, MOST_PASSENGERS)?;
        if let Some((_, before)) = self.given.insert((period, ends), (passengers, row.position)) {
            let (from, to) = (&vertiports.list[ends.0].id, &vertiports.list[ends.1].id);
            let what = format!("the demand from {from:?} to {to:?} at {period}");
            return Err(row.given_twice(what, before));
        }
        self.starts.insert(period);
        if let Some((begin, Some(end))) = clock::span(row.cells[PERIOD]) {
            self.ends.insert(begin, end);
        }
        Ok(())
    }

    /// Adds a value of a wide table. An empty one is none, and so is 0 from a vertiport to itself.
    fn add_wide(
        &mut self,
        row: &Row<'_>,
        cells: &[Cell<'_>; 4],
        vertiports: &Vertiports,
    ) -> Result<(), Error> {
        let row = Row { columns: &COLUMNS, cells, wide: &[], ..*row };
        let is_nothing = cells[PASSENGERS].number() == Some(0.0);
        let is_itself = || -> Result<bool, Error> {
            Ok(row.vertiport(FROM, vertiports)? == row.vertiport(TO, vertiports)?)
        };
        if !row.has(PASSENGERS) || is_nothing && is_itself()? {
            return Ok(());
        }
        self.add(&row, vertiports)
    }

    /// The warning that a period lasts until another time than the table states.
    fn other_ends(&self, origin: &str) -> Option<Warning> {
        let nexts = self.starts.iter().zip(self.starts.iter().skip(1));
        let (begin, next, end) = nexts
            .filter_map(|(begin, next)| Some((begin, next, self.ends.get(begin)?)))
            .find(|(_, next, end)| next != end)?;
        Some(Warning::Demand {
            origin: origin.to_owned(),
            problem: format!(
                "the period {begin} ends at {end} in the table, and lasts until the next one, {next}: give each hour a row"
            ),
        })
    }
}
