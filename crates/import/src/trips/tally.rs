//! Adds up trip records by pair and hour, and counts the records that are dropped by reason.
//!
//! Sums are whole multiples of 2^-30 passengers. Whole numbers add up to the same sum in any order,
//! so the demand does not depend on how files are cut into blocks, nor on which thread reads which
//! block, nor on the kind of file. The rounding error of each record is below a billionth of a
//! passenger.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use vertifleet_core::{Operations, Time};

use super::nearby::{Near, Nearby};
use super::signs::{Position, RowText, Signs};
use super::{TripAccount, Trips};
use crate::cell::Cell;
use crate::date_time::{DAY_S, Date, Moment, Weekdays};
use crate::globe::Place;
use crate::trip_times::TripTimes;

const UNITS: f64 = (1_u64 << 30) as f64;
/// The most passengers of a record.
const MOST_PASSENGERS: f64 = 100.0;
const HOUR_S: u32 = 3600;

/// The readable values of a trip record.
#[derive(Debug, Clone, Copy)]
pub(super) struct Record<'row> {
    pub(super) position: Position,
    pub(super) row: RowText<'row>,
    /// When it began.
    pub(super) time: Cell<'row>,
    pub(super) from: Option<End>,
    pub(super) to: Option<End>,
    pub(super) passengers: Option<f64>,
}

/// An end of a trip.
#[derive(Debug, Clone, Copy)]
pub(super) enum End {
    /// Numbers that should be degrees.
    At { latitude: f64, longitude: f64 },
    /// A zone by its position.
    Zone(usize),
}

impl End {
    /// Whether its numbers are no degrees.
    #[inline]
    fn is_nowhere(self) -> bool {
        match self {
            Self::At { latitude, longitude } => Place::new(latitude, longitude).is_none(),
            Self::Zone(_) => false,
        }
    }
}

/// How records become demand.
pub(super) struct Rules {
    pub(super) nearby: Nearby,
    /// The vertiport near each zone.
    pub(super) near_zones: Vec<Option<Near>>,
    pub(super) hours: Hours,
    pub(super) times: TripTimes,
    pub(super) decay_mi: Option<f64>,
    pub(super) weekdays: Weekdays,
    /// The first and the last date that count, where they are given.
    pub(super) dates: RangeInclusive<Option<Date>>,
}

/// The hours of operations: periods that begin at the start of operations and at every full hour
/// before their end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hours {
    start: u32,
    end: u32,
}

impl Hours {
    pub(super) fn of(operations: &Operations) -> Self {
        Self { start: operations.start.seconds(), end: operations.end.seconds() }
    }

    /// Number of periods, at least 1.
    pub(super) fn count(self) -> usize {
        let hours = self.end.div_ceil(HOUR_S).saturating_sub(self.start / HOUR_S).max(1);
        usize::try_from(hours).unwrap_or(1)
    }

    /// The start of each period.
    pub(super) fn starts(self) -> Vec<Time> {
        let full = (self.start / HOUR_S + 1..).map(|hour| hour * HOUR_S);
        let starts = std::iter::once(self.start).chain(full);
        starts.take(self.count()).map(Time::from_seconds).collect()
    }

    /// The period of a second, counted from the midnight before operations start, if it is within
    /// operations.
    #[inline]
    fn period(self, second: u32) -> Option<usize> {
        let within = self.start <= second && second < self.end;
        within.then(|| (second / HOUR_S - self.start / HOUR_S) as usize)
    }
}

/// Why a record is dropped.
#[derive(Debug, Clone, Copy)]
enum Reason {
    TooManyValues,
    NoTime,
    NoPlace,
    NoPassengers,
    OtherDate,
    OtherWeekday,
    OutsideOperations,
    FarPickup,
    FarDropoff,
    SameVertiport,
}

/// Number of reasons.
pub(super) const REASONS: usize = 10;

/// Sums and counts of the records that were added.
pub(super) struct Tally {
    /// Passengers in units, by period, from and to.
    units: Vec<u64>,
    vertiports: usize,
    kept: u64,
    dropped: [u64; REASONS],
    /// Number of valid records of each date that has any.
    dates: BTreeMap<Date, u64>,
    /// The date of the latest records and their number, which is not in `dates` yet; most records
    /// have the date of the one before.
    latest: Option<(Date, u64)>,
    signs: Signs,
}

impl Tally {
    fn new(rules: &Rules) -> Self {
        let vertiports = rules.nearby.vertiports();
        Self {
            units: vec![0; rules.hours.count() * vertiports * vertiports],
            vertiports,
            kept: 0,
            dropped: [0; REASONS],
            dates: BTreeMap::new(),
            latest: None,
            signs: Signs::default(),
        }
    }

    /// Counts a record with more values than there are columns.
    pub(super) fn add_with_too_many_values(&mut self, position: Position, line: &[u8]) {
        self.drop_row(Reason::TooManyValues, position, RowText::Line(line));
    }

    #[inline]
    fn drop_row(&mut self, reason: Reason, position: Position, row: RowText<'_>) {
        let reason = reason as usize;
        self.dropped[reason] += 1;
        self.signs.drop_row(reason, position, row);
    }

    /// Adds a record, or counts why it is dropped.
    #[inline]
    pub(super) fn add(&mut self, record: &Record<'_>, rules: &Rules) {
        match self.cell_and_units(record, rules) {
            Ok((cell, units)) => {
                // The largest sum is 17 billion passengers, more than there are people.
                self.units[cell] = self.units[cell].saturating_add(units);
                self.kept += 1;
            }
            Err(reason) => self.drop_row(reason, record.position, record.row),
        }
    }

    fn cell_and_units(
        &mut self,
        record: &Record<'_>,
        rules: &Rules,
    ) -> Result<(usize, u64), Reason> {
        let Some((pickup, is_instant)) = rules.times.read(record.time) else {
            self.signs.cannot_read(record);
            return Err(Reason::NoTime);
        };
        self.signs.instants += u64::from(is_instant);
        let (Some(from), Some(to)) = (record.from, record.to) else { return Err(Reason::NoPlace) };
        if from.is_nowhere() || to.is_nowhere() {
            self.signs.no_degrees += 1;
            self.signs.exchanged += u64::from(rules.are_exchanged(from, to));
            return Err(Reason::NoPlace);
        }
        let passengers = record
            .passengers
            .filter(|&passengers| passengers > 0.0 && passengers <= MOST_PASSENGERS)
            .ok_or(Reason::NoPassengers)?;
        let (date, period) = self.operating_day(pickup, rules)?;
        if !rules.weekdays.contains(date.weekday()) {
            return Err(Reason::OtherWeekday);
        }
        let period = period.ok_or(Reason::OutsideOperations)?;
        let (access, egress) = (rules.near(from), rules.near(to));
        if access.or(egress).is_none() {
            self.signs.exchanged += u64::from(rules.are_exchanged(from, to));
        }
        let access = access.ok_or(Reason::FarPickup)?;
        let egress = egress.ok_or(Reason::FarDropoff)?;
        if access.vertiport == egress.vertiport {
            return Err(Reason::SameVertiport);
        }
        let cell =
            (period * self.vertiports + access.vertiport) * self.vertiports + egress.vertiport;
        let weight = passengers * rules.share(access.distance_mi + egress.distance_mi);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative, and at most 100 x 2^30"
        )]
        Ok((cell, (weight * UNITS).round() as u64))
    }

    /// The date of the day of operations that a pick-up belongs to, and its period. The date counts
    /// as a day with records, unless the pick-up is after midnight in operations that began on the
    /// day before: that day counts by the records before midnight.
    #[inline]
    fn operating_day(
        &mut self,
        pickup: Moment,
        rules: &Rules,
    ) -> Result<(Date, Option<usize>), Reason> {
        let today = rules.hours.period(pickup.second);
        let night = today.map_or_else(|| rules.hours.period(pickup.second + DAY_S), |_| None);
        let date = if night.is_some() { pickup.date.before() } else { pickup.date };
        let too_early = rules.dates.start().is_some_and(|first| date < first);
        let too_late = rules.dates.end().is_some_and(|last| date > last);
        if too_early || too_late {
            return Err(Reason::OtherDate);
        }
        let counts = night.is_none() && rules.weekdays.contains(date.weekday());
        if counts {
            match &mut self.latest {
                Some((latest, records)) if *latest == date => *records += 1,
                _ => {
                    self.add_latest();
                    self.latest = Some((date, 1));
                }
            }
        }
        Ok((date, today.or(night)))
    }

    /// Adds the records of the latest date to those of the dates.
    fn add_latest(&mut self) {
        if let Some((date, records)) = self.latest.take() {
            *self.dates.entry(date).or_default() += records;
        }
    }

    /// Adds the sums and counts of another tally.
    fn merge(&mut self, other: &Self) {
        for (units, more) in self.units.iter_mut().zip(&other.units) {
            *units = units.saturating_add(*more);
        }
        for (rows, more) in self.dropped.iter_mut().zip(&other.dropped) {
            *rows += more;
        }
        self.kept += other.kept;
        for (date, records) in
            other.dates.iter().map(|(date, records)| (*date, *records)).chain(other.latest)
        {
            *self.dates.entry(date).or_default() += records;
        }
        self.signs.merge(&other.signs);
    }

    /// Number of valid records of each date that has any.
    pub(super) fn dates(&self) -> &BTreeMap<Date, u64> {
        &self.dates
    }

    pub(super) fn signs(&self) -> &Signs {
        &self.signs
    }

    /// Passengers of all days in a period from one vertiport to another, before the mode share.
    pub(super) fn passengers(&self, period: usize, (from, to): (usize, usize)) -> f64 {
        self.units[(period * self.vertiports + from) * self.vertiports + to] as f64 / UNITS
    }

    /// The account of all records. The passengers of a day are still open.
    pub(super) fn account(&self, trips: &Trips<'_>) -> TripAccount {
        let dropped = |reason: Reason| self.dropped[reason as usize];
        let name = |path: &&Path| crate::file_name(path);
        TripAccount {
            files: trips.files.iter().map(name).collect(),
            rows: self.kept + self.dropped.iter().sum::<u64>(),
            kept: self.kept,
            too_many_values: dropped(Reason::TooManyValues),
            no_time: dropped(Reason::NoTime),
            no_place: dropped(Reason::NoPlace),
            no_passengers: dropped(Reason::NoPassengers),
            other_date: dropped(Reason::OtherDate),
            other_weekday: dropped(Reason::OtherWeekday),
            outside_operations: dropped(Reason::OutsideOperations),
            far_pickup: dropped(Reason::FarPickup),
            far_dropoff: dropped(Reason::FarDropoff),
            same_vertiport: dropped(Reason::SameVertiport),
            days: u32::try_from(self.dates.len()).unwrap_or(u32::MAX),
            first_date: self.dates.first_key_value().map(|(date, _)| *date),
            last_date: self.dates.last_key_value().map(|(date, _)| *date),
            passengers_a_day: 0.0,
            first_dropped: Vec::new(),
        }
    }
}

impl Rules {
    #[inline]
    fn near(&self, end: End) -> Option<Near> {
        match end {
            End::At { latitude, longitude } => self.nearby.of(Place::new(latitude, longitude)?),
            End::Zone(zone) => self.near_zones[zone],
        }
    }

    /// Whether both ends would be near a vertiport if their latitudes and longitudes were
    /// exchanged.
    #[cold]
    fn are_exchanged(&self, from: End, to: End) -> bool {
        [from, to].into_iter().all(|end| match end {
            End::At { latitude, longitude } => {
                self.near(End::At { latitude: longitude, longitude: latitude }).is_some()
            }
            End::Zone(_) => false,
        })
    }

    /// The share of passengers that is left after this number of miles to and from vertiports.
    #[inline]
    fn share(&self, distance_mi: f64) -> f64 {
        self.decay_mi.map_or(1.0, |decay_mi| libm::exp(-distance_mi / decay_mi))
    }
}

/// The tallies of all threads. Which of them a record is added to makes no difference to their sum.
pub(super) struct Tallies<'a> {
    pub(super) rules: &'a Rules,
    idle: Mutex<Vec<Tally>>,
}

impl<'a> Tallies<'a> {
    pub(super) fn new(rules: &'a Rules) -> Self {
        Self { rules, idle: Mutex::new(Vec::new()) }
    }

    /// Lends a tally that no other thread is using. There are as many as threads have worked at
    /// once.
    pub(super) fn with<T>(&self, add: impl FnOnce(&mut Tally, &Rules) -> T) -> T {
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let lent = idle().pop();
        let mut tally = lent.unwrap_or_else(|| Tally::new(self.rules));
        let result = add(&mut tally, self.rules);
        idle().push(tally);
        result
    }

    /// The sum of all tallies.
    pub(super) fn total(&self) -> Tally {
        let mut total = Tally::new(self.rules);
        for tally in self.idle.lock().unwrap_or_else(PoisonError::into_inner).iter() {
            total.merge(tally);
        }
        total
    }
}

#[cfg(test)]
mod tests {
    use super::Hours;

    #[test]
    fn hours_begin_with_operations_and_end_before_they_do() {
        let hours = Hours { start: 6 * 3600 + 1800, end: 8 * 3600 };
        let starts: Vec<String> = hours.starts().iter().map(ToString::to_string).collect();
        assert_eq!(starts, ["06:30:00", "07:00:00"]);
        let periods = [6 * 3600, 6 * 3600 + 1800, 7 * 3600, 8 * 3600 - 1, 8 * 3600];
        assert_eq!(
            periods.map(|second| hours.period(second)),
            [None, Some(0), Some(1), Some(1), None]
        );
        let short = Hours { start: 3600, end: 3600 };
        assert_eq!((short.count(), short.starts().len(), short.period(3600)), (1, 1, None));
    }
}
