//! The arguments of `vertifleet network`.

use std::path::PathBuf;

use clap::{ArgGroup, Args, Subcommand};
use vertifleet_import::{Date, NewVertiport, TimeFormat, TripValue, Weekdays};

use crate::typed::{parse_known, parse_pair, parse_vertiport};

#[derive(Debug, Subcommand)]
pub(crate) enum NetworkAction {
    /// Make a network file from data of your own: vertiports, demand or trip records, corridors,
    /// fares
    Import(Box<ImportArguments>),
    /// Say everything that is wrong with network files
    Check {
        /// Network files
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Print the findings as JSON
        #[arg(long)]
        json: bool,
    },
    /// Show what a network holds
    Show {
        /// Network file, the name of a shipped network (paper, disrupted, new-york, large,
        /// as-coded, san-francisco, los-angeles, dallas, paris), random:NUMBER, or
        /// random-places:SIZE:NUMBER
        network: String,
        /// Draw a map and the demand by hour; the ending of the file says whether as SVG or PNG
        #[arg(long, value_name = "FILE")]
        picture: Option<PathBuf>,
        /// Replace a file that this program did not write or that is read-only; never what the
        /// command reads
        #[arg(long)]
        force: bool,
        /// Print the network as JSON, with the mean demand of every pair and period
        #[arg(long)]
        json: bool,
    },
    /// Write a network file to start from
    New(NewArguments),
    /// Say what two networks have differently, as the paths that sweep --vary takes
    Diff {
        /// Network file or name
        one: String,
        /// Network file or name
        other: String,
        /// Print the differences as JSON
        #[arg(long)]
        json: bool,
    },
}

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("source").required(true).args(["demand", "trips"]))]
pub(crate) struct ImportArguments {
    /// Vertiports: CSV with id,latitude,longitude and perhaps stands,chargers,busy; or GeoJSON
    /// points
    #[arg(long, value_name = "FILE")]
    pub(crate) vertiports: PathBuf,
    /// Mean passengers: CSV or Parquet with period,from,to,passengers
    #[arg(long, value_name = "FILE")]
    pub(crate) demand: Option<PathBuf>,
    /// Trip records, CSV or Parquet, with times and places; zones need --zones
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub(crate) trips: Vec<PathBuf>,
    /// Columns of the trip records that have names of their own, as
    /// pickup_time=began,passengers=riders
    #[arg(long, value_name = "VALUE=COLUMN", value_delimiter = ',', value_parser = parse_trip_column)]
    pub(crate) trip_columns: Vec<(TripValue, String)>,
    /// Where the zones of the trip records are: CSV with zone,latitude,longitude, or GeoJSON
    #[arg(long, value_name = "FILE")]
    pub(crate) zones: Option<PathBuf>,
    /// Greatest distance between a place and its vertiport, miles [default: 1]
    #[arg(long, value_name = "MILES", allow_hyphen_values = true)]
    pub(crate) radius: Option<f64>,
    /// Share of the trips near vertiports that would fly [default: 0.01]
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    pub(crate) mode_share: Option<f64>,
    /// Distance to and from vertiports over which that share falls to 1/e, miles [default: it does
    /// not fall]
    #[arg(long, value_name = "MILES", allow_hyphen_values = true)]
    pub(crate) decay: Option<f64>,
    /// Days of the week that count, as Mon,Tue,Wed [default: all]
    #[arg(long, value_name = "DAYS", value_parser = parse_known::<Weekdays>)]
    pub(crate) weekdays: Option<Weekdays>,
    /// First date that counts, as 2015-06-01
    #[arg(long, value_name = "DATE", value_parser = parse_known::<Date>)]
    pub(crate) first_date: Option<Date>,
    /// Last date that counts
    #[arg(long, value_name = "DATE", value_parser = parse_known::<Date>)]
    pub(crate) last_date: Option<Date>,
    /// How the times of trip records are written, as '%d/%m/%Y %H:%M', '%m/%d/%Y %I:%M:%S %p',
    /// epoch-s or epoch-ms
    #[arg(long, value_name = "FORMAT", value_parser = parse_known::<TimeFormat>)]
    pub(crate) time_format: Option<TimeFormat>,
    /// Corridors that may be flown: GeoJSON lines with from and to
    #[arg(long, value_name = "FILE")]
    pub(crate) corridors: Option<PathBuf>,
    /// Fares and costs of pairs: CSV with from,to,fare_usd,passenger_cost_usd
    #[arg(long, value_name = "FILE")]
    pub(crate) fares: Option<PathBuf>,
    /// Prices of electricity: CSV with period,price_usd_per_kwh
    #[arg(long, value_name = "FILE")]
    pub(crate) energy_prices: Option<PathBuf>,
    /// The network that everything else is taken from: aircraft, fleet, operations, tariffs,
    /// disturbances
    #[arg(long, value_name = "NETWORK", default_value = "new-york")]
    pub(crate) base: String,
    /// Number of aircraft, shared out among the types of the base's fleet [default: as many as the
    /// base has]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(crate) aircraft: Option<u32>,
    /// Time zone of the network's clocks, as America/New_York [default: none]
    #[arg(long, value_name = "ZONE")]
    pub(crate) time_zone: Option<String>,
    /// Name of the new network
    #[arg(long)]
    pub(crate) name: String,
    /// The network file
    #[arg(short, long, value_name = "FILE", required_unless_present = "dry_run")]
    pub(crate) output: Option<PathBuf>,
    /// Write no file: print what became of the trip records, with the first row that was dropped
    /// for each reason
    #[arg(long, conflicts_with_all = ["output", "force"])]
    pub(crate) dry_run: bool,
    /// Replace the file if it is there
    #[arg(long)]
    pub(crate) force: bool,
    /// Print what became of the trip records as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

impl ImportArguments {
    /// The flags in use that say how trip records become demand, and say nothing of a table of
    /// demand. Rules of the parser cannot refuse them: it drops the demand for `--trips` where
    /// `--demand` excludes it.
    pub(crate) fn flags_of_trips(&self) -> Vec<&'static str> {
        let flags = [
            ("--trip-columns", !self.trip_columns.is_empty()),
            ("--zones", self.zones.is_some()),
            ("--radius", self.radius.is_some()),
            ("--mode-share", self.mode_share.is_some()),
            ("--decay", self.decay.is_some()),
            ("--weekdays", self.weekdays.is_some()),
            ("--first-date", self.first_date.is_some()),
            ("--last-date", self.last_date.is_some()),
            ("--time-format", self.time_format.is_some()),
        ];
        flags.into_iter().filter(|(_, used)| *used).map(|(flag, _)| flag).collect()
    }
}

/// The column of a value of trip records.
fn parse_trip_column(text: &str) -> Result<(TripValue, String), String> {
    let (name, column) = parse_pair(text)?;
    let known = TripValue::ALL.map(TripValue::name).join(", ");
    let value = TripValue::ALL.into_iter().find(|value| value.name() == name.trim());
    let value = value.ok_or_else(|| format!("expected one of {known} before the equals sign"))?;
    Ok((value, column))
}

#[derive(Debug, Args)]
pub(crate) struct NewArguments {
    /// Name of the network
    #[arg(long)]
    pub(crate) name: Option<String>,
    /// A vertiport as ID,LATITUDE,LONGITUDE or ID,LATITUDE,LONGITUDE,STANDS; give it for each
    #[arg(long = "vertiport", value_name = "VERTIPORT", allow_hyphen_values = true, value_parser = parse_vertiport)]
    pub(crate) vertiports: Vec<NewVertiport>,
    /// Number of aircraft
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(crate) aircraft: Option<u32>,
    /// Passengers who want to fly on a day
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(crate) passengers: Option<f64>,
    /// Fare a mile, dollars
    #[arg(long, value_name = "USD", allow_hyphen_values = true)]
    pub(crate) fare: Option<f64>,
    /// The network file
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Replace the file if it is there
    #[arg(long)]
    pub(crate) force: bool,
}
