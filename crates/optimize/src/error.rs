//! Errors of the bound and the planner, with stable codes (V5xx).

use vertifleet_core::{Code, Coded, Exit};

/// An expected error of this crate. Messages are fragments for users; [`Error::code`] is for
/// programs and the error index.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file that cannot be written (V102), as reported by `vertifleet-core`.
    #[error(transparent)]
    Core(#[from] vertifleet_core::Error),

    /// V501 step out of range. The step of a bound is not a whole number of minutes from 1 to 60.
    ///
    /// Fix: give a whole number of minutes from 1 to 60; 5 is usual.
    #[error("the step must be a whole number of minutes from 1 to 60, found {found}")]
    Step {
        /// The step in minutes.
        found: u32,
    },

    /// V502 day too large for a bound. The day has too many possible flights (types x pairs of
    /// vertiports within range x slices), or too many states of aircraft in time (types x
    /// vertiports x seconds). The message gives both numbers and the largest ones that a bound
    /// takes.
    ///
    /// Fix: A longer step gives fewer possible flights. If there are too many states, use fewer
    /// vertiports, types or hours.
    #[error(
        "slices of {step_s} s give {flights} possible flights and {places} places and seconds, and a bound takes at most \
         {most_flights} and {most_places}"
    )]
    TooManyFlights {
        /// The step, seconds.
        step_s: u32,
        /// Number of flights in all slices.
        flights: usize,
        /// The most flights that a bound takes.
        most_flights: usize,
        /// Number of places of aircraft in all seconds.
        places: usize,
        /// The most places that a bound takes.
        most_places: usize,
    },

    /// V505 levels out of range. The levels of charge of a bound are not a whole number from 4 to
    /// 64.
    ///
    /// Fix: give a whole number from 4 to 64; 64 is usual.
    #[error("the levels of charge must be a whole number from 4 to 64, found {found}")]
    Levels {
        /// The number of levels.
        found: u16,
    },

    /// V506 no plan in time. The search ended, by its limit of time or by Ctrl-C, before the first
    /// policy had played the day. The day is very large, or the machine is busy.
    ///
    /// Fix: give more time with `--time-limit`.
    #[error("the search ended before the first policy had played the day")]
    NoPlanInTime,

    /// V504 days of another network. `bound --without-foresight NETWORK` was given a day whose
    /// take-off delays that network never draws, or a network without delays for a day that has
    /// some. Only the probabilities of delays are known beforehand, and only the network has them.
    ///
    /// Fix: name the network that the day was drawn from.
    #[error("{day}: its take-off delays cannot have been drawn from the network {network:?}")]
    OtherNetwork {
        /// The day's name.
        day: String,
        /// The network's name.
        network: String,
    },
}

impl Coded for Error {
    fn code(&self) -> Code {
        Code(match self {
            Self::Core(error) => return error.code(),
            Self::Step { .. } => 501,
            Self::TooManyFlights { .. } => 502,
            Self::OtherNetwork { .. } => 504,
            Self::Levels { .. } => 505,
            Self::NoPlanInTime => 506,
        })
    }

    fn hint(&self) -> Option<&str> {
        match self {
            Self::Core(error) => error.hint(),
            Self::TooManyFlights { .. } => Some("a longer step gives fewer possible flights"),
            Self::OtherNetwork { .. } => Some("name the network that the day was drawn from"),
            Self::NoPlanInTime => Some("give more time with --time-limit"),
            Self::Step { .. } | Self::Levels { .. } => None,
        }
    }

    fn exit(&self) -> Exit {
        match self {
            Self::Core(error) => error.exit(),
            Self::Step { .. }
            | Self::TooManyFlights { .. }
            | Self::OtherNetwork { .. }
            | Self::Levels { .. } => Exit::Input,
            Self::NoPlanInTime => Exit::Failed,
        }
    }
}
