//! Expected errors of reading, checking, writing and drawing: what is wrong in the user's files,
//! and what to do.
//!
//! Messages are lower-case fragments that name file, member, value and rule.
//! `docs/src/reference/errors.md` is written from the comments here, which give the cause first and
//! then the fix.

mod codes;

use std::{fmt, io};

use crate::OutputError;

/// An error in a file, a network, a scenario or a seed.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// V101 file cannot be read. The operating system does not let the file be read: it does not
    /// exist, is a folder, or belongs to another user.
    ///
    /// Fix: correct the path or the file's permissions.
    #[error("{origin}: cannot be read: {cause}")]
    CannotRead {
        /// The path.
        origin: String,
        /// The operating system's message.
        cause: io::Error,
    },

    /// V102 file cannot be written. The operating system does not let the file be written: the
    /// folder does not exist, is not yours, or is full. What was there before is still there. A
    /// report replaces its whole folder. So this folder can be neither the one that the program
    /// runs in nor a mount point.
    ///
    /// Fix: create the folder, free some space, or choose a path that may be written.
    #[error("{origin}: cannot be written: {cause}")]
    CannotWrite {
        /// The path.
        origin: String,
        /// The operating system's message.
        cause: io::Error,
    },

    /// V103 file too large. The file is longer than files of its kind may be: 64 MiB for a
    /// scenario, 256 MiB for a trace, 32 MiB for a network, 16 MiB for a table of demand; the
    /// message states the limit.
    ///
    /// Fix: check that it is the right file. Describe fewer or longer demand periods.
    #[error("{origin}: the file is longer than {limit} bytes")]
    FileTooLarge {
        /// The path.
        origin: String,
        /// The greatest length that is read, bytes.
        limit: u64,
    },

    /// V104 number out of range. A number is negative, not finite, not whole where it counts
    /// something, or outside the bounds that the message states.
    ///
    /// Fix: correct the member that the message names. The bounds are listed with [the scenario
    /// file](files.md#the-scenario-file).
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

    /// V105 not JSON or TOML. The text is not JSON (a scenario) or TOML (a network).
    ///
    /// Fix: look at the line and column in the message; often a comma or a quote is missing just
    /// before.
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

    /// V106 unknown, missing or wrong member. A member is unknown, missing, given twice, or of
    /// another kind than its format asks for: a text for a number, a time that is not `HH:MM:SS`.
    ///
    /// Fix: compare the member that the message names with [the format](files.md).
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

    /// V107 unknown format. The file names another format or version than this program reads, or
    /// names none. Then it is probably a file of another kind, such as a settings file of another
    /// program in a folder of days.
    ///
    /// Fix: give the right file, or write it again with this version of the program.
    #[error("{origin}: format must be {expected:?}, found {found:?}")]
    UnknownFormat {
        /// The file.
        origin: String,
        /// The format that this program reads.
        expected: &'static str,
        /// The format that the file states.
        found: String,
    },

    /// The file does not say which format it has, so it is probably something else. Fix: give
    /// the right file.
    #[error("{origin}: has no member `format`, which would be {expected:?}")]
    NoFormat {
        /// The file.
        origin: String,
        /// The format that this program reads.
        expected: &'static str,
    },

    /// V108 empty or endless list. A list is empty or has more entries than the program takes, or
    /// an entry of `[[closures]]` names neither routes nor vertiports. The message says how many
    /// entries the list may have. A closed vertiport counts as a route to every other vertiport.
    ///
    /// Fix: add or remove entries.
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

    /// V109 wrong shape. A table does not have one row and one column for each vertiport, or a list
    /// does not have one entry for each demand period.
    ///
    /// Fix: add or remove entries in the member that the message names.
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

    /// V110 duplicate id. Two entries of one list have the same id.
    ///
    /// Fix: rename one of them.
    #[error("{origin}: {member} has the same id as an entry before it")]
    DuplicateId {
        /// The file.
        origin: String,
        /// The second of the two entries.
        member: String,
    },

    /// V111 unknown id. A member refers to an entry that does not exist. Ids are compared letter by
    /// letter, and upper and lower case differ.
    ///
    /// Fix: correct the id, or add the entry.
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

    /// V112 bad id. An id or name is empty, too long, or has characters that cannot be printed or
    /// used in a file's name.
    ///
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

    /// V113 more aircraft than stands at a vertiport. More aircraft start the day at a vertiport
    /// than it has stands.
    ///
    /// Fix: move aircraft elsewhere, or add stands.
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

    /// V114 start after end. Operations, a closure or an outage start after they end.
    ///
    /// Fix: exchange the two. An end after midnight is written like `25:30:00`. A night curfew that
    /// affects both the morning and the evening of the day is written as two closures, one until
    /// the morning and one from the evening on.
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

    /// V115 demand periods out of order. A demand period starts no later than the one before it, or
    /// the first one starts after operations do.
    ///
    /// Fix: list the periods in the order of the day, the first no later than the start of
    /// operations.
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

    /// V116 demand from a vertiport to itself. Passengers want to fly from a vertiport to itself.
    ///
    /// Fix: set the diagonal of the demand tables to 0.
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

    /// V117 fleet larger than all stands. A network has more aircraft than all its stands together,
    /// so that no day of it can be drawn.
    ///
    /// Fix: add stands or vertiports, or remove aircraft; `network import` takes fewer than its
    /// base has with `--aircraft`.
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

    /// V118 seed out of range. A seed, or the number of a training or validation day, is outside
    /// [the range](../concepts/training.md#seeds) that keeps the days of different purposes apart.
    /// `--seed` of `scenario` and `compare` goes up to 2^40 - 1, counting all days asked for; that
    /// of `train` up to 2^24 - 1.
    ///
    /// Fix: choose a smaller seed.
    #[error("{member} must be a whole number below {limit}, found {found}")]
    SeedOutOfRange {
        /// The name of the number, with its file if it has one.
        member: String,
        /// The first number that is too large.
        limit: u64,
        /// The number.
        found: String,
    },

    /// V121 not exactly one of several members. A file must have exactly one of several members,
    /// but has two or none of them: for example a vertiport's position in miles and by latitude and
    /// longitude, or two demand models.
    ///
    /// Fix: keep the member that is meant. The positions of all vertiports of a network are given
    /// in the same way.
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

    /// V122 route from a vertiport to itself. A corridor or a closure has the same vertiport at
    /// both ends.
    ///
    /// Fix: name two different vertiports.
    #[error("{origin}: {member} leads from {vertiport:?} to itself")]
    RouteToItself {
        /// The file.
        origin: String,
        /// The route.
        member: String,
        /// The vertiport.
        vertiport: String,
    },

    /// V123 change of a member that is not there. A change of a network names a member by a path
    /// that does not exist.
    ///
    /// Fix: name members as in the network file, with dots between them. Name the entries of a list
    /// by their `id`, by their position from 0, or by `*` for all of them: `vertiports.V3.stands`,
    /// `fleet.0.count`.
    #[error("{path:?} leads nowhere: there is no {part:?}")]
    NoSuchMember {
        /// The path.
        path: String,
        /// The first part of the path that does not exist.
        part: String,
    },

    /// V130 network for a scenario, or the other way round. A network file is given where a
    /// scenario is expected, or a scenario, or other JSON, where a network is expected. A network
    /// is what days are drawn from, and is TOML; a scenario is one day, and is JSON.
    ///
    /// Fix: draw a scenario from the network: `vertifleet scenario FILE --seed 1 --output
    /// DAY.json`. The commands `scenario`, `compare` and `train` take networks; `simulate`,
    /// `check`, `bound` and `plan` take scenarios.
    #[error("{origin}: this is {found}, and {expected} is expected")]
    WrongKind {
        /// The file.
        origin: String,
        /// The kind of the file.
        found: &'static str,
        /// The kind that is expected.
        expected: FileKind,
    },

    /// V131 wrong row in a table of demand. A row of a [table of demand](files.md#demand-models)
    /// does not fit its columns, or the first line does not have the names of the columns.
    ///
    /// Fix: correct the line that the message names. Columns are separated by commas, and numbers
    /// have a decimal point and no thousands separator. Some spreadsheets write semicolons and
    /// decimal commas unless they are told otherwise.
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

    /// V132 table of demand without a folder. A network names a table of demand beside its file,
    /// but the network is given as a text, which is not in any folder.
    ///
    /// Fix: read the network from its file, or put the rows of the table into it as `pairs`.
    #[error(
        "{origin}: hourly_demand: table {table:?} is to be read from the folder of the network file, and there is none"
    )]
    TableWithoutFolder {
        /// The network.
        origin: String,
        /// The table's path.
        table: String,
    },

    /// V133 pair given twice. The demand, the tariff or the elasticity of a pair stands twice in
    /// its list, or the demand of a pair and period twice in the table.
    ///
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

    /// V134 setting that does not fit its distribution. `noise` belongs to the distribution
    /// `normal`, and `dispersion` to `negative-binomial`. Each is needed with its own distribution
    /// and refused with the others.
    ///
    /// Fix: add or remove the setting, or name the other [distribution](files.md#distributions).
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

    /// V119 unknown network. A name is neither a shipped network, nor `random:` with a number, nor
    /// a file.
    ///
    /// Fix: give one of the names that the message lists, `random:` and a number, as `random:7`, or
    /// the path of a network file.
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

/// A kind of file that a command may expect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileKind {
    /// One day, as JSON.
    Scenario,
    /// A network, as TOML.
    Network,
}

impl fmt::Display for FileKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Scenario => "a scenario (JSON)",
            Self::Network => "a network (TOML)",
        })
    }
}
