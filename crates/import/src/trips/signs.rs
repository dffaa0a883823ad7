//! Observations made while trip records are added, besides their sums: the first row that was
//! dropped for each reason, and signs that records are wrong.

use super::tally::{REASONS, Record};
use crate::cell::Cell;
use crate::cell::without_controls;
use crate::error::shortened;

/// The text of a row, for a person who looks it up.
#[derive(Debug, Clone, Copy)]
pub(super) enum RowText<'row> {
    Line(&'row [u8]),
    /// The values that are read.
    Cells(&'row [Cell<'row>]),
}

impl RowText<'_> {
    fn shown(self) -> String {
        let text = match self {
            Self::Line(line) => String::from_utf8_lossy(line.trim_ascii()).into_owned(),
            Self::Cells(cells) => {
                let given = cells.iter().filter(|cell| **cell != Cell::Missing);
                given.map(|cell| cell.shown()).collect::<Vec<_>>().join(", ")
            }
        };
        shortened(&without_controls(&text), 160)
    }
}

/// The first row that was dropped for a reason.
#[derive(Debug, Clone)]
pub(super) struct FirstRow {
    pub(super) position: Position,
    pub(super) text: String,
}

/// Where a record stands: the number of its file, and a byte or row of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Position {
    pub(super) file: usize,
    pub(super) at: u64,
}

/// Signs that records are wrong.
#[derive(Debug, Clone, Default)]
pub(super) struct Signs {
    /// Records whose time is an instant.
    pub(super) instants: u64,
    /// The first time that cannot be read, and where it stands.
    pub(super) unreadable: Option<(Position, String)>,
    /// Records whose ends would be near vertiports if latitude and longitude were exchanged, and
    /// are not as they are.
    pub(super) exchanged: u64,
    /// Records with a place that is not in degrees.
    pub(super) no_degrees: u64,
    /// The first row that was dropped for each reason.
    pub(super) first_dropped: [Option<FirstRow>; REASONS],
}

impl Signs {
    /// Keeps the first row that is dropped for a reason, of those that are given.
    #[inline]
    pub(super) fn drop_row(&mut self, reason: usize, position: Position, row: RowText<'_>) {
        let first = &mut self.first_dropped[reason];
        if first.as_ref().is_none_or(|first| position < first.position) {
            *first = Some(FirstRow { position, text: row.shown() });
        }
    }

    /// Keeps the first time that cannot be read.
    #[cold]
    pub(super) fn cannot_read(&mut self, record: &Record<'_>) {
        let is_first = self.unreadable.as_ref().is_none_or(|(before, _)| record.position < *before);
        if is_first && record.time != Cell::Missing {
            self.unreadable = Some((record.position, shortened(&record.time.shown(), 40)));
        }
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.instants += other.instants;
        self.exchanged += other.exchanged;
        self.no_degrees += other.no_degrees;
        let firsts = [&self.unreadable, &other.unreadable].into_iter().flatten();
        self.unreadable = firsts.min_by_key(|(position, _)| *position).cloned();
        for (mine, others) in self.first_dropped.iter_mut().zip(&other.first_dropped) {
            let firsts = [mine.take(), others.clone()].into_iter().flatten();
            *mine = firsts.min_by_key(|first| first.position);
        }
    }
}
