//! What a planner's files may say but hardly mean. Nothing is refused for it.

use std::fmt;

use vertifleet_core::Code;

/// Something in a planner's files that is allowed but hardly meant.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// V718. The demand is hardly meant: there are no passengers at all, a period lasts longer than others because the
    /// next one is missing, or passengers want to fly outside the hours of operation. Fix: give each hour a row, also
    /// those with 0 passengers; change the hours of operation.
    Demand {
        /// The file.
        origin: String,
        /// What is strange, and what follows from it.
        problem: String,
    },

    /// V719. Vertiports are hardly where they are meant to be: two stand at the same place, or all of them where no one
    /// lives. Fix: correct the positions; latitude and longitude may be exchanged.
    Places {
        /// The file.
        origin: String,
        /// Which vertiports, and what is strange.
        problem: String,
    },

    /// V720. Prices of electricity change within demand periods, each of which has one price. Fix: give the demand in
    /// periods that begin when prices change.
    EnergyPrices {
        /// The file.
        origin: String,
        /// When they change.
        problem: String,
    },

    /// V740. A column or property is not read, and has nearly the name of one that is read and that the file does not have.
    /// Fix: rename it if it means that.
    Columns {
        /// The file.
        origin: String,
        /// Which one, and what it may mean.
        problem: String,
    },

    /// V741. Trip records hardly say what is meant: times with a time zone that are not converted, times that cannot be read,
    /// dates with hardly any records, days without any, a file given twice, exchanged coordinates, passengers that are not
    /// read. Fix: as the message says.
    Trips {
        /// The files.
        origin: String,
        /// What is strange, and what to do.
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
