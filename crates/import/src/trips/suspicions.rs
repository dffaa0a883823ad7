//! The warnings of an import of trips: signs that the records are not what they seem.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::signs::Signs;
use super::tally::Tally;
use super::{TripAccount, Trips};
use crate::Warning;
use crate::date_time::Date;
use crate::trip_times::FORMS;

/// A date with fewer records than this share of the usual number is an error of a clock rather than
/// a day.
const STRAY_SHARE: f64 = 0.01;
/// Bytes that are compared at once.
const BLOCK: usize = 64 << 10;

/// The warnings of these records. `converts` is whether instants are converted to a time zone, and
/// `overlooked` are columns that are not read and may hold the passengers.
pub(super) fn warnings(
    trips: &Trips<'_>,
    tally: &Tally,
    account: &TripAccount,
    converts: bool,
    overlooked: &[(String, String)],
) -> Vec<Warning> {
    let the_records = || "the trip records".to_owned();
    let of_records = |problem| Warning::Trips { origin: the_records(), problem };
    let columns = overlooked.iter().map(|(origin, column)| Warning::Trips {
        origin: origin.clone(),
        problem: format!(
            "each record counts as one passenger, and the column {column:?} is not read: \
             --trip-columns passengers={column} reads the passengers from it"
        ),
    });
    let signs = tally.signs();
    let problems = [
        twice(&trips.files),
        unreadable(signs, account),
        instants(signs).filter(|_| !converts),
        exchanged(signs, account),
        no_degrees(signs),
        stray_dates(tally.dates()),
        days_without_records(trips, tally.dates()),
    ];
    columns.chain(problems.into_iter().flatten().map(of_records)).collect()
}

/// The first two files that hold the same bytes.
fn twice(files: &[&Path]) -> Option<String> {
    let pairs = (1..files.len()).flat_map(|second| (0..second).map(move |first| (first, second)));
    let (first, second) = pairs
        .map(|(first, second)| (files[first], files[second]))
        .find(|(first, second)| are_same(first, second).unwrap_or(false))?;
    Some(format!(
        "{} and {} hold the same records, which count twice in the demand of each day",
        first.display(),
        second.display()
    ))
}

/// Whether two files hold the same bytes.
fn are_same(one: &Path, other: &Path) -> std::io::Result<bool> {
    if std::fs::metadata(one)?.len() != std::fs::metadata(other)?.len() {
        return Ok(false);
    }
    let (mut one, mut other) = (File::open(one)?, File::open(other)?);
    let (mut block, mut other_block) = (vec![0; BLOCK], vec![0; BLOCK]);
    loop {
        let read = one.read(&mut block)?;
        other.read_exact(&mut other_block[..read])?;
        if read == 0 || block[..read] != other_block[..read] {
            return Ok(read == 0);
        }
    }
}

fn unreadable(signs: &Signs, account: &TripAccount) -> Option<String> {
    let (_, first) = signs.unreadable.as_ref()?;
    Some(format!(
        "the times of {} of {} rows cannot be read, the first of them {first:?}: read are times as {FORMS}; \
         --time-format reads other forms",
        account.no_time, account.rows
    ))
}

fn instants(signs: &Signs) -> Option<String> {
    (signs.instants > 0).then(|| {
        format!(
            "the times of {} rows have a time zone, and are taken as their clocks show them: --time-zone converts them to that \
             of the network",
            signs.instants
        )
    })
}

fn exchanged(signs: &Signs, account: &TripAccount) -> Option<String> {
    (signs.exchanged > account.kept).then(|| {
        format!(
            "{} rows would be near vertiports if their latitudes and longitudes were exchanged, and {} are as they stand: check \
             the columns of coordinates, here and of the vertiports",
            signs.exchanged, account.kept
        )
    })
}

fn no_degrees(signs: &Signs) -> Option<String> {
    (signs.no_degrees > signs.exchanged).then(|| {
        format!(
            "the coordinates of {} rows are no degrees: export them in longitude and latitude (WGS 84), and not in metres of a map",
            signs.no_degrees
        )
    })
}

/// Dates with hardly any records, which count as days and lower the mean of all.
fn stray_dates(dates: &BTreeMap<Date, u64>) -> Option<String> {
    const SHOWN: usize = 5;
    let mut counts: Vec<u64> = dates.values().copied().collect();
    counts.sort_unstable();
    let usual = *counts.get(counts.len() / 2)? as f64;
    let is_stray = |(_, records): &(&Date, &u64)| (**records as f64) < STRAY_SHARE * usual;
    let stray: Vec<String> = dates
        .iter()
        .filter(is_stray)
        .map(|(date, records)| format!("{date} ({records} of about {usual})"))
        .collect();
    let more = if stray.len() > SHOWN { ", ..." } else { "" };
    (!stray.is_empty()).then(|| {
        format!(
            "{} of the {} days have hardly any records, and each lowers the mean: {}{more}; --first-date and --last-date leave \
             them out",
            stray.len(),
            dates.len(),
            stray[..stray.len().min(SHOWN)].join(", "),
        )
    })
}

/// Days without records between the dates that were given.
fn days_without_records(trips: &Trips<'_>, dates: &BTreeMap<Date, u64>) -> Option<String> {
    let (first, last) = (trips.first_date?, trips.last_date?);
    let wanted = first.to(last).filter(|date| trips.weekdays.contains(date.weekday()));
    let without: Vec<Date> = wanted.clone().filter(|date| !dates.contains_key(date)).collect();
    let earliest = without.first()?;
    Some(format!(
        "{} of the {} days from {first} to {last} have no records and do not count in the mean; the first of them is {earliest}",
        without.len(),
        wanted.count(),
    ))
}
