//! Demand from trip records: which trips could have flown, and how many passengers they are by pair
//! and hour.
//!
//! A record counts if a vertiport is near its pick-up and another one is near its drop-off. It then
//! stands for passengers x mode_share x exp(-(access + egress) / decay_mi) passengers of the pair,
//! where access and egress are the great-circle distances to the two vertiports. The demand of an
//! hour is the mean over the days of the files.
//!
//! Files are read in blocks (CSV, `trips/blocks.rs`) or row groups (Parquet, `trips/groups.rs`),
//! several at once. Sums are whole numbers (`trips/tally.rs`), so the result is the same to the
//! last bit for any order of the records.

mod account;
mod blocks;
mod columns;
mod groups;
pub(crate) mod nearby;
mod signs;
mod suspicions;
mod tally;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use jiff::tz::TimeZone;
use vertifleet_core::{Operations, Stop};

use crate::date_time::{Date, Weekdays};
use crate::hourly_demand::HourlyDemand;
use crate::input_file::InputFile;
use crate::parquet_file;
use crate::source::{self, opening};
use crate::trip_times::{TimeFormat, TripTimes};
use crate::vertiports::Vertiports;
use crate::zones::Zones;
use crate::{Error, Warning};

pub use account::{DroppedRow, TripAccount};
use columns::{Layout, Places};
pub use columns::{TripColumns, TripValue};
use nearby::Nearby;
use tally::{Hours, Rules, Tallies};

/// Trip records and how they become demand.
///
/// The demand of an hour is a mean over days. The days are the distinct dates of the chosen
/// [`weekdays`](Self::weekdays) within [`first_date`](Self::first_date) and
/// [`last_date`](Self::last_date) on which the files have at least one valid pick-up: one whose
/// time, places and passengers can be read, wherever its places are. Files often hold a few records
/// with wrong dates, and each such date would count as a day; bounds on the dates leave them out.
/// Where operations continue past midnight, a pick-up after midnight belongs to the day before.
#[derive(Debug, Clone)]
pub struct Trips<'a> {
    /// The files, CSV or Parquet. A row of a CSV file is one line, also where a value is in quotes.
    pub files: Vec<&'a Path>,
    /// The names of the columns.
    pub columns: TripColumns<'a>,
    /// Where zones are, if the records name zones: CSV with `zone,latitude,longitude`, or GeoJSON
    /// areas or points with a property `LocationID` or `zone`.
    pub zones: Option<&'a Path>,
    /// The greatest distance between a place and its vertiport, miles.
    pub radius_mi: f64,
    /// The share of trips near enough that would fly, above 0 up to 1.
    pub mode_share: f64,
    /// The distance to and from vertiports over which the share falls to 1/e, miles; no fall if
    /// absent.
    pub decay_mi: Option<f64>,
    /// The days of the week that count.
    pub weekdays: Weekdays,
    /// The first date that counts, if not the first of the files.
    pub first_date: Option<Date>,
    /// The last date that counts, if not the last of the files.
    pub last_date: Option<Date>,
    /// How times are written, if in no form that is read anyway.
    pub time_format: Option<TimeFormat>,
}

impl<'a> Trips<'a> {
    /// Trips of these files with settings to start from: vertiports within 1 mile, 1 percent of
    /// trips, no decay, every day.
    pub fn new(files: Vec<&'a Path>) -> Self {
        Self {
            files,
            columns: TripColumns::default(),
            zones: None,
            radius_mi: 1.0,
            mode_share: 0.01,
            decay_mi: None,
            weekdays: Weekdays::ALL,
            first_date: None,
            last_date: None,
            time_format: None,
        }
    }

    fn check(&self) -> Result<(), Error> {
        let refuse = |setting, rule, found: &dyn std::fmt::Display| {
            Err(Error::Setting { setting, rule, found: found.to_string() })
        };
        // A vertiport that is farther away is not near by any measure, and boxes of this size stay
        // clear of the poles' far side.
        if !(self.radius_mi > 0.0 && self.radius_mi <= 500.0) {
            return refuse("radius_mi", "above 0, to 500", &self.radius_mi);
        }
        if !(self.mode_share > 0.0 && self.mode_share <= 1.0) {
            return refuse("mode_share", "above 0, to 1", &self.mode_share);
        }
        if let Some(decay_mi) = self.decay_mi
            && !(decay_mi > 0.0 && decay_mi <= 1e6)
        {
            return refuse("decay_mi", "above 0, to 1000000", &decay_mi);
        }
        if self.weekdays.is_empty() {
            return refuse("weekdays", "at least one day", &"none");
        }
        if self.files.is_empty() {
            return refuse("files of trips", "at least one", &"none");
        }
        match (self.first_date, self.last_date) {
            (Some(first), Some(last)) if first > last => {
                refuse("first_date", "no later than last_date", &first)
            }
            _ => Ok(()),
        }
    }
}

/// Reads trip records and returns the demand and the account of all records. Times that are
/// instants are converted to a time zone, if it is given.
pub(crate) fn demand(
    trips: &Trips<'_>,
    (vertiports, operations): (&Vertiports, &Operations),
    time_zone: Option<TimeZone>,
    warnings: &mut Vec<Warning>,
    stop: &Stop,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<(HourlyDemand, TripAccount), Error> {
    trips.check()?;
    let zones = match trips.zones {
        Some(path) => Zones::read(&InputFile::open(path, source::LONGEST, stop)?, warnings)?,
        None => Zones::default(),
    };
    let files = trips.files.iter().map(|path| InputFile::open(path, u64::MAX, stop));
    let files: Vec<InputFile<'_>> = files.collect::<Result<_, _>>()?;
    let converts = time_zone.is_some();
    let places = vertiports.list.iter().map(|vertiport| vertiport.place).collect();
    let nearby = Nearby::new(places, trips.radius_mi);
    let rules = Rules {
        near_zones: zones.middles.iter().map(|&middle| nearby.of(middle)).collect(),
        nearby,
        hours: Hours::of(operations),
        times: TripTimes::new(trips.time_format.clone(), time_zone),
        decay_mi: trips.decay_mi,
        weekdays: trips.weekdays,
        dates: trips.first_date..=trips.last_date,
    };
    let reading = Reading::new(trips, &files, &zones, &rules, stop, progress)?;
    let tally = reading.read()?;
    let mut account = tally.account(trips);
    account.first_dropped = first_dropped(&account, &tally, &files)?;
    let mut found =
        suspicions::warnings((trips, &files), &tally, &account, converts, &reading.overlooked());
    if let Some(path) = trips.zones {
        found.extend(zones.exchanged(path, vertiports));
    }
    if account.kept == 0 {
        let mut reasons = account.to_string();
        for warning in &found {
            let _ = write!(reasons, "; {warning}");
        }
        return Err(Error::NoTrips { account: reasons });
    }
    warnings.extend(found);
    let share = trips.mode_share / f64::from(account.days.max(1));
    let mut pairs = BTreeMap::new();
    for from in 0..vertiports.list.len() {
        for to in 0..vertiports.list.len() {
            let mean = |hour| rounded(tally.passengers(hour, (from, to)) * share);
            let means: Vec<f64> = (0..rules.hours.count()).map(mean).collect();
            if means.iter().any(|&mean| mean > 0.0) {
                pairs.insert((from, to), means);
            }
        }
    }
    let demand = HourlyDemand { periods: rules.hours.starts(), first_given: 0, pairs };
    let account = TripAccount { passengers_a_day: rounded(demand.passengers()), ..account };
    Ok((demand, account))
}

/// The first row that was dropped for each reason, with its place.
fn first_dropped(
    account: &TripAccount,
    tally: &tally::Tally,
    files: &[InputFile<'_>],
) -> Result<Vec<DroppedRow>, Error> {
    let reasons = account.dropped().into_iter().zip(&tally.signs().first_dropped);
    let row = |((reason, _), first): ((&'static str, u64), &Option<signs::FirstRow>)| {
        let first = first.as_ref()?;
        let file = &files[first.position.file];
        let place = if parquet_file::is_parquet(file, &opening(file).ok()?) {
            Ok(format!("row {}", first.position.at + 1))
        } else {
            blocks::line_number(file, first.position.at).map(|line| format!("line {line}"))
        };
        let file = crate::file_name(file.path());
        Some(place.map(|place| DroppedRow { reason, file, place, row: first.text.clone() }))
    };
    reasons.filter_map(row).collect()
}

/// The demand periods of trip records, without any passengers.
pub(crate) fn no_demand(operations: &Operations) -> HourlyDemand {
    HourlyDemand { periods: Hours::of(operations).starts(), first_given: 0, pairs: BTreeMap::new() }
}

/// A number of passengers to a millionth, which keeps network files short.
fn rounded(passengers: f64) -> f64 {
    (passengers * 1e6).round() / 1e6
}

/// Everything that the readers of all files share.
struct Reading<'a> {
    trips: &'a Trips<'a>,
    files: &'a [InputFile<'a>],
    zones: &'a Zones,
    tallies: Tallies<'a>,
    stop: &'a Stop,
    progress: Progress<'a>,
    /// Files with a column that is not read and may hold the passengers, and this column.
    overlooked: Mutex<BTreeSet<(String, String)>>,
}

/// The share of the files' bytes that has been read.
struct Progress<'a> {
    done: AtomicU64,
    all: u64,
    report: &'a (dyn Fn(f64) + Sync),
}

impl Progress<'_> {
    fn add(&self, bytes: u64) {
        let done = self.done.fetch_add(bytes, Ordering::Relaxed) + bytes;
        (self.report)((done as f64 / self.all.max(1) as f64).min(1.0));
    }
}

impl<'a> Reading<'a> {
    fn new(
        trips: &'a Trips<'a>,
        files: &'a [InputFile<'a>],
        zones: &'a Zones,
        rules: &'a Rules,
        stop: &'a Stop,
        report: &'a (dyn Fn(f64) + Sync),
    ) -> Result<Self, Error> {
        let mut all = 0;
        for file in files {
            all += file.length()?;
        }
        let progress = Progress { done: AtomicU64::new(0), all, report };
        let overlooked = Mutex::default();
        Ok(Self { trips, files, zones, tallies: Tallies::new(rules), stop, progress, overlooked })
    }

    /// Notes that a column of a file is not read and may hold the passengers.
    fn overlook(&self, origin: &str, column: &str) {
        let mut overlooked = self.overlooked.lock().unwrap_or_else(PoisonError::into_inner);
        overlooked.insert((origin.to_owned(), column.to_owned()));
    }

    fn overlooked(&self) -> Vec<(String, String)> {
        let overlooked = self.overlooked.lock().unwrap_or_else(PoisonError::into_inner);
        overlooked.iter().cloned().collect()
    }

    /// The zones that a file's places are in. A file with coordinates needs none.
    fn zones_for(&self, layout: &Layout, origin: &str) -> Result<&'a Zones, Error> {
        match layout.places {
            Places::Zones(_) if self.trips.zones.is_none() => {
                Err(Error::NoZones { origin: origin.to_owned() })
            }
            Places::Zones(_) | Places::Coordinates(_) => Ok(self.zones),
        }
    }

    /// Reads the CSV files one after the other, and then the row groups of all Parquet files.
    fn read(&self) -> Result<tally::Tally, Error> {
        let mut parquet = Vec::new();
        for (number, file) in self.files.iter().enumerate() {
            if parquet_file::is_parquet(file, &opening(file)?) {
                parquet.push((number, file));
            } else {
                blocks::read(file, number, self)?;
            }
        }
        groups::read(&parquet, self)?;
        self.stop.check()?;
        Ok(self.tallies.total())
    }
}
