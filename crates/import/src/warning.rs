//! What a planner's files may say but hardly mean. Nothing is refused for it.

use std::fmt;

use vertifleet_core::Code;

/// Something in a planner's files that is allowed but hardly meant.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// V718. The demand is hardly meant: there are no passengers at all. Fix: look at what the message names.
    Demand {
        /// The file.
        origin: String,
        /// What is strange, and what follows from it.
        problem: String,
    },

    /// V719. Vertiports are hardly where they are meant to be: two stand at the same place, or all of them where nobody
    /// lives. Fix: correct the positions; latitude and longitude may be exchanged.
    Places {
        /// The file.
        origin: String,
        /// Which vertiports, and what is strange.
        problem: String,
    },
}

impl Warning {
    /// The stable number, printed as `V718`.
    pub fn code(&self) -> Code {
        match self {
            Self::Demand { .. } => Code(718),
            Self::Places { .. } => Code(719),
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Demand { origin, problem } | Self::Places { origin, problem } => {
                write!(f, "{origin}: {problem}")
            }
        }
    }
}
