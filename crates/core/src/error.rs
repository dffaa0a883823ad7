//! Expected errors of reading, checking, writing and drawing: what is wrong in the user's files, and what to do.
//!
//! Messages are lower-case fragments that name file, member, value and rule. `docs/src/reference/errors.md` is written
//! from the comments here, which give the cause first and then the fix.

use std::io;

use crate::code::{Coded, Exit};
use crate::limits::SEED_LIMIT;
use crate::output_error::OutputError;
use crate::{Code, FileKind};

/// An error in a file, a network, a scenario or a seed.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// V101. The operating system does not let the file be read: it does not exist, is a folder, or belongs to
    /// another user. Fix: correct the path or the file's permissions.
    #[error("{origin}: cannot be read: {cause}")]
    CannotRead {
        /// The path.
        origin: String,
        /// The operating system's message.
        cause: io::Error,
    },

    /// V102. The operating system does not let the file be written. Fix: create the folder, free some space, or
    /// choose a path that may be written. What was there before is still there.
    #[error("{origin}: cannot be written: {cause}")]
    CannotWrite {
        /// The path.
        origin: String,
        /// The operating system's message.
        cause: io::Error,
    },

    /// V103. The file is longer than any file of its kind has reason to be (64 MiB for a scenario, 32 MiB for a
    /// network, 16 MiB for a table of demand). Fix: check that it is the right file; describe fewer or longer demand
    /// periods.
    #[error("{origin}: the file is longer than {limit} bytes")]
    FileTooLarge {
        /// The path.
        origin: String,
        /// The greatest length that is read, bytes.
        limit: u64,
    },

    /// V104. A number is negative, not finite, not whole where it counts something, or outside the bounds that the
    /// message states. Fix: correct the member that the message names.
    #[error("{origin}: {member} must be {rule}, found {found}")]
    OutOfRange {
        /// The file.
        origin: String,
        /// Path of the member inside the file.
        member: String,
        /// The rule that the number breaks.
        rule: String,
        /// The number.
        found: String,
        /// The meaning of the member, where it is easily mistaken.
        hint: Option<&'static str>,
    },

    /// V105. The text is not JSON (a scenario) or TOML (a network). Fix: look at the line and column in the message,
    /// often a comma or a quote is missing just before.
    #[error("{origin}: line {line}, column {column}: {problem}")]
    NotParsed {
        /// The file.
        origin: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// The parser's message.
        problem: String,
    },

    /// V106. A member is unknown, missing, given twice, or of another kind than its format asks for (a text for a
    /// number, a time that is not `HH:MM:SS`). Fix: compare the member that the message names with the format's page.
    #[error("{origin}: line {line}, column {column}: {member}{problem}")]
    WrongMember {
        /// The file.
        origin: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// Path of the member and a colon, or nothing for the file as a whole.
        member: String,
        /// The parser's message.
        problem: String,
    },

    /// V107. The file says that it has another format or version than this program reads. Fix: give the right file,
    /// or write it again with this version of the program.
    #[error("{origin}: format must be {expected:?}, found {found:?}")]
    UnknownFormat {
        /// The file.
        origin: String,
        /// The format that this program reads.
        expected: &'static str,
        /// The format that the file states.
        found: String,
    },

    /// V107. The file does not say which format it has, so it is probably something else. Fix: give the right file.
    #[error("{origin}: has no member `format`, which would be {expected:?}")]
    NoFormat {
        /// The file.
        origin: String,
        /// The format that this program reads.
        expected: &'static str,
    },

    /// V108. A list is empty or has more entries than this program takes. Fix: add or remove entries.
    #[error("{origin}: {member} must have 1 to {most} entries, found {found}")]
    EntryCount {
        /// The file.
        origin: String,
        /// The list.
        member: String,
        /// The most entries that it may have.
        most: usize,
        /// The number of entries that it has.
        found: usize,
    },

    /// V109. A table does not have one row and one column for each vertiport, or a list does not have one entry for
    /// each demand period. Fix: add or remove entries in the member that the message names.
    #[error("{origin}: {member} must have {expected}, found {found}")]
    WrongShape {
        /// The file.
        origin: String,
        /// The table or list.
        member: String,
        /// The entries that it has to have.
        expected: String,
        /// The number of entries that it has.
        found: usize,
    },

    /// V110. Two entries of one list have the same id. Fix: rename one of them.
    #[error("{origin}: {member} has the same id as an entry before it")]
    DuplicateId {
        /// The file.
        origin: String,
        /// The second of the two entries.
        member: String,
    },

    /// V111. A member refers to an entry that does not exist. Fix: correct the id, or add the entry.
    #[error("{origin}: {member} names {found:?}, which is not among the {list}")]
    UnknownId {
        /// The file.
        origin: String,
        /// The member that refers to an entry.
        member: String,
        /// The id that the member gives.
        found: String,
        /// The list that has no such entry.
        list: &'static str,
    },

    /// V112. An id or name is empty, too long, or has characters that cannot be printed or used in a file's name.
    /// Fix: choose a short plain name.
    #[error("{origin}: {member} must be {rule}, found {found:?}")]
    BadId {
        /// The file.
        origin: String,
        /// The id or name.
        member: String,
        /// The rule that it breaks.
        rule: &'static str,
        /// The id or name, cut short if it is long.
        found: String,
    },

    /// V113. More aircraft start the day at a vertiport than it has stands. Fix: move aircraft elsewhere, or add
    /// stands.
    #[error(
        "{origin}: vertiport {vertiport:?} has stands for {stands} aircraft, and {aircraft} start there"
    )]
    StandsExceeded {
        /// The file.
        origin: String,
        /// The vertiport.
        vertiport: String,
        /// Number of its stands.
        stands: u16,
        /// Number of aircraft that start there.
        aircraft: usize,
    },

    /// V114. Operations, a closure or an outage start after they end. Fix: exchange the two; an end after midnight is
    /// written `25:30:00`.
    #[error("{origin}: {member}: start must not be after end {end}, found {start}")]
    StartAfterEnd {
        /// The file.
        origin: String,
        /// The member with the start and the end.
        member: String,
        /// First instant.
        start: String,
        /// Last instant.
        end: String,
    },

    /// V115. A demand period starts no later than the one before it, or the first one starts after operations do.
    /// Fix: list the periods in the order of the day, the first no later than the start of operations.
    #[error("{origin}: {member} must be {rule}, found {found}")]
    PeriodOrder {
        /// The file.
        origin: String,
        /// The period.
        member: String,
        /// The rule that it breaks.
        rule: String,
        /// The start of the period.
        found: String,
    },

    /// V116. Passengers want to fly from a vertiport to itself. Fix: set the diagonal of the demand tables to 0.
    #[error(
        "{origin}: {member} must be 0, found {found}: no flight goes from a vertiport to itself"
    )]
    SelfDemand {
        /// The file.
        origin: String,
        /// The cell.
        member: String,
        /// Number of passengers in the cell.
        found: u32,
    },

    /// V117. A network has more aircraft than all its stands together, so that no day of it can be drawn. Fix: add
    /// stands or vertiports, or remove aircraft.
    #[error(
        "{origin}: the fleet has {aircraft} aircraft, and the vertiports have {stands} stands together"
    )]
    FleetTooLarge {
        /// The file.
        origin: String,
        /// Aircraft in the fleet.
        aircraft: usize,
        /// Stands of all vertiports.
        stands: usize,
    },

    /// V118. A seed, or the number of a day of training or validation, is outside the range that keeps the days of
    /// different purposes apart. Fix: choose a smaller one.
    #[error("{member} must be a whole number below {limit}, found {found}")]
    SeedOutOfRange {
        /// The name of the number, with its file if it has one.
        member: String,
        /// The first number that is too large.
        limit: u64,
        /// The number.
        found: String,
    },

    /// V121. A file has several of the members of which it must have exactly one, or none of them. Fix: keep the one
    /// you mean.
    #[error("{origin}: {member} must have {choices}, found {found}")]
    NotOneOf {
        /// The file.
        origin: String,
        /// The member that contains them.
        member: String,
        /// The members to choose from.
        choices: &'static str,
        /// The number of them that it has.
        found: usize,
    },

    /// V122. A route leads from a vertiport to itself. Fix: name two vertiports.
    #[error("{origin}: {member} leads from {vertiport:?} to itself")]
    RouteToItself {
        /// The file.
        origin: String,
        /// The route.
        member: String,
        /// The vertiport.
        vertiport: String,
    },

    /// V123. A change of a network names a member by a path that leads nowhere. Fix: name members as they stand in the
    /// network file, and the entries of a list by their `id` or their position from 0.
    #[error("{path:?} leads nowhere: there is no {part:?}")]
    NoSuchMember {
        /// The path.
        path: String,
        /// The first part of the path that does not exist.
        part: String,
    },

    /// V130. A file of another kind is given: a network file where a scenario is expected, or the other way round. Fix:
    /// draw a scenario from the network with `vertifleet scenario`, or give the network that the scenario was drawn
    /// from.
    #[error("{origin}: this is {found}, and {expected} is expected")]
    WrongKind {
        /// The file.
        origin: String,
        /// The kind of the file.
        found: &'static str,
        /// The kind that is expected.
        expected: FileKind,
    },

    /// V131. A row of a table of demand does not fit the table's columns, or the first line does not hold their names.
    /// Fix: correct the line that the message names; numbers have a decimal point, and commas only stand between
    /// columns.
    #[error("{origin}: line {line}: {column} must be {rule}, found {found:?}")]
    TableRow {
        /// The table's file.
        origin: String,
        /// The row's line, from 1.
        line: usize,
        /// The column, or the row or header as a whole.
        column: &'static str,
        /// The rule that it breaks.
        rule: String,
        /// The text found, cut short if it is long.
        found: String,
    },

    /// V132. A network names a table of demand beside its file, but is given as a text, which lies in no folder. Fix:
    /// read the network from its file, or put the table's rows into it as `pairs`.
    #[error(
        "{origin}: hourly_demand: table {table:?} is to be read from the folder of the network file, and there is none"
    )]
    TableWithoutFolder {
        /// The network.
        origin: String,
        /// The table's path.
        table: String,
    },

    /// V133. Demand, tariff or elasticity of one pair, or the demand of one pair and period in a table, is given twice.
    /// Fix: remove one of the two.
    #[error("{origin}: {member} gives {what} again")]
    GivenTwice {
        /// The network or table.
        origin: String,
        /// The second of the two members.
        member: String,
        /// What is given again, with its pair, or its period and pair.
        what: String,
    },

    /// V134. A setting of a distribution of demand is missing, or belongs to another distribution: `noise` belongs to
    /// `normal`, `dispersion` to `negative-binomial`. Fix: add or remove it, or name the other distribution.
    #[error("{origin}: {member} {rule} with the distribution {distribution:?}")]
    UnfitSetting {
        /// The file.
        origin: String,
        /// The setting.
        member: String,
        /// The rule that it breaks.
        rule: &'static str,
        /// The distribution.
        distribution: &'static str,
    },

    /// V119. A name is neither a shipped network, nor a random one, nor a file. Fix: give one of the names that the
    /// message lists, `random:` and a number, or the path of a network file.
    #[error(
        "there is no network {name:?}: shipped are {shipped}, random:NUMBER and random-places:SIZE:NUMBER draw one, and no file has that path"
    )]
    UnknownNetwork {
        /// The name that was asked for.
        name: String,
        /// The names of the shipped networks.
        shipped: String,
        /// A question whether a similar shipped name was meant, if there is one.
        meant: Option<String>,
    },

    /// A refusal to write over a file that would be lost (V141 to V144).
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// Every code of this crate with a title, in order: the index that the documentation is checked against.
pub const ALL: &[(Code, &str)] = &[
    (Code(101), "file cannot be read"),
    (Code(102), "file cannot be written"),
    (Code(103), "file too large"),
    (Code(104), "number out of range"),
    (Code(105), "not JSON or TOML"),
    (Code(106), "unknown, missing or wrong member"),
    (Code(107), "unknown format"),
    (Code(108), "empty or endless list"),
    (Code(109), "wrong shape"),
    (Code(110), "duplicate id"),
    (Code(111), "unknown id"),
    (Code(112), "bad id"),
    (Code(113), "more aircraft than stands at a vertiport"),
    (Code(114), "start after end"),
    (Code(115), "demand periods out of order"),
    (Code(116), "demand from a vertiport to itself"),
    (Code(117), "fleet larger than all stands"),
    (Code(118), "seed out of range"),
    (Code(119), "unknown network"),
    (Code(120), "aircraft without a destination (warning)"),
    (Code(121), "not exactly one of several members"),
    (Code(122), "route from a vertiport to itself"),
    (Code(130), "network for a scenario, or the other way round"),
    (Code(131), "wrong row in a table of demand"),
    (Code(132), "table of demand without a folder"),
    (Code(133), "pair given twice"),
    (Code(134), "setting that does not fit its distribution"),
    (Code(135), "vertiport out of reach (warning)"),
];

impl Coded for Error {
    fn code(&self) -> Code {
        Code(match self {
            Self::CannotRead { .. } => 101,
            Self::CannotWrite { .. } => 102,
            Self::FileTooLarge { .. } => 103,
            Self::OutOfRange { .. } => 104,
            Self::NotParsed { .. } => 105,
            Self::WrongMember { .. } => 106,
            Self::UnknownFormat { .. } | Self::NoFormat { .. } => 107,
            Self::EntryCount { .. } => 108,
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
            Self::UnknownNetwork { .. } => 119,
            Self::NotOneOf { .. } => 121,
            Self::RouteToItself { .. } => 122,
            Self::NoSuchMember { .. } => 123,
            Self::WrongKind { .. } => 130,
            Self::TableRow { .. } => 131,
            Self::TableWithoutFolder { .. } => 132,
            Self::GivenTwice { .. } => 133,
            Self::UnfitSetting { .. } => 134,
            Self::Output(refusal) => return refusal.code(),
        })
    }

    fn hint(&self) -> Option<&str> {
        match self {
            Self::OutOfRange { hint, .. } => *hint,
            Self::CannotWrite { .. } => {
                Some("what was there before under this name is still there, unchanged")
            }
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
            Self::SeedOutOfRange { limit: SEED_LIMIT, .. } => {
                Some("the limit is 2^53: every JSON reader holds whole numbers below it exactly")
            }
            Self::SeedOutOfRange { .. } => {
                Some("seeds for comparison, validation and training are kept apart by their size")
            }
            Self::UnknownNetwork { meant: Some(meant), .. } => Some(meant),
            Self::UnknownNetwork { .. } => Some("a network file is TOML, see networks/paper.toml"),
            Self::Output(refusal) => refusal.hint(),
            Self::NoSuchMember { .. } => Some(
                "members are named as in the network file, entries of a list by id (in the fleet by type), position or *",
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
            _ => None,
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
