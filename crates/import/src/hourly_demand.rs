//! Mean passengers of each pair and period, and the table that a planner may give them in.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use vertifleet_core::{Operations, Time};

use crate::cell::Cell;
use crate::clock::{self, StatedEnds};
use crate::input_file::InputFile;
use crate::row::{Column, Row, required};
use crate::table::{self, Wide};
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
    /// Reads a table. Where it begins later than operations, an empty period comes first.
    pub(crate) fn read(
        file: &InputFile<'_>,
        vertiports: &Vertiports,
        operations: &Operations,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, Error> {
        let mut cells = Cells::default();
        match Layout::of(&table::column_names(file)?, vertiports) {
            Layout::Long => {
                table::rows(file, &COLUMNS, warnings, |row| cells.add(row, vertiports))?;
            }
            Layout::Periods(wide) => {
                cells.starts.extend(wide.read.iter().filter_map(|one| clock::begin(one.cell())));
                wide.rows(file, &COLUMNS[FROM..=TO], warnings, |row, name, value| {
                    let values = [name, row.cells[0], row.cells[1], value];
                    cells.add_wide(row, &values, vertiports)
                })?;
            }
            Layout::Destinations(wide) => {
                wide.rows(file, &COLUMNS[PERIOD..=FROM], warnings, |row, name, value| {
                    cells.starts.insert(row.time(0)?);
                    let values = [row.cells[0], row.cells[1], name, value];
                    cells.add_wide(row, &values, vertiports)
                })?;
            }
        }
        warnings.extend(cells.other_end(&file.origin(), operations.end));
        let start = operations.start;
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
    Periods(WideColumns),
    /// A column for each destination.
    Destinations(WideColumns),
}

/// The columns of a wide table.
struct WideColumns {
    /// Those whose names are values of their rows.
    read: Vec<WideColumn>,
    /// Those of other names. Numbers in them are refused, as their names are then mistyped.
    others: Vec<WideColumn>,
}

/// A column by its position and name.
struct WideColumn {
    at: usize,
    name: String,
}

impl WideColumn {
    /// Its name as a value.
    fn cell(&self) -> Cell<'_> {
        Cell::text(self.name.as_bytes())
    }

    /// Whether it has the sums of its rows.
    fn is_total(&self) -> bool {
        self.name.eq_ignore_ascii_case("total")
    }
}

impl WideColumns {
    /// Calls `each` with the name and value of every cell of a table.
    fn rows(
        &self,
        file: &InputFile<'_>,
        columns: &[Column],
        warnings: &mut Vec<Warning>,
        mut each: impl FnMut(&Row<'_>, Cell<'_>, Cell<'_>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let at =
            |columns: &[WideColumn]| -> Vec<usize> { columns.iter().map(|one| one.at).collect() };
        let (read, others) = (at(&self.read), at(&self.others));
        let wide = Wide { read: &read, others: &others };
        table::wide_rows(file, (columns, wide), warnings, |row| {
            let (values, others) = row.wide.split_at(read.len());
            let mut named = self.others.iter().zip(others);
            if let Some((one, value)) = named.find(|(_, value)| value.number().is_some()) {
                // The name is wrong, which is in the header.
                each(&Row { position: 0, ..*row }, one.cell(), *value)?;
            }
            let mut named = self.read.iter().zip(values).filter(|(one, _)| !one.is_total());
            named.try_for_each(|(one, value)| each(row, one.cell(), *value))
        })
    }
}

impl Layout {
    fn of(names: &[String], vertiports: &Vertiports) -> Self {
        let is = |name: &str, at: usize| name.eq_ignore_ascii_case(COLUMNS[at].names[0]);
        let has = |at: usize| names.iter().any(|name| is(name, at));
        if has(PASSENGERS) || !has(FROM) || has(PERIOD) == has(TO) {
            return Self::Long;
        }
        let by_period = has(TO);
        let is_value = |one: &WideColumn| {
            let vertiport = || vertiports.find(&one.name, one.cell().whole());
            if by_period { clock::begin(one.cell()).is_some() } else { vertiport().is_some() }
        };
        let is_wide = |name: &str| !name.is_empty() && !(0..COLUMNS.len()).any(|at| is(name, at));
        let wide = names.iter().enumerate().filter(|(_, name)| is_wide(name));
        let wide = wide.map(|(at, name)| WideColumn { at, name: name.clone() });
        let (read, others): (Vec<WideColumn>, Vec<WideColumn>) =
            wide.partition(|one| is_value(one) || one.is_total());
        match (read.iter().any(is_value), by_period) {
            (false, _) => Self::Long,
            (true, true) => Self::Periods(WideColumns { read, others }),
            (true, false) => Self::Destinations(WideColumns { read, others }),
        }
    }
}

/// The cells of a table of demand while it is read.
#[derive(Default)]
struct Cells {
    /// The value and position of each cell that the table gives.
    given: HashMap<(Time, (usize, usize)), (f64, usize)>,
    starts: BTreeSet<Time>,
    ends: StatedEnds,
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
        self.ends.add(row.cells[PERIOD]);
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

    /// The warning that a period lasts until another time than the table states. The last one lasts
    /// until operations end.
    fn other_end(&self, origin: &str, end: Time) -> Option<Warning> {
        let (begin, stated, next) = self.ends.other(&self.starts, |_| end)?;
        Some(Warning::Demand {
            origin: origin.to_owned(),
            problem: format!(
                "the period {begin} ends at {stated} in the table, and lasts until {next}, when the next one begins or \
                 operations end: give each hour a row, with 0 passengers where there are none"
            ),
        })
    }
}
