//! Expected errors of an import: causes in the planner's files or settings, and remedies.

use vertifleet_core::{Code, Coded, Error as CoreError, Exit, FormatError, Stopped};

/// An expected error of this crate. Messages are fragments for users; [`Error::code`] is for
/// programs and the error index.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file that cannot be read or is too long, or a network that breaks a rule of its format
    /// (V1xx), as reported by `vertifleet-core`.
    #[error(transparent)]
    Core(#[from] CoreError),

    /// V701 not the promised kind of file. A file is not of the kind that its name or its first
    /// bytes promise, or it is damaged. Or its text is not UTF-8: some spreadsheets save "Unicode
    /// text" in UTF-16, and CSV in Windows-1252. Or a row has more values than the header has
    /// columns, as where a decimal comma is not in quotes. Or a map is in another reference system
    /// than longitude and latitude. The message names the formats of other programs, such as TNTP,
    /// OMX, FlatGeobuf, Feather, TopoJSON, newline-delimited GeoJSON, GBFS and JSON lines.
    ///
    /// Fix: look at the place in the message; write the file again as CSV, GeoJSON or Parquet, its
    /// text in UTF-8.
    #[error("{origin}: cannot be read as {kind}: {problem}")]
    NotParsed {
        /// The file.
        origin: String,
        /// The expected kind of file.
        kind: &'static str,
        /// The parser's message.
        problem: String,
    },

    /// V702 missing column. A table has no column, or a map no property, of a name that is needed,
    /// or none of several of which one is needed. Often its columns are separated by semicolons or
    /// tabs, which are then read as one column; the hint states it.
    ///
    /// Fix: rename the column; columns of trip records can be named with `--trip-columns`. Save a
    /// file with other separators with commas between its columns, and with decimal points.
    #[error("{origin}: has no {what} {column}; it has {found}")]
    MissingColumn {
        /// The file.
        origin: String,
        /// "column" or "property".
        what: &'static str,
        /// The column that is needed, or the choices.
        column: String,
        /// The columns that are there.
        found: String,
        /// The column that the user probably meant, or another remedy.
        hint: Option<String>,
    },

    /// V703 unusable value. A value is missing, no number or time where one is needed, or outside
    /// the bounds that the message states.
    ///
    /// Fix: correct the line, feature or row that the message names.
    #[error("{origin}: {place}: {member} must be {rule}, found {found:?}")]
    WrongValue {
        /// The file.
        origin: String,
        /// The line, feature or row.
        place: String,
        /// The column or property.
        member: &'static str,
        /// The rule that the value breaks.
        rule: String,
        /// The value, cut short if it is long.
        found: String,
    },

    /// V704 given twice in data of your own. A file gives the same vertiport, zone, corridor, pair,
    /// period, column or property twice.
    ///
    /// Fix: remove one of the two, or rename it. If a column that is not read splits the table, as
    /// the hint may state, keep the rows of one of its values.
    #[error("{origin}: {place}: {what} is given before, in {before}")]
    GivenTwice {
        /// The file.
        origin: String,
        /// The second line, feature or row.
        place: String,
        /// The thing that is given twice.
        what: String,
        /// The first line, feature or row.
        before: String,
        /// The columns in which the two may differ.
        hint: Option<String>,
    },

    /// V705 unknown vertiport in data of your own. A row or feature names a vertiport that the file
    /// of vertiports does not have.
    ///
    /// Fix: correct the id, or add the vertiport.
    #[error("{origin}: {place}: {member} names {found:?}, which is not among the vertiports")]
    UnknownVertiport {
        /// The file.
        origin: String,
        /// The line, feature or row.
        place: String,
        /// The column or property.
        member: &'static str,
        /// The id that is not known.
        found: String,
        /// The id that the user probably meant.
        meant: Option<String>,
    },

    /// V706 wrong geometry. A feature has another geometry than it needs: vertiports are points,
    /// corridors are lines, zones are areas or points.
    ///
    /// Fix: export the right layer, in longitude and latitude (WGS 84).
    #[error("{origin}: {place}: the geometry must be {expected}, found {found}")]
    WrongGeometry {
        /// The file.
        origin: String,
        /// The feature.
        place: String,
        /// The geometry that is needed.
        expected: &'static str,
        /// The geometry that is there.
        found: String,
    },

    /// V707 corridor that does not begin at its vertiport. The line of a corridor does not begin or
    /// end at the vertiport that it names. A distance of thousands of miles means that its
    /// latitudes and longitudes are exchanged.
    ///
    /// Fix: draw the line from the vertiport `from` to the vertiport `to`, or exchange the two ids.
    /// In GeoJSON a position is the longitude and then the latitude.
    #[error(
        "{origin}: {place}: the line must {end} within {limit_mi} mile of vertiport {vertiport:?}, found {found_mi:.1} miles"
    )]
    CorridorEnd {
        /// The file.
        origin: String,
        /// The feature.
        place: String,
        /// "begin" or "end".
        end: &'static str,
        /// The vertiport.
        vertiport: String,
        /// The greatest distance, miles.
        limit_mi: f64,
        /// The distance, miles.
        found_mi: f64,
        /// Whether the line is where it must be if latitude and longitude are exchanged.
        exchanged: bool,
    },

    /// V708 file without rows. A file has no row or feature, or nothing at all.
    ///
    /// Fix: check that it is the right file, and that its export is complete.
    #[error("{origin}: has no {what}")]
    Nothing {
        /// The file.
        origin: String,
        /// The rows that it should list.
        what: &'static str,
    },

    /// V709 line that is too long. A line of a file of trips is longer than any row of a table.
    ///
    /// Fix: check that it is a CSV file with one row in each line.
    #[error("{origin}: the line that begins at byte {begin} is longer than {limit} bytes")]
    LineTooLong {
        /// The file.
        origin: String,
        /// Position of the line's first byte.
        begin: u64,
        /// The greatest length of a line.
        limit: usize,
    },

    /// V710 no trip became demand. No trip record became demand, so there would be no passengers.
    ///
    /// Fix: look at the reasons in the message; often the radius is too small, zones have other
    /// ids, or latitude and longitude are exchanged.
    #[error("no trip became demand: {account}")]
    NoTrips {
        /// Number of rows, and of rows that were dropped by reason.
        account: String,
    },

    /// V711 unusable type of a Parquet column. A column of a Parquet file has a type from which the
    /// values cannot be taken.
    ///
    /// Fix: write the column with the type that the message names.
    #[error("{origin}: column {column:?} must have {expected}, found {found}")]
    ColumnType {
        /// The file.
        origin: String,
        /// The column.
        column: String,
        /// The types that can be read.
        expected: &'static str,
        /// The type that it has.
        found: String,
    },

    /// V712 setting of an import out of bounds. A setting of the import is outside its bounds.
    ///
    /// Fix: choose a value within them.
    #[error("{setting} must be {rule}, found {found}")]
    Setting {
        /// The setting.
        setting: &'static str,
        /// The rule that it breaks.
        rule: &'static str,
        /// The value.
        found: String,
    },

    /// V713 zones without a file of zones. Trip records name zones, and no file has the places of
    /// the zones.
    ///
    /// Fix: give a file of zones, as CSV with `zone,latitude,longitude` or as GeoJSON.
    #[error("{origin}: its trips name zones, and no file of zones is given")]
    NoZones {
        /// The file.
        origin: String,
    },

    /// V714 demand period without a price. A demand period begins before the first price of a
    /// table. A price holds from its time until the next one.
    ///
    /// Fix: give a price that begins no later than the period that the message names.
    #[error("{origin}: {problem}")]
    PricePeriods {
        /// The file.
        origin: String,
        /// The period and the problem with it.
        problem: String,
    },

    /// V715 from a vertiport to itself. A row or feature leads from a vertiport to itself.
    ///
    /// Fix: name two vertiports.
    #[error("{origin}: {place}: leads from {vertiport:?} to itself")]
    SameVertiport {
        /// The file.
        origin: String,
        /// The line, feature or row.
        place: String,
        /// The vertiport.
        vertiport: String,
    },

    /// V716 more than a network takes. A file lists more than a network takes.
    ///
    /// Fix: import a smaller region, or fewer demand periods.
    #[error("{origin}: {what} must be at most {most}, found {found}")]
    TooMany {
        /// The file.
        origin: String,
        /// The thing that is counted.
        what: &'static str,
        /// The most of them.
        most: usize,
        /// The number of them.
        found: usize,
    },

    /// V717 import stopped. The import was asked to stop before it was done.
    ///
    /// Fix: start it again; nothing was written.
    #[error("{Stopped}")]
    Stopped,
}

impl From<Stopped> for Error {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

impl Coded for Error {
    fn code(&self) -> Code {
        Code(match self {
            Self::Core(error) => return error.code(),
            Self::NotParsed { .. } => 701,
            Self::MissingColumn { .. } => 702,
            Self::WrongValue { .. } => 703,
            Self::GivenTwice { .. } => 704,
            Self::UnknownVertiport { .. } => 705,
            Self::WrongGeometry { .. } => 706,
            Self::CorridorEnd { .. } => 707,
            Self::Nothing { .. } => 708,
            Self::LineTooLong { .. } => 709,
            Self::NoTrips { .. } => 710,
            Self::ColumnType { .. } => 711,
            Self::Setting { .. } => 712,
            Self::NoZones { .. } => 713,
            Self::PricePeriods { .. } => 714,
            Self::SameVertiport { .. } => 715,
            Self::TooMany { .. } => 716,
            Self::Stopped => 717,
        })
    }

    fn hint(&self) -> Option<&str> {
        match self {
            Self::Core(CoreError::InFile { error: FormatError::FleetTooLarge { .. }, .. }) => Some(
                "an aircraft needs a stand wherever it is, also on its way there: ask for fewer with --aircraft, or give the vertiports more stands",
            ),
            Self::Core(error) => error.hint(),
            Self::MissingColumn { hint, .. }
            | Self::GivenTwice { hint, .. }
            | Self::UnknownVertiport { meant: hint, .. } => hint.as_deref(),
            Self::Setting { setting: "mode_share", .. } => Some("a share of 5 % is 0.05"),
            Self::CorridorEnd { exchanged: true, .. } => {
                Some("latitude and longitude are exchanged: in GeoJSON the longitude comes first")
            }
            Self::WrongValue { member: "latitude" | "longitude", .. } => Some(
                "positions are degrees (WGS 84), latitude and longitude each in its column, and not metres of a map",
            ),
            Self::CorridorEnd { .. } => Some("a line is drawn from its `from` to its `to`"),
            Self::WrongGeometry { .. } => {
                Some("coordinates are longitude and latitude in degrees (WGS 84), in this order")
            }
            _ => None,
        }
    }

    fn exit(&self) -> Exit {
        match self {
            Self::Core(error) => error.exit(),
            Self::Stopped => Exit::Failed,
            _ => Exit::Input,
        }
    }
}

/// The first `most` characters, at most, of a text from outside, for messages.
pub(crate) fn shortened(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

/// A hint that names the probably intended one.
pub(crate) fn did_you_mean<'a>(
    found: &str,
    names: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    vertifleet_core::nearest(&shortened(found, 64), names)
        .map(|name| format!("did you mean {}?", shortened(name, 64)))
}
