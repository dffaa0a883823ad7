//! Networks from a planner's own data: vertiports, demand, trip records, corridors, fares and
//! energy prices.
//!
//! [`import`] reads the files of a [`Request`] and makes the text of a network file. Members that
//! planners have no data on, such as aircraft types and the fleet, come from another network, the
//! *base*, with its comments. The text is read again before it is returned, so that every import is
//! a valid network.
//!
//! Small files are read whole, trip records in blocks (`trips.rs`); both kinds may be CSV or
//! Parquet, and every value of either kind is a cell (`cell.rs`). Maps are GeoJSON, with longitude
//! and latitude in degrees.

mod cell;
mod clock;
mod corridors;
mod date_time;
mod demand_comments;
mod demand_warnings;
mod energy_prices;
mod error;
mod features;
mod fleet;
mod globe;
mod header;
mod hourly_demand;
mod input_file;
mod network_text;
mod new_network;
mod parquet_file;
mod parquet_meaning;
mod row;
mod source;
mod strict_json;
mod table;
mod tariffs;
mod trip_times;
mod trips;
mod units;
mod unread;
mod vertiports;
mod warning;
mod zones;

use std::path::Path;

use vertifleet_core::{Network, Stop};

use energy_prices::EnergyPrices;
use hourly_demand::HourlyDemand;
use input_file::InputFile;
use network_text::{FromFile, NetworkText};
use vertiports::Vertiports;

pub use date_time::{Date, NotADate, Weekday, Weekdays};
pub use error::Error;
pub use new_network::{NewNetwork, NewVertiport};
pub use trip_times::{NotAFormat, TimeFormat};
pub use trips::{DroppedRow, TripAccount, TripColumns, TripValue, Trips};
pub use warning::Warning;

/// The files and settings of an import.
#[derive(Debug)]
pub struct Request<'a> {
    /// The network that aircraft types, fleet, operations, tariffs and disturbances are taken from.
    pub base: &'a Network,
    /// The name of the new network.
    pub name: &'a str,
    /// The vertiports: CSV with the columns `id,latitude,longitude` and, if it likes,
    /// `stands,chargers,charger_kw,busy,name`; or GeoJSON points with such properties.
    pub vertiports: &'a Path,
    /// The demand.
    pub demand: Demand<'a>,
    /// The corridors: GeoJSON lines with the properties `from`, `to` and, if it likes, `both_ways`,
    /// which is true if absent. All pairs may be flown if there is no such file.
    pub corridors: Option<&'a Path>,
    /// Fares and passenger costs of pairs: CSV with the columns
    /// `from,to,fare_usd,passenger_cost_usd`, of which one of the last two may be left out.
    pub tariffs: Option<&'a Path>,
    /// Number of aircraft: the fleet of the base with every type's share of this number. The base's
    /// own fleet if absent.
    pub aircraft: Option<u32>,
    /// The time zone of the network's clocks, by its name in the IANA database; it has none if
    /// absent.
    pub time_zone: Option<&'a str>,
    /// Prices of electricity: CSV with the columns `period,price_usd_per_kwh`. A price holds until
    /// the next one.
    pub energy_prices: Option<&'a Path>,
}

/// Where the demand comes from.
#[derive(Debug, Clone)]
#[expect(clippy::large_enum_variant, reason = "there is one of them in an import")]
pub enum Demand<'a> {
    /// Mean passengers of a day by pair and period: CSV or Parquet with the columns
    /// `period,from,to,passengers`. A period is a time as `HH:MM` or `HH:MM:SS`, or an hour from 0
    /// to 47; it lasts until the next one that the table has, and the last one for the rest of the
    /// day.
    Table(&'a Path),
    /// Trip records.
    Trips(Trips<'a>),
}

/// An imported network.
#[derive(Debug)]
pub struct Imported {
    /// The network, checked.
    pub network: Network,
    /// The text of its file, with comments on the source of everything.
    pub toml: String,
    /// The account of the trip records, if the demand comes from them.
    pub account: Option<TripAccount>,
    /// The members of the base that the network has unchanged, by their paths.
    pub inherited: Vec<String>,
    /// Warnings of the planner's files, besides those of the network.
    pub warnings: Vec<Warning>,
}

/// Makes a network of a planner's files. `progress` is called with the share of the trip records
/// that has been read.
///
/// # Errors
/// A file cannot be read or breaks a rule, the resulting network breaks one, or `stop` is
/// requested.
pub fn import(
    request: &Request<'_>,
    stop: &Stop,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Imported, Error> {
    stop.check()?;
    let time_zone = request.time_zone.map(trip_times::zone).transpose()?;
    let mut warnings = Vec::new();
    let file = |path| InputFile::open(path, source::LONGEST, stop);
    let vertiports = Vertiports::read(&file(request.vertiports)?, &mut warnings)?;
    let text = NetworkText {
        base: request.base,
        name: request.name,
        vertiports: FromFile { what: &vertiports, path: request.vertiports },
        corridors: read(request.corridors, |path| {
            corridors::read(&file(path)?, &vertiports, &mut warnings)
        })?,
        pair_tariffs: read(request.tariffs, |path| {
            tariffs::pairs(&file(path)?, &vertiports, &mut warnings)
        })?,
        aircraft: request.aircraft,
        time_zone: request.time_zone,
        energy_prices: read(request.energy_prices, |path| {
            EnergyPrices::read(&file(path)?, &mut warnings)
        })?,
    };
    let operations = request.base.operations();
    stop.check()?;
    let (demand, source, account) = match &request.demand {
        Demand::Table(path) => {
            let demand = HourlyDemand::read(&file(path)?, &vertiports, operations, &mut warnings)?;
            let source = demand_comments::of_table(path, &demand);
            (demand, source, None)
        }
        Demand::Trips(trips) => {
            // Trip records may take minutes to read, so all other errors are found first.
            text.network(&trips::no_demand(operations), &[])?;
            let (demand, account) = trips::demand(
                trips,
                (&vertiports, operations),
                time_zone,
                &mut warnings,
                stop,
                progress,
            )?;
            (demand, demand_comments::of_trips(trips, &account), Some(account))
        }
    };
    stop.check()?;
    let (network, toml) = text.network(&demand, &source)?;
    warnings.extend(vertiports.warnings(request.vertiports));
    warnings.extend(demand.warnings(&request.demand, request.base));
    if let Some(prices) = &text.energy_prices {
        warnings.extend(prices.what.warning(&demand.periods, operations));
        warnings.extend(prices.what.other_end(operations));
    }
    progress(1.0);
    let inherited = text.inherited()?;
    Ok(Imported { network, toml, account, inherited, warnings })
}

/// Reads a file that may be absent.
fn read<'a, T>(
    path: Option<&'a Path>,
    read: impl FnOnce(&'a Path) -> Result<T, Error>,
) -> Result<Option<FromFile<'a, T>>, Error> {
    path.map(|path| Ok(FromFile { what: read(path)?, path })).transpose()
}

/// The name of a file without its folder, for comments.
fn file_name(path: &Path) -> String {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
    cell::printable(&name.unwrap_or_default())
}
