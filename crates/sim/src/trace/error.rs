//! Expected errors of reading and writing traces, V204 to V208. The error index is written from the
//! comments here.

use vertifleet_core::{Code, Coded, Exit};

/// An error in a trace file. Lines are counted from 1, which is the header.
#[derive(Debug, thiserror::Error)]
pub enum TraceError {
    /// The file cannot be read or written, or is longer than any trace needs to be.
    #[error(transparent)]
    Core(#[from] vertifleet_core::Error),

    /// V204 trace with too many rows. The file has more rows than any day has decisions (4
    /// million).
    ///
    /// Fix: check that it is the right file, and that it holds one day only.
    #[error("{origin}: line {line}: a trace has at most {limit} rows")]
    TooManyRows {
        /// The path.
        origin: String,
        /// The first line that is too many.
        line: usize,
        /// The most rows that are read.
        limit: usize,
    },

    /// V205 not the header of a trace. The first line is not the header of a trace: the file is
    /// something else, or its columns were renamed or moved.
    ///
    /// Fix: give the columns the names and the order that the message states.
    #[error("{origin}: line 1: the header must be {expected:?}, found {found:?}")]
    WrongHeader {
        /// The path.
        origin: String,
        /// The columns of a trace.
        expected: String,
        /// The first line, cut short if it is long.
        found: String,
    },

    /// V206 row with too few or too many values. A row does not have one value for each column.
    ///
    /// Fix: look for a missing or doubled comma, or for a quote that is never closed, in the line
    /// that the message names. An id that contains a comma or a quote must be put in quotes, with
    /// its own quotes doubled.
    #[error("{origin}: line {line}: a row must have {expected} values, found {found}")]
    WrongWidth {
        /// The path.
        origin: String,
        /// The row's line.
        line: usize,
        /// Number of columns.
        expected: usize,
        /// Number of values in the row.
        found: usize,
    },

    /// V207 aircraft or vertiport unknown to the scenario. A row names an aircraft or a vertiport
    /// that the scenario does not have.
    ///
    /// Fix: read the trace with the scenario that it was made from, or correct the id.
    #[error("{origin}: line {line}: {column} {found:?} is not among the scenario's {list}")]
    UnknownId {
        /// The path.
        origin: String,
        /// The row's line.
        line: usize,
        /// The column.
        column: &'static str,
        /// The id in the row, cut short if it is long.
        found: String,
        /// The list that has no such entry.
        list: &'static str,
    },

    /// V208 value that its column cannot hold. A value is not what its column holds: a time that is
    /// not `HH:MM:SS`, a number of passengers that is not whole, an amount that is negative or not
    /// finite.
    ///
    /// Fix: correct the value that the message names.
    #[error("{origin}: line {line}: {column} must be {rule}, found {found:?}")]
    WrongValue {
        /// The path.
        origin: String,
        /// The row's line.
        line: usize,
        /// The column.
        column: &'static str,
        /// The rule that the value breaks.
        rule: &'static str,
        /// The value, cut short if it is long.
        found: String,
    },
}

impl Coded for TraceError {
    fn code(&self) -> Code {
        Code(match self {
            Self::Core(error) => return error.code(),
            Self::TooManyRows { .. } => 204,
            Self::WrongHeader { .. } => 205,
            Self::WrongWidth { .. } => 206,
            Self::UnknownId { .. } => 207,
            Self::WrongValue { .. } => 208,
        })
    }

    fn hint(&self) -> Option<&str> {
        match self {
            Self::Core(error) => error.hint(),
            Self::UnknownId { .. } => Some("a trace belongs to the scenario that it was made from"),
            // Traces differ only in the last column.
            Self::WrongHeader { expected, found, .. }
                if expected.starts_with(found.as_str()) || found.starts_with(expected.as_str()) =>
            {
                Some(
                    "flight_cost is a column on days with flight costs alone: the trace is of another scenario",
                )
            }
            Self::WrongWidth { .. } => Some(
                "an id with a comma or a quote in it stands in quotes, with its own quotes doubled",
            ),
            _ => None,
        }
    }

    fn exit(&self) -> Exit {
        match self {
            Self::Core(error) => error.exit(),
            _ => Exit::Input,
        }
    }
}
