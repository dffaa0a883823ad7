//! Warnings of a planner's files: contents that are allowed but probably unintended.

use std::fmt;

use vertifleet_core::Code;

/// A property of a planner's files that is allowed but probably unintended.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// V718 strange demand in data of your own (warning). A demand that is imported has no
    /// passengers at all; or one of its periods lasts longer than others, as a period lasts until
    /// the next one that the table has, or until operations end; or the table states another end of
    /// a period than that; or passengers want to fly outside of the hours of operation. This is a
    /// warning: the network is made all the same.
    ///
    /// Fix: look at the rows. Give each hour a row, with 0 passengers where there are none. Change
    /// `[operations]` in the new file if your vertiports are open at other times than those of the
    /// base.
    Demand {
        /// The file.
        origin: String,
        /// The problem, and its consequences.
        problem: String,
    },

    /// V719 strange places of vertiports (warning). Two vertiports of an import are at the same
    /// place, or all of them are within 18 degrees of a pole, where latitude and longitude are
    /// probably exchanged. This is a warning: the network is made all the same.
    ///
    /// Fix: correct the positions.
    Places {
        /// The file.
        origin: String,
        /// The vertiports and the problem.
        problem: String,
    },

    /// V720 price that changes within a demand period (warning). A network has one price of
    /// electricity for each demand period, and the table of an import changes it within one. Such a
    /// period has the mean over its time. Or the table states another end of a price than the begin
    /// of the next one. This is a warning: the network is made all the same.
    ///
    /// Fix: give the demand in periods that begin when the price changes, and each time a price.
    EnergyPrices {
        /// The file.
        origin: String,
        /// When they change.
        problem: String,
    },

    /// V740 column that is not read (warning). A file does not have a column or property that is
    /// read, and has one of a similar name that is not read, such as `charger` for `chargers`, or
    /// one in another unit. Or a table of demand, fares or prices has columns that are not read and
    /// have several values, and they may split it, as `scenario` or `month` do. This is a warning:
    /// the network is made all the same.
    ///
    /// Fix: rename it if it means that, convert its numbers, keep the rows of one value, or remove
    /// the column.
    Columns {
        /// The file.
        origin: String,
        /// The column, and its possible meaning.
        problem: String,
    },

    /// V741 strange trip records (warning). Trip records are probably not what they seem. Their
    /// times have a time zone and are not converted, or cannot be read; dates have hardly any
    /// records, or are far from the others, and count as days all the same; days and months are
    /// exchanged; days between the dates that were given have none; two files are the same;
    /// latitude and longitude are exchanged, in the records or the zones, or positions are in
    /// metres; a column that seems to hold the passengers is not read. This is a warning: the
    /// network is made all the same.
    ///
    /// Fix: the message names the flag or the file to change.
    Trips {
        /// The files.
        origin: String,
        /// The problem, and the remedy.
        problem: String,
    },
}

impl Warning {
    /// The stable number, printed as `V718`.
    pub fn code(&self) -> Code {
        match self {
            Self::Demand { .. } => Code(718),
            Self::Places { .. } => Code(719),
            Self::EnergyPrices { .. } => Code(720),
            Self::Columns { .. } => Code(740),
            Self::Trips { .. } => Code(741),
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Demand { origin, problem }
            | Self::Places { origin, problem }
            | Self::EnergyPrices { origin, problem }
            | Self::Columns { origin, problem }
            | Self::Trips { origin, problem } => {
                write!(f, "{origin}: {problem}")
            }
        }
    }
}
