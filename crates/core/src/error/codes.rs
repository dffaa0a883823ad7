//! The codes of the errors, their hints and exit codes.

use super::{Error, FormatError};
use crate::code::{Coded, Exit};
use crate::{Code, FileKind};

impl Coded for Error {
    fn code(&self) -> Code {
        Code(match self {
            Self::CannotRead { .. } => 101,
            Self::CannotWrite { .. } => 102,
            Self::InFile { error, .. } => return error.code(),
            Self::SeedOutOfRange { .. } => 118,
            Self::UnknownNetwork { .. } => 119,
            Self::NoSuchMember { .. } => 123,
            Self::Output(refusal) => return refusal.code(),
        })
    }

    fn hint(&self) -> Option<&str> {
        match self {
            Self::CannotWrite { .. } => {
                Some("what was there before under this name is still there, unchanged")
            }
            Self::InFile { error, .. } => error.hint(),
            Self::SeedOutOfRange { .. } => {
                Some("seeds for comparison, validation and training are kept apart by their size")
            }
            Self::UnknownNetwork { meant: Some(meant), .. } => Some(meant),
            Self::UnknownNetwork { .. } => Some("a network file is TOML, see networks/paper.toml"),
            Self::Output(refusal) => refusal.hint(),
            Self::NoSuchMember { .. } => Some(
                "members are named as in the network file, entries of a list by id (in the fleet by type), position or *",
            ),
            Self::CannotRead { .. } => None,
        }
    }

    fn exit(&self) -> Exit {
        match self {
            Self::CannotWrite { .. } => Exit::Failed,
            Self::Output(refusal) => refusal.exit(),
            _ => Exit::Input,
        }
    }
}

impl FormatError {
    fn code(&self) -> Code {
        Code(match self {
            Self::FileTooLarge { .. } => 103,
            Self::OutOfRange { .. } => 104,
            Self::NotParsed { .. } => 105,
            Self::WrongMember { .. } => 106,
            Self::UnknownFormat { .. } | Self::NoFormat { .. } => 107,
            Self::EntryCount { .. } | Self::NoAircraft => 108,
            Self::WrongShape { .. } => 109,
            Self::DuplicateId { .. } => 110,
            Self::UnknownId { .. } => 111,
            Self::BadId { .. } => 112,
            Self::StandsExceeded { .. } => 113,
            Self::StartAfterEnd { .. } => 114,
            Self::PeriodOrder { .. } => 115,
            Self::SelfDemand { .. } => 116,
            Self::FleetTooLarge { .. } => 117,
            Self::SeedOutOfRange { .. } => 118,
            Self::NotOneOf { .. } => 121,
            Self::RouteToItself { .. } => 122,
            Self::WrongKind { .. } => 130,
            Self::TableRow { .. } => 131,
            Self::TableWithoutFolder { .. } => 132,
            Self::GivenTwice { .. } => 133,
            Self::UnfitSetting { .. } => 134,
        })
    }

    fn hint(&self) -> Option<&'static str> {
        match self {
            Self::OutOfRange { hint, .. } => *hint,
            Self::StartAfterEnd { .. } => {
                Some("times go on past midnight: half past one at night is 25:30:00")
            }
            Self::UnknownId { .. } => Some("ids are compared letter by letter, capitals matter"),
            Self::StandsExceeded { .. } | Self::FleetTooLarge { .. } => {
                Some("an aircraft needs a stand wherever it is, also on its way there")
            }
            Self::PeriodOrder { .. } => Some(
                "a period lasts until the next one starts, the last one for the rest of the day",
            ),
            Self::WrongKind { expected: FileKind::Scenario, .. } => Some(
                "`vertifleet scenario FILE --seed 1 --output DAY.json` draws a scenario from a network",
            ),
            Self::WrongKind { expected: FileKind::Network, .. } => Some(
                "`vertifleet simulate`, `check`, `bound` and `plan` take scenarios; a network file is TOML, see networks/paper.toml",
            ),
            Self::TableRow { .. } => Some(
                "a table has the columns period,from,to,passengers, with commas between them and a decimal point in numbers",
            ),
            Self::SeedOutOfRange { .. } => {
                Some("the limit is 2^53: every JSON reader holds whole numbers below it exactly")
            }
            _ => None,
        }
    }
}
