//! The arguments of what planners ask: sweeps, days explained, and days in the formats of other
//! programs.

use std::path::PathBuf;

use clap::builder::{PathBufValueParser, TypedValueParser as _};
use clap::{Args, ValueEnum};
use vertifleet_core::{Purpose, Scenario};
use vertifleet_picture::{PlayedPicture, schedule};
use vertifleet_sim::TraceRow;
use vertifleet_study::PolicySource;
use vertifleet_study::size::Goal;
use vertifleet_study::sweep::Factor;

use crate::typed::{
    parse_count, parse_factor, parse_goal, parse_minutes, parse_model, parse_name, parse_seed,
    parse_split,
};

#[derive(Debug, Args)]
pub(crate) struct SweepArguments {
    /// Network file, the name of a shipped network (paper, disrupted, new-york, large, as-coded,
    /// san-francisco, los-angeles, dallas, paris), random:NUMBER, or random-places:SIZE:NUMBER
    pub(crate) network: String,
    /// A member of the network file and its values, as fleet.0.count=30..50/5 or
    /// tariffs.fare_level=0.8,1,1.2; may be given several times
    #[arg(long, value_name = "PATH=VALUES", required = true, value_parser = parse_factor)]
    pub(crate) vary: Vec<Factor>,
    /// Draw a Latin hypercube of this many cells in place of all combinations; ranges then need no
    /// step
    #[arg(long, value_name = "CELLS")]
    pub(crate) latin: Option<usize>,
    /// Policies, separated by commas, as compare takes them; designs are judged by the first
    #[arg(long, value_delimiter = ',', default_value = "gcaps-x", value_parser = parse_name)]
    pub(crate) policies: Vec<String>,
    /// Number of days of each cell
    #[arg(long, default_value_t = 20, allow_hyphen_values = true, value_parser = parse_count)]
    pub(crate) days: u32,
    /// Seed of the first day, of the random policy and of the Latin hypercube
    #[arg(long, default_value_t = 1, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: u64,
    /// Whose days: comparison, validation or training; with the latter two, the seed is the number
    /// of the first day
    #[arg(long, default_value = "comparison", value_parser = parse_split)]
    pub(crate) split: Purpose,
    /// Weights for a policy name; may be given several times
    #[arg(long = "model", value_name = "NAME=PATH", value_parser = parse_model)]
    pub(crate) models: Vec<(String, PolicySource)>,
    /// Prove an upper bound of every day
    #[arg(long)]
    pub(crate) bound: bool,
    /// Longest price interval of the bounds, minutes, 1 to 60; shorter is never looser and takes
    /// longer
    #[arg(long, value_name = "MIN", default_value_t = 5, requires = "bound", allow_hyphen_values = true, value_parser = parse_minutes)]
    pub(crate) step: u32,
    /// Folder of the sweep: finished cells, tables, figures and a report page; a sweep that ended
    /// early goes on in it
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Print the results as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Replace another sweep in the folder
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct SizeArguments {
    /// Network file, the name of a shipped network (paper, disrupted, new-york, large, as-coded,
    /// san-francisco, los-angeles, dallas, paris), random:NUMBER, or random-places:SIZE:NUMBER
    pub(crate) network: String,
    /// profit; served=0.95 or another share of those who want to fly, with the least cost;
    /// zero-spill, which is served=1; or least-spill
    #[arg(long, default_value = "profit", value_parser = parse_goal)]
    pub(crate) goal: Goal,
    /// What may vary, as fleet.*.count=10..60, vertiports.JFK.stands=4..12/2, or a setting of all
    /// designs, as tariffs.aircraft_cost_usd_per_day=900; may be given several times [default: all
    /// aircraft, stands and chargers, up to twice the file; for least-spill not the aircraft]
    #[arg(long, value_name = "PATH=VALUES", value_parser = parse_factor)]
    pub(crate) vary: Vec<Factor>,
    /// The policy that plays the days, as compare takes it
    #[arg(long, default_value = "gcaps-x", value_parser = parse_name)]
    pub(crate) policy: String,
    /// Number of days of each design; as many that follow them tell how good the best one is
    #[arg(long, default_value_t = 20, allow_hyphen_values = true, value_parser = parse_count)]
    pub(crate) days: u32,
    /// Seed of the first day and of the random policy
    #[arg(long, default_value_t = 1, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: u64,
    /// Whose days: comparison, validation or training; with the latter two, the seed is the number
    /// of the first day
    #[arg(long, default_value = "comparison", value_parser = parse_split)]
    pub(crate) split: Purpose,
    /// Weights of a learned policy [default: the shipped ones of the network]
    #[arg(long, value_name = "PATH", value_parser = PathBufValueParser::new().map(PolicySource::File))]
    pub(crate) model: Option<PolicySource>,
    /// Longest price interval of the bounds, minutes, 1 to 60; shorter gives a tighter certificate
    /// and takes longer
    #[arg(long, value_name = "MIN", default_value_t = 60, allow_hyphen_values = true, value_parser = parse_minutes)]
    pub(crate) step: u32,
    /// The most designs to play
    #[arg(long, value_name = "NUMBER", default_value_t = 40)]
    pub(crate) designs: usize,
    /// Folder of the search: designs, a report page and the network file of the best one; a search
    /// that ended early goes on in it
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Print the results as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Replace another search in the folder
    #[arg(long)]
    pub(crate) force: bool,
}

/// The formats of other programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExportFormat {
    /// A row for each decision, for spreadsheets
    Csv,
    /// The same as columns, for data frames
    Parquet,
    /// Flights as lines with times, for maps
    Geojson,
    /// A feed for tools of public transport
    Gtfs,
    /// A calendar for each vertiport
    Icalendar,
    /// A picture of the day
    Svg,
    /// The same as pixels
    Png,
}

/// The pictures of a played day.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExportPicture {
    /// Map, aircraft, occupancy and demand on one sheet
    Day,
    /// Where passengers flew
    Map,
    /// What every aircraft did
    Aircraft,
    /// The stands taken at every vertiport, against its capacity
    Occupancy,
    /// Demand served and spilled
    Demand,
    /// How revenue becomes profit
    Ledger,
}

impl ExportPicture {
    /// The picture as SVG.
    pub(crate) fn draw(self, day: &Scenario, rows: &[TraceRow]) -> String {
        match self {
            Self::Day => schedule(day, rows),
            Self::Map => PlayedPicture::Map.draw(day, rows),
            Self::Aircraft => PlayedPicture::Aircraft.draw(day, rows),
            Self::Occupancy => PlayedPicture::Occupancy.draw(day, rows),
            Self::Demand => PlayedPicture::Demand.draw(day, rows),
            Self::Ledger => PlayedPicture::Ledger.draw(day, rows),
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct ExportArguments {
    /// Scenario file
    pub(crate) scenario: PathBuf,
    /// Trace of the day, as simulate --trace or plan writes it
    pub(crate) trace: PathBuf,
    /// The format
    #[arg(long = "as", value_name = "FORMAT")]
    pub(crate) format: ExportFormat,
    /// The file; for icalendar the folder
    #[arg(short, long, value_name = "FILE|DIR")]
    pub(crate) output: PathBuf,
    /// The picture that svg and png draw
    #[arg(long, value_name = "NAME", default_value = "day")]
    pub(crate) picture: ExportPicture,
    /// The date of the day; geojson, gtfs and icalendar need it
    #[arg(long, value_name = "YYYY-MM-DD")]
    pub(crate) date: Option<String>,
    /// The time zone of the day's clock, by its name in the IANA database
    #[arg(long, value_name = "ZONE", default_value = "UTC", requires = "date")]
    pub(crate) time_zone: String,
    /// Replace a file that this program did not write or that is read-only; never what the command
    /// reads
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArguments {
    /// Scenario file
    pub(crate) scenario: PathBuf,
    /// The policy that plays the day, as simulate takes it; replay:TRACE explains a trace
    #[arg(long, default_value = "gcaps-x", value_parser = parse_name)]
    pub(crate) policy: String,
    /// Seed of the random policy
    #[arg(long, default_value_t = 0, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: u64,
    /// Weights of a learned policy [default: the shipped ones of the scenario's network]
    #[arg(long, value_name = "PATH", value_parser = PathBufValueParser::new().map(PolicySource::File))]
    pub(crate) model: Option<PolicySource>,
    /// Longest price interval of the bounds, minutes, 1 to 60; shorter is never looser and takes
    /// longer
    #[arg(long, value_name = "MIN", default_value_t = 5, allow_hyphen_values = true, value_parser = parse_minutes)]
    pub(crate) step: u32,
    /// Write the page of the day with its bound and what changes are worth to this HTML file
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Option<PathBuf>,
    /// Replace a file that this program did not write or that is read-only; never what the command
    /// reads
    #[arg(long)]
    pub(crate) force: bool,
    /// Print the explanation as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
