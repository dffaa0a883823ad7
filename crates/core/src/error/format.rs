//! The rules of formats that a file may break. An error here names member, value and rule; the file
//! is added where it is known, by [`FormatError::in_file`].

use std::fmt;

use super::Error;
use crate::limits::SEED_LIMIT;

/// A rule of its format that a file, or another text, breaks.
#[derive(Debug, thiserror::Error)]
pub enum FormatError {
    /// V103 file too large. The file is longer than files of its kind may be: 64 MiB for a
    /// scenario, 256 MiB for a trace, 32 MiB for a network, 16 MiB for a table of demand; the
    /// message states the limit.
    ///
    /// Fix: check that it is the right file. Describe fewer or longer demand periods.
    #[error("the file is longer than {limit} bytes")]
    FileTooLarge {
        /// The greatest length that is read, bytes.
        limit: u64,
    },

    /// V104 number out of range. A number is negative, not finite, not whole where it counts
    /// something, or outside the bounds that the message states.
    ///
    /// Fix: correct the member that the message names. The bounds are listed with [the scenario
    /// file](files.md#the-scenario-file).
    #[error("{member} must be {rule}, found {found}")]
    OutOfRange {
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
    #[error("line {line}, column {column}: {problem}")]
    NotParsed {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// The parser's message.
        problem: String,
    },

    /// V106 unknown, missing or wrong member. A member is unknown, missing, given twice, or of
    /// another kind than its format asks for: a text for a number, a time that is not `HH:MM:SS`, a
    /// list of three numbers where two are read.
    ///
    /// Fix: compare the member that the message names with [the format](files.md).
    #[error("line {line}, column {column}: {member}{problem}")]
    WrongMember {
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
    #[error("format must be {expected:?}, found {found:?}")]
    UnknownFormat {
        /// The format that this program reads.
        expected: &'static str,
        /// The format that the file states.
        found: String,
    },

    /// The file does not name its format, so it is probably something else. Fix: give the right
    /// file.
    #[error("has no member `format`, which would be {expected:?}")]
    NoFormat {
        /// The format that this program reads.
        expected: &'static str,
    },

    /// V108 empty or endless list. A list is empty or has more entries than the program takes, or
    /// an entry of `[[closures]]` names neither routes nor vertiports. The message states how many
    /// entries the list may have. A closed vertiport counts as a route to every other vertiport.
    ///
    /// Fix: add or remove entries.
    #[error("{member} must have 1 to {most} entries, found {found}")]
    EntryCount {
        /// The list.
        member: String,
        /// The most entries that it may have.
        most: usize,
        /// The number of entries that it has.
        found: usize,
    },

    /// The fleet has no aircraft. Fix: count one at least.
    #[error("the fleet has no aircraft: a network has one at least")]
    NoAircraft,

    /// V109 wrong shape. A table does not have one row and one column for each vertiport, or a list
    /// does not have one entry for each demand period.
    ///
    /// Fix: add or remove entries in the member that the message names.
    #[error("{member} must have {expected}, found {found}")]
    WrongShape {
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
    #[error("{member} has the same id as an entry before it")]
    DuplicateId {
        /// The second of the two entries.
        member: String,
    },

    /// V111 unknown id. A member refers to an entry that does not exist. Ids are compared letter by
    /// letter, and upper and lower case differ.
    ///
    /// Fix: correct the id, or add the entry.
    #[error("{member} names {found:?}, which is not among the {list}")]
    UnknownId {
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
    #[error("{member} must be {rule}, found {found:?}")]
    BadId {
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
    #[error("vertiport {vertiport:?} has stands for {stands} aircraft, and {aircraft} start there")]
    StandsExceeded {
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
    #[error("{member}: start must not be after end {end}, found {start}")]
    StartAfterEnd {
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
    #[error("{member} must be {rule}, found {found}")]
    PeriodOrder {
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
    #[error("{member} must be 0, found {found}: no flight goes from a vertiport to itself")]
    SelfDemand {
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
    #[error("the fleet has {aircraft} aircraft, and the vertiports have {stands} stands together")]
    FleetTooLarge {
        /// Aircraft in the fleet.
        aircraft: usize,
        /// Stands of all vertiports.
        stands: usize,
    },

    /// V121 not exactly one of several members. A file must have exactly one of several members,
    /// but has two or none of them: for example a vertiport's position in miles and by latitude and
    /// longitude, or two demand models.
    ///
    /// Fix: keep the intended member. The positions of all vertiports of a network are given in the
    /// same way.
    #[error("{member} must have {choices}, found {found}")]
    NotOneOf {
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
    #[error("{member} leads from {vertiport:?} to itself")]
    RouteToItself {
        /// The route.
        member: String,
        /// The vertiport.
        vertiport: String,
    },

    /// V130 network for a scenario, or the other way round. A network file is given where a
    /// scenario is expected, or a scenario, or other JSON, where a network is expected. A network
    /// is what days are drawn from, and is TOML; a scenario is one day, and is JSON.
    ///
    /// Fix: draw a scenario from the network: `vertifleet scenario FILE --seed 1 --output
    /// DAY.json`. The commands `scenario`, `compare` and `train` take networks; `simulate`,
    /// `check`, `bound` and `plan` take scenarios.
    #[error("this is {found}, and {expected} is expected")]
    WrongKind {
        /// The kind of the file.
        found: &'static str,
        /// The kind that is expected.
        expected: FileKind,
    },

    /// V131 wrong row in a table of demand. A row of a [table of demand](files.md#demand-models)
    /// does not fit its columns, or the first line does not have the names of the columns.
    ///
    /// Fix: correct the line that the message names. Columns are separated by commas, and numbers
    /// have a decimal point and no thousands separator. By default, some spreadsheets write
    /// semicolons and decimal commas.
    #[error("line {line}: {column} must be {rule}, found {found:?}")]
    TableRow {
        /// The row's line, from 1.
        line: usize,
        /// The column, or the row or header as a whole.
        column: &'static str,
        /// The rule that it breaks.
        rule: String,
        /// The text found, cut short if it is long.
        found: String,
    },

    /// V132 table of demand without a folder. A network names a table of demand in the folder of
    /// its file, but the network is given as a text, which is not in any folder.
    ///
    /// Fix: read the network from its file, or put the rows of the table into it as `pairs`.
    #[error(
        "hourly_demand: table {table:?} is to be read from the folder of the network file, and there is none"
    )]
    TableWithoutFolder {
        /// The table's path.
        table: String,
    },

    /// V133 pair given twice. A list has the demand, the tariff or the elasticity of a pair twice,
    /// or a table has the demand of a pair and period twice.
    ///
    /// Fix: remove one of the two.
    #[error("{member} gives {what} again")]
    GivenTwice {
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
    #[error("{member} {rule} with the distribution {distribution:?}")]
    UnfitSetting {
        /// The setting.
        member: String,
        /// The rule that it breaks.
        rule: &'static str,
        /// The distribution.
        distribution: &'static str,
    },

    /// The seed of a scenario file is not a whole number below 2^53. Fix: choose a smaller seed.
    #[error("seed must be a whole number below {SEED_LIMIT}, found {found}")]
    SeedOutOfRange {
        /// The number.
        found: String,
    },
}

impl FormatError {
    /// The error of the file, or other source of the text, that `origin` names.
    pub fn in_file(self, origin: &str) -> Error {
        Error::InFile { origin: origin.to_owned(), error: self }
    }

    /// Whether only the size of the fleet is refused: it has no aircraft, or more than there are
    /// stands.
    pub fn is_fleet_size(&self) -> bool {
        matches!(self, Self::NoAircraft | Self::FleetTooLarge { .. })
    }
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
