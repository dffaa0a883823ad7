//! Columns of a table that are not read. All rows count, whatever such a column has in them, so a
//! table of several scenarios, months or classes would be added up: those with several values are
//! named.

use crate::cell::{Cell, printable};
use crate::error::shortened;
use crate::row::Column;
use crate::{Error, Warning};

/// The most columns that are named.
const SHOWN: usize = 6;

/// A column that is not read, with its first value, and another one if it has several.
struct Unread<'a> {
    at: usize,
    name: &'a str,
    first: Option<String>,
    other: Option<String>,
}

/// The columns of a table that are not read, with their values.
pub(crate) struct UnreadColumns<'a> {
    list: Vec<Unread<'a>>,
    /// Whether its rows are about pairs or periods, of which a table may have several sets.
    can_be_split: bool,
}

impl<'a> UnreadColumns<'a> {
    /// The columns of a table of which those at some positions are read for `wanted`.
    pub(crate) fn of(names: &'a [String], read: &[usize], wanted: &[Column]) -> Self {
        let is_unread = |at: &usize| !read.contains(at) && !names[*at].is_empty();
        let unread = (0..names.len()).filter(is_unread);
        let list = unread.map(|at| Unread { at, name: &names[at], first: None, other: None });
        let has = |name: &str| wanted.iter().any(|column| column.names.contains(&name));
        Self { list: list.collect(), can_be_split: has("period") || has("from") }
    }

    /// The positions of the columns.
    pub(crate) fn positions(&self) -> impl Iterator<Item = usize> {
        self.list.iter().map(|column| column.at)
    }

    /// Adds the values of a row, in the order of the positions. The first two values of each column
    /// are stored.
    pub(crate) fn add(&mut self, values: &[Cell<'_>]) {
        for (column, value) in self.list.iter_mut().zip(values) {
            if column.other.is_some() {
                continue;
            }
            let value = shortened(&value.shown(), 40);
            match &column.first {
                None => column.first = Some(value),
                Some(first) if *first != value => column.other = Some(value),
                Some(_) => {}
            }
        }
    }

    /// The warning of the columns that have several values, but for those at the positions that
    /// another warning names.
    pub(crate) fn warning(&self, origin: &str, named: &[usize]) -> Option<Warning> {
        let several = self.list.iter().filter(|column| !named.contains(&column.at));
        let mut shown: Vec<String> = several
            .filter_map(|column| {
                let (first, other) = (column.first.as_ref()?, column.other.as_ref()?);
                let name = shortened(&printable(column.name), 64);
                Some(format!("{name:?} (such as {first:?} and {other:?})"))
            })
            .collect();
        let found = shown.len();
        shown.truncate(SHOWN);
        if found > SHOWN {
            shown.push(format!("{} more", found - SHOWN));
        }
        let (columns, one) = match shown.as_slice() {
            [] => return None,
            [column] => (format!("the column {column} is"), "it"),
            [before @ .., last] => {
                (format!("the columns {} and {last} are", before.join(", ")), "one of them")
            }
        };
        let problem = format!(
            "{columns} not read, and all rows count: if {one} splits the table, as a scenario, a date or a class does, keep the \
             rows of one value"
        );
        self.can_be_split.then(|| Warning::Columns { origin: origin.to_owned(), problem })
    }

    /// The error that something is given twice, with the columns in which the rows may differ.
    pub(crate) fn explained(&self, error: Error) -> Error {
        let Error::GivenTwice { origin, place, what, before, .. } = error else { return error };
        let several = self.list.iter().filter(|column| column.other.is_some());
        let names: Vec<String> =
            several.take(SHOWN).map(|column| format!("{:?}", shortened(column.name, 40))).collect();
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
