//! The arguments of `vertifleet network`.

use std::path::PathBuf;

use clap::{ArgGroup, Args, Subcommand};
use vertifleet_import::{Date, NewVertiport, TimeFormat, TripValue, Weekdays};

use super::{FORCE, NETWORK};
use crate::typed::{parse_known, parse_mode_share, parse_pair, parse_vertiport};

#[derive(Debug, Subcommand)]
pub(crate) enum NetworkAction {
    /// Make a network file from tables of vertiports, demand or trip records, corridors and fares
    ///
    /// Tables are CSV with a header, or Parquet; they may be compressed with gzip, or be the only
    /// file of a zip archive. Columns may have any order and case, and other columns are ignored.
    /// Positions in GeoJSON are longitude, then latitude.
    ///
    /// A trip record counts as passengers x mode share x exp(-(way to the vertiport + way from it)
    /// / decay) passengers of the two nearest vertiports, in the hour of its pick-up. The demand is
    /// the mean over the days with a valid record, so leave stray dates out. Rows that cannot be
    /// used are counted by reason. The comments of the file give the source of each part.
    Import(Box<ImportArguments>),
    /// Report all errors and warnings of network files
    ///
    /// The exit code is 2 if a file cannot be used.
    Check {
        /// Network files
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Print the findings as JSON
        #[arg(long)]
        json: bool,
    },
    /// Show a network: vertiports with their demand, the fleet, passengers by hour and by pair
    Show {
        #[arg(help = NETWORK)]
        network: String,
        /// Draw a map, the demand by hour, and the matrix of demand in each period, as .svg or .png
        #[arg(long, value_name = "FILE")]
        picture: Option<PathBuf>,
        #[arg(long, help = FORCE)]
        force: bool,
        /// Print the network as JSON, with the mean demand of every pair and period
        #[arg(long)]
        json: bool,
    },
    /// Write a network file to start from, with a comment at each assumption
    ///
    /// Asks for what no flag gives, if it runs in a terminal.
    New(NewArguments),
    /// List the differences between two networks, by the paths that sweep --vary takes
    Diff {
        /// Network file or name
        one: String,
        /// Network file or name
        other: String,
        /// Print the differences as JSON: path, before and after; a number of the hourly demand has
        /// from, to and period, and a path if the first network has its pair
        #[arg(long)]
        json: bool,
    },
}

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("source").required(true).args(["demand", "trips"]))]
pub(crate) struct ImportArguments {
    /// Vertiports: CSV with id,latitude,longitude and optionally stands (4 if absent), chargers,
    /// charger_kw (the most power of a charger), busy; or GeoJSON points
    #[arg(long, value_name = "FILE")]
    pub(crate) vertiports: PathBuf,
    /// Mean passengers: CSV or Parquet with period,from,to,passengers; a period is a time (06:00,
    /// 6:00 AM, 06:00-07:00) or an hour, and lasts until the next one of the table. CSV may have a
    /// column for each period or for each destination instead of the passengers
    #[arg(long, value_name = "FILE")]
    pub(crate) demand: Option<PathBuf>,
    /// Trip records, CSV or Parquet, with times and places, in the columns of common records, such
    /// as those of the taxis of New York and Chicago; zones need --zones
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub(crate) trips: Vec<PathBuf>,
    /// Columns of the trip records with other names, as pickup_time=began,passengers=riders; values
    /// are pickup_time, pickup_latitude, pickup_longitude, dropoff_latitude, dropoff_longitude,
    /// pickup_zone, dropoff_zone and passengers
    #[arg(long, value_name = "VALUE=COLUMN", value_delimiter = ',', value_parser = parse_trip_column)]
    pub(crate) trip_columns: Vec<(TripValue, String)>,
    /// Places of the zones of trip records: CSV with zone,latitude,longitude, or GeoJSON areas or
    /// points
    #[arg(long, value_name = "FILE")]
    pub(crate) zones: Option<PathBuf>,
    /// Largest distance between a place and its vertiport, miles [default: 1]
    #[arg(long, value_name = "MILES", allow_hyphen_values = true)]
    pub(crate) radius: Option<f64>,
    /// Share of the trips near vertiports that would fly [default: 0.01]
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, value_parser = parse_mode_share)]
    pub(crate) mode_share: Option<f64>,
    /// Distance to and from vertiports over which that share falls to 1/e, miles [default:
    /// infinite]
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
    /// Format of the times of trip records: a pattern of strptime, as '%d/%m/%Y %H:%M' or '%m/%d/%Y
    /// %I:%M:%S %p', or epoch-s or epoch-ms [default: as 2015-06-01 07:08:09]
    #[arg(long, value_name = "FORMAT", value_parser = parse_known::<TimeFormat>)]
    pub(crate) time_format: Option<TimeFormat>,
    /// Corridors: GeoJSON lines with from, to and optionally both_ways (true if absent), whose
    /// lengths become distances
    #[arg(long, value_name = "FILE")]
    pub(crate) corridors: Option<PathBuf>,
    /// Fares and costs of pairs: CSV with from,to and fare_usd, passenger_cost_usd or both; the
    /// factors and fees of the base apply to these fares too
    #[arg(long, value_name = "FILE")]
    pub(crate) fares: Option<PathBuf>,
    /// Prices of electricity: CSV with period,price_usd_per_kwh; a price holds until the next one
    #[arg(long, value_name = "FILE")]
    pub(crate) energy_prices: Option<PathBuf>,
    /// Network to take everything else from: aircraft, fleet, operations, tariffs, disturbances
    #[arg(long, value_name = "NETWORK", default_value = "new-york")]
    pub(crate) base: String,
    /// Number of aircraft, divided among types as in the base's fleet [default: the base's]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(crate) aircraft: Option<u32>,
    /// Time zone of the network's clocks, from the IANA database, as America/New_York; times with
    /// another zone are converted to it [default: none]
    #[arg(long, value_name = "ZONE")]
    pub(crate) time_zone: Option<String>,
    /// Name of the new network
    #[arg(long)]
    pub(crate) name: String,
    /// The network file
    #[arg(short, long, value_name = "FILE", required_unless_present = "dry_run")]
    pub(crate) output: Option<PathBuf>,
    /// Write no file, and print the first trip record dropped for each reason
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
    /// The given flags that describe how trip records become demand, and have no meaning for a
    /// table of demand. Rules of the parser cannot refuse them: it drops the demand for `--trips`
    /// where `--demand` excludes it.
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
    /// A vertiport as `ID,LATITUDE,LONGITUDE[,STANDS]`, with 4 stands if not given; once for each
    #[arg(long = "vertiport", value_name = "VERTIPORT", allow_hyphen_values = true, value_parser = parse_vertiport)]
    pub(crate) vertiports: Vec<NewVertiport>,
    /// Number of aircraft
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(crate) aircraft: Option<u32>,
    /// Number of passengers who want to fly on a day
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(crate) passengers: Option<f64>,
    /// Fare, dollars a mile
    #[arg(long, value_name = "USD", allow_hyphen_values = true)]
    pub(crate) fare: Option<f64>,
    /// The network file
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Replace the file if it is there
    #[arg(long)]
    pub(crate) force: bool,
}
