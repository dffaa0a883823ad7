//! The arguments of sweeps, searches for a design, explanations and exports.

use std::path::PathBuf;

use clap::builder::{PathBufValueParser, TypedValueParser as _};
use clap::{Args, ValueEnum};
use vertifleet_core::{Purpose, Scenario};
use vertifleet_picture::{PlayedPicture, schedule};
use vertifleet_sim::TraceRow;
use vertifleet_study::PolicySource;
use vertifleet_study::size::Goal;
use vertifleet_study::sweep::Factor;

use super::{FORCE, NETWORK, SPLIT, STEP};
use crate::typed::{
    parse_count, parse_factor, parse_goal, parse_minutes, parse_model, parse_name, parse_seed,
    parse_split,
};

#[derive(Debug, Args)]
pub(crate) struct SweepArguments {
    #[arg(help = NETWORK)]
    pub(crate) network: String,
    /// A member of the network file and its values, as fleet.0.count=30..50/5 or
    /// tariffs.fare_level=0.8,1,1.2; may be given several times
    ///
    /// A range has a step. A value that begins with a bracket, a brace or a quote is JSON, as in
    /// closures=[],[{"start":"07:00:00","end":"09:00:00"}]. An entry of a list is named by its id
    /// (in the fleet by its type) or by its position from 0, and * names all entries:
    /// vertiports.*.stands. A name with a dot or an equals sign stands in double quotes:
    /// vertiports."St. John".stands.
    #[arg(long, value_name = "PATH=VALUES", required = true, value_parser = parse_factor)]
    pub(crate) vary: Vec<Factor>,
    /// Draw a Latin hypercube of this many cells in place of all combinations; ranges then need no
    /// step, and are of whole numbers if both ends are
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
    #[arg(long, help = SPLIT, default_value = "comparison", value_parser = parse_split)]
    pub(crate) split: Purpose,
    /// Weights for a policy of that name; may be given several times
    #[arg(long = "model", value_name = "NAME=PATH", value_parser = parse_model)]
    pub(crate) models: Vec<(String, PolicySource)>,
    /// Prove an upper bound on every day
    #[arg(long)]
    pub(crate) bound: bool,
    #[arg(long, help = STEP, value_name = "MIN", default_value_t = 5, requires = "bound", allow_hyphen_values = true, value_parser = parse_minutes)]
    pub(crate) step: u32,
    /// Folder of the sweep: finished cells, tables, figures and a report page
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
    #[arg(help = NETWORK)]
    pub(crate) network: String,
    /// Goal: profit; served=SHARE, zero-spill or least-spill
    ///
    /// profit looks for the design that earns most after the costs of aircraft, stands and chargers
    /// (tariffs.aircraft_cost_usd_per_day, tariffs.stand_cost_usd_per_day and
    /// tariffs.charger_cost_usd_per_day), so give them costs. served=0.9 looks for the cheapest
    /// design that carries 90 % of those who want to fly; zero-spill is served=1. A policy that
    /// maximises profit leaves passengers behind who cost more than they pay, so no design may
    /// reach it. least-spill looks for the design that leaves the fewest passengers behind; without
    /// --vary the fleet is the file's.
    #[arg(long, default_value = "profit", value_parser = parse_goal)]
    pub(crate) goal: Goal,
    /// Numbers to vary, as fleet.*.count=10..60 or vertiports.JFK.stands=4..12/2, or a setting of
    /// all designs, as tariffs.aircraft_cost_usd_per_day=900; may be given several times [default:
    /// all aircraft, stands and chargers, up to twice the file; for least-spill not the aircraft]
    ///
    /// * gives each entry of the list its own number; a later flag for one of them wins.
    #[arg(long, value_name = "PATH=VALUES", value_parser = parse_factor)]
    pub(crate) vary: Vec<Factor>,
    /// Policy that plays the days, as compare takes it
    #[arg(long, default_value = "gcaps-x", value_parser = parse_name)]
    pub(crate) policy: String,
    /// Number of days of each design; the best one is measured on as many further days
    #[arg(long, default_value_t = 20, allow_hyphen_values = true, value_parser = parse_count)]
    pub(crate) days: u32,
    /// Seed of the first day and of the random policy
    #[arg(long, default_value_t = 1, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: u64,
    #[arg(long, help = SPLIT, default_value = "comparison", value_parser = parse_split)]
    pub(crate) split: Purpose,
    /// Weights of a learned policy [default: the shipped ones of the network]
    #[arg(long, value_name = "PATH", value_parser = PathBufValueParser::new().map(PolicySource::File))]
    pub(crate) model: Option<PolicySource>,
    #[arg(long, help = STEP, value_name = "MIN", default_value_t = 60, allow_hyphen_values = true, value_parser = parse_minutes)]
    pub(crate) step: u32,
    /// Work of the search: as many simulated days as this number of designs has, 2 to 1000. The
    /// designs one step from the answer are compared besides
    #[arg(long, value_name = "NUMBER", default_value_t = 40)]
    pub(crate) designs: usize,
    /// Folder of the search: designs, a report page and the network file of the best one
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
    /// A row for each decision, for spreadsheets and databases
    Csv,
    /// The same as columns, for data frames
    Parquet,
    /// Flights as lines with times, and vertiports as points, for maps such as QGIS and kepler.gl
    Geojson,
    /// A feed of public transport with a trip for each flight; block_id is the aircraft
    Gtfs,
    /// A calendar for each vertiport with its departures and arrivals
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
    /// Format
    #[arg(long = "as", value_name = "FORMAT")]
    pub(crate) format: ExportFormat,
    /// File, or the folder for icalendar
    #[arg(short, long, value_name = "FILE|DIR")]
    pub(crate) output: PathBuf,
    /// Picture that svg and png draw
    #[arg(long, value_name = "NAME", default_value = "day")]
    pub(crate) picture: ExportPicture,
    /// Date of the day, needed for geojson, gtfs and icalendar
    #[arg(long, value_name = "YYYY-MM-DD")]
    pub(crate) date: Option<String>,
    /// Time zone of the day's clock, from the IANA database; 00:00:00 is twelve hours before noon,
    /// as in timetables, so that each hour is an hour also when clocks change
    #[arg(long, value_name = "ZONE", default_value = "UTC", requires = "date")]
    pub(crate) time_zone: String,
    #[arg(long, help = FORCE)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArguments {
    /// Scenario file
    pub(crate) scenario: PathBuf,
    /// Policy that plays the day, as simulate takes it; replay:TRACE explains a trace, and only the
    /// bound solves its changed days
    #[arg(long, default_value = "gcaps-x", value_parser = parse_name)]
    pub(crate) policy: String,
    /// Seed of the random policy
    #[arg(long, default_value_t = 0, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: u64,
    /// Weights of a learned policy [default: the shipped ones of the scenario's network]
    #[arg(long, value_name = "PATH", value_parser = PathBufValueParser::new().map(PolicySource::File))]
    pub(crate) model: Option<PolicySource>,
    #[arg(long, help = STEP, value_name = "MIN", default_value_t = 5, allow_hyphen_values = true, value_parser = parse_minutes)]
    pub(crate) step: u32,
    /// Write the page of the day, its bound and the value of changes to this HTML file
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Option<PathBuf>,
    #[arg(long, help = FORCE)]
    pub(crate) force: bool,
    /// Print the explanation as JSON
    #[arg(long)]
    pub(crate) json: bool,
}
