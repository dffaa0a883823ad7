//! Columns that split a table into several, such as the scenario of a demand or the month of a
//! price. They are not read, so every row would count, whatever its scenario: they are named.

use crate::cell::printable;
use crate::error::shortened;
use crate::row::Column;
use crate::units::words;
use crate::{Error, Warning};

/// Words by which columns split a table.
const SPLITTING: [&str; 26] = [
    "date",
    "day",
    "days",
    "weekday",
    "weekend",
    "dow",
    "daytype",
    "week",
    "month",
    "season",
    "quarter",
    "year",
    "scenario",
    "case",
    "variant",
    "alternative",
    "option",
    "class",
    "mode",
    "purpose",
    "segment",
    "product",
    "direction",
    "market",
    "node",
    "zone",
];
/// Words of the time of day, by which a table is split that has no periods.
const TIME_OF_DAY: [&str; 6] = ["period", "hour", "time", "timestamp", "interval", "peak"];
/// Words that may stand next to these.
const FILLING: [&str; 11] =
    ["of", "the", "type", "id", "name", "start", "service", "operating", "fare", "no", "code"];

/// A column that is not read, with its first value, and another one if it has several.
pub(crate) struct Unread<'a> {
    pub(crate) at: usize,
    name: &'a str,
    first: Option<String>,
    other: Option<String>,
}

/// The columns of a table that are not read, with their values.
pub(crate) struct UnreadColumns<'a> {
    list: Vec<Unread<'a>>,
    /// Whether the table has periods.
    has_periods: bool,
    /// Whether its rows are about pairs or periods.
    can_be_split: bool,
}

impl<'a> UnreadColumns<'a> {
    /// The columns of a header of which `found` are read for `wanted`, and `wide` besides.
    pub(crate) fn of(
        names: &'a [String],
        (found, wide): (&[Option<usize>], &[usize]),
        wanted: &[Column],
    ) -> Self {
        let is_read = |at: &usize| found.contains(&Some(*at)) || wide.contains(at);
        let is_unread = |at: &usize| !is_read(at) && !names[*at].is_empty();
        let unread = (0..names.len()).filter(is_unread);
        let list = unread.map(|at| Unread { at, name: &names[at], first: None, other: None });
        let has = |name: &str| wanted.iter().any(|column| column.names.contains(&name));
        let has_periods = has("period");
        Self { list: list.collect(), has_periods, can_be_split: has_periods || has("from") }
    }

    /// Keeps the first two values of each column.
    pub(crate) fn add<'row>(&mut self, value: impl Fn(usize) -> Option<&'row [u8]>) {
        for column in &mut self.list {
            let Some(value) = value(column.at).filter(|_| column.other.is_none()) else { continue };
            let value = shortened(&String::from_utf8_lossy(value.trim_ascii()), 40);
            match &column.first {
                None => column.first = Some(value),
                Some(first) if *first != value => column.other = Some(value),
                Some(_) => {}
            }
        }
    }

    /// The warnings of columns that split the table and have several values.
    pub(crate) fn warnings(&self, origin: &str) -> Vec<Warning> {
        let can = |_: &&Unread<'_>| self.can_be_split;
        let splits = |column: &&Unread<'_>| splits(column.name, self.has_periods);
        let splits = self.list.iter().filter(can).filter(splits);
        let several = splits.filter_map(|column| {
            let (first, other) = (column.first.as_ref()?, column.other.as_ref()?);
            Some(Warning::Columns {
                origin: origin.to_owned(),
                problem: format!(
                    "the column {:?} is not read, and has several values, such as {first:?} and {other:?}: all rows count, \
                     so keep those of one value",
                    shortened(&printable(column.name), 64)
                ),
            })
        });
        several.collect()
    }

    /// The error that something is given twice, with the columns in which the rows may differ.
    pub(crate) fn explained(&self, error: Error) -> Error {
        let Error::GivenTwice { origin, place, what, before, .. } = error else { return error };
        let several = self.list.iter().filter(|column| column.other.is_some());
        let names: Vec<String> =
            several.take(5).map(|column| format!("{:?}", shortened(column.name, 40))).collect();
        let hint = (!names.is_empty()).then(|| {
            let (columns, are) = if names.len() == 1 { ("column", "is") } else { ("columns", "are") };
            format!(
                "the {columns} {} {are} not read: if the table has several tables in it, keep the rows of one",
                names.join(", ")
            )
        });
        Error::GivenTwice { origin, place, what, before, hint }
    }
}

/// Whether a column of this name splits a table.
pub(crate) fn splits(name: &str, has_periods: bool) -> bool {
    let is = |list: &[&str], word: &String| list.contains(&word.as_str());
    let splitting = |word: &String| is(&SPLITTING, word) || !has_periods && is(&TIME_OF_DAY, word);
    let mut found = words(name).peekable();
    let is_named = found.peek().is_some();
    let all: Vec<String> = found.collect();
    is_named
        && all.iter().any(splitting)
        && all.iter().all(|word| splitting(word) || is(&FILLING, word))
}

#[cfg(test)]
mod tests {
    use super::splits;

    #[test]
    fn columns_that_split_a_table_are_told_from_others() {
        for name in
            ["date", "Scenario", "scenario_id", "day_type", "day of week", "month", "fare class"]
        {
            assert!(splits(name, true), "{name}");
        }
        for name in ["period", "hour", "time of day", "fare_period"] {
            assert!(splits(name, false) && !splits(name, true), "{name}");
        }
        for name in ["", "name", "note", "travel_time", "distance_mi", "passengers_per_day", "type"]
        {
            assert!(!splits(name, false), "{name}");
        }
    }
}
