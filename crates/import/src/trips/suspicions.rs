//! The warnings of an import of trips: signs that the records are not what they seem.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Read;

use super::signs::Signs;
use super::tally::Tally;
use super::{TripAccount, Trips};
use crate::cell::Cell;
use crate::date_time::Date;
use crate::input_file::InputFile;
use crate::trip_times::{FORMS, TimeFormat, TripTimes};
use crate::{Error, Warning};

/// A date with fewer records than this share of the usual number is an error of a clock rather than
/// a day.
const STRAY_SHARE: f64 = 0.05;
/// Gaps of this many usual gaps between dates separate groups of dates.
const SEPARATING_GAPS: i32 = 7;
/// Gaps of this many usual ones separate few dates from the others whatever records they have.
const FAR_GAPS: i32 = 28;
/// A gap after which dates are of another year, however many there are.
const YEAR_DAYS: i32 = 365;
/// A group of dates with fewer records a day than this share of the usual number is small.
const FEW_SHARE: f64 = 0.2;
/// Bytes that are compared at once.
const BLOCK: usize = 64 << 10;

/// The warnings of these records. `converts` is whether instants are converted to a time zone, and
/// `overlooked` are columns that are not read and may hold the passengers.
pub(super) fn warnings(
    (trips, files): (&Trips<'_>, &[InputFile<'_>]),
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
        twice(files),
        unreadable(signs, account),
        instants(signs).filter(|_| !converts),
        exchanged(signs, account),
        no_degrees(signs),
        stray_dates(tally.dates()),
        exchanged_days(tally.dates()),
        days_without_records(trips, tally.dates()),
    ];
    columns.chain(problems.into_iter().flatten().map(of_records)).collect()
}

/// The first two files that hold the same bytes.
fn twice(files: &[InputFile<'_>]) -> Option<String> {
    let pairs = (1..files.len()).flat_map(|second| (0..second).map(move |first| (first, second)));
    let (first, second) = pairs
        .map(|(first, second)| (&files[first], &files[second]))
        .find(|(first, second)| are_same(first, second).unwrap_or(false))?;
    Some(format!(
        "{} and {} hold the same records, which count twice in the demand of each day",
        first.origin(),
        second.origin()
    ))
}

/// Whether two files hold the same bytes.
fn are_same(one: &InputFile<'_>, other: &InputFile<'_>) -> Result<bool, Error> {
    if one.length()? != other.length()? {
        return Ok(false);
    }
    let (cannot, (mut one, mut other)) =
        (|cause| one.cannot_read(cause), (one.content()?, other.content()?));
    let (mut block, mut other_block) = (vec![0; BLOCK], vec![0; BLOCK]);
    loop {
        let read = one.read(&mut block).map_err(cannot)?;
        other.read_exact(&mut other_block[..read]).map_err(cannot)?;
        if read == 0 || block[..read] != other_block[..read] {
            return Ok(read == 0);
        }
    }
}

fn unreadable(signs: &Signs, account: &TripAccount) -> Option<String> {
    let (_, first) = signs.unreadable.as_ref()?;
    let formats = formats_of(first);
    let format = if formats.is_empty() {
        String::new()
    } else {
        format!(", here as --time-format {} (%m is the month, %d the day)", formats.join(" or "))
    };
    Some(format!(
        "the times of {} of {} rows cannot be read, the first of them {first:?}: read are times as {FORMS}; \
         --time-format reads other forms{format}",
        account.no_time, account.rows
    ))
}

/// The common formats in which a time may be written, in quotes.
fn formats_of(text: &str) -> Vec<String> {
    const FORMATS: [&str; 8] = [
        "%m/%d/%Y %I:%M:%S %p",
        "%m/%d/%Y %I:%M %p",
        "%d/%m/%Y %H:%M:%S",
        "%d/%m/%Y %H:%M",
        "%m/%d/%Y %H:%M:%S",
        "%m/%d/%Y %H:%M",
        "%d.%m.%Y %H:%M:%S",
        "%d.%m.%Y %H:%M",
    ];
    let reads = |format: &&str| {
        let format: Option<TimeFormat> = format.parse().ok();
        let times = format.map(|format| TripTimes::new(Some(format), None));
        times.is_some_and(|times| times.read(Cell::text(text.as_bytes())).is_some())
    };
    FORMATS.into_iter().filter(reads).map(|format| format!("'{format}'")).collect()
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

/// Dates with hardly any records, and dates far from most others, which count as days in the mean
/// of all.
fn stray_dates(dates: &BTreeMap<Date, u64>) -> Option<String> {
    const SHOWN: usize = 5;
    let mut counts: Vec<u64> = dates.values().copied().collect();
    counts.sort_unstable();
    let usual = *counts.get(counts.len() / 2)?;
    let far = far_dates(dates, usual as f64);
    let is_stray = |(date, records): &(&Date, &u64)| {
        (**records as f64) < STRAY_SHARE * usual as f64 || far.contains(*date)
    };
    let stray: Vec<String> = dates
        .iter()
        .filter(is_stray)
        .map(|(date, records)| {
            let far = if far.contains(date) { ", far from the other dates" } else { "" };
            format!("{date} ({records} of about {usual}{far})")
        })
        .collect();
    let more = if stray.len() > SHOWN { ", ..." } else { "" };
    (!stray.is_empty()).then(|| {
        format!(
            "{} of the {} days have hardly any records or are far from the others, and each counts as a day in the mean: \
             {}{more}; \
             --first-date and --last-date leave them out",
            stray.len(),
            dates.len(),
            stray[..stray.len().min(SHOWN)].join(", "),
        )
    })
}

/// The dates that a gap separates from the largest group of dates: a gap of a year, or
/// one that is long for these dates, to dates that are few or have few records each.
fn far_dates(dates: &BTreeMap<Date, u64>, usual: f64) -> BTreeSet<Date> {
    let all: Vec<(Date, u64)> = dates.iter().map(|(date, records)| (*date, *records)).collect();
    let mut gaps: Vec<i32> = all.windows(2).map(|two| two[0].0.days_until(two[1].0)).collect();
    gaps.sort_unstable();
    // The lower of two middle ones, as half of the dates of a small sample may be far.
    let Some(&usual_gap) = gaps.get(gaps.len().saturating_sub(1) / 2) else {
        return BTreeSet::new();
    };
    let separating = (SEPARATING_GAPS * usual_gap).min(YEAR_DAYS);
    let groups: Vec<&[(Date, u64)]> =
        all.chunk_by(|one, next| one.0.days_until(next.0) < separating).collect();
    let records = |group: &[(Date, u64)]| group.iter().map(|(_, records)| records).sum::<u64>();
    let Some(main) = groups.iter().copied().rev().max_by_key(|group| (group.len(), records(group)))
    else {
        return BTreeSet::new();
    };
    let (main_first, main_last) = ends(main);
    let is_far = |group: &&[(Date, u64)]| {
        let (first, last) = ends(group);
        let apart = main_last.days_until(first).max(last.days_until(main_first));
        let few_records = (records(group) as f64) < FEW_SHARE * usual * group.len() as f64;
        let few_dates = group.len() * 2 < main.len();
        apart >= YEAR_DAYS
            || apart >= separating && few_records
            || apart >= FAR_GAPS * usual_gap && few_dates
    };
    groups.into_iter().filter(is_far).flatten().map(|(date, _)| *date).collect()
}

/// The first and the last date of a group.
fn ends(group: &[(Date, u64)]) -> (Date, Date) {
    (group[0].0, group[group.len() - 1].0)
}

/// Dates that would be within a much shorter time if days were months and months days, as where
/// `%m/%d` reads a file that writes the day first.
fn exchanged_days(dates: &BTreeMap<Date, u64>) -> Option<String> {
    /// Fewer dates are near to each other by chance.
    const LEAST_DATES: usize = 3;
    /// The time between the first and the last date is at least this many times shorter.
    const SHORTER: i32 = 3;
    let other_way: Option<BTreeSet<Date>> = dates.keys().map(|date| date.exchanged()).collect();
    let other_way = other_way.filter(|dates| dates.len() >= LEAST_DATES)?;
    let (first, last) = (dates.keys().next()?, dates.keys().next_back()?);
    let (other_first, other_last) = (other_way.first()?, other_way.last()?);
    let is_shorter = other_first.days_until(*other_last) * SHORTER <= first.days_until(*last);
    is_shorter.then(|| {
        let parts = || dates.keys().map(|date| date.parts());
        let months: BTreeSet<(i64, i64)> = parts().map(|(year, month, _)| (year, month)).collect();
        let days: BTreeSet<i64> = parts().map(|(.., day)| day).collect();
        let days: Vec<String> = days.iter().map(i64::to_string).collect();
        format!(
            "all {} dates are on day {} of {} months, and would be from {other_first} to {other_last} with days and months \
             exchanged: days and months may be exchanged, where a file writes the day first and \
             --time-format reads the month first (%d is the day, %m the month)",
            dates.len(),
            days.join(" or "),
            months.len(),
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
