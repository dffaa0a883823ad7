//! The flights that can leave each vertiport, computed once and cached while their inputs stay the
//! same.
//!
//! A decision evaluates all pairs of vertiports four times, for different times of the day. Between
//! two decisions only the passengers of one pair change, and sometimes the demand period. So the
//! flights of a vertiport are stored with the passenger counts they were computed from. They stay
//! valid while the counts are equal and the time is within the span in which profits are
//! [steady](vertifleet_sim::Departures::steady). That holds for the day itself and for roll-outs of
//! it that took different choices.

use std::ops::Range;

use vertifleet_core::{Time, TypeIx, VertiportIx};
use vertifleet_policy::units_usd;
use vertifleet_sim::{DayKey, View};

use crate::column::hours;

/// Number of demand periods in the cache; a period replaces the one that is this many periods
/// earlier.
const PERIODS: usize = 8;
/// Largest number of vertiports in the cache over all days: those of one batch of decisions.
const MOST_VERTIPORTS: usize = 2_048;

/// The boards of the days that were evaluated recently.
#[derive(Debug, Clone, Default)]
pub(crate) struct Boards {
    days: Vec<(DayKey, Board)>,
    vertiports: usize,
}

/// The flights of a day.
#[derive(Debug, Clone)]
pub(crate) struct Board {
    vertiports: usize,
    /// The profit of a typical full flight, dollars, by type.
    units_usd: Vec<f64>,
    /// By type, demand period and vertiport.
    known: Vec<Known>,
    /// By type, demand period and pair of vertiports: the passengers that were counted, and the
    /// profit per hour of a flight in units, between 0 and 3 and 0 out of range.
    waiting: Vec<u32>,
    rates: Vec<f32>,
}

/// The flights of a vertiport, and the span of decision times for which they are valid.
#[derive(Debug, Clone)]
struct Known {
    steady: Range<Time>,
    onward: Onward,
}

/// The flights that can leave a vertiport at a time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Onward {
    /// The highest profits per hour of a flight, in units.
    pub(crate) best: [f64; 3],
    /// The passengers of the destinations that pay, in full flights, and the profit of these
    /// flights in units.
    pub(crate) flights: f64,
    pub(crate) profit: f64,
}

impl Boards {
    /// The board of a day.
    pub(crate) fn of(&mut self, view: View<'_>) -> &mut Board {
        let day = view.day();
        let known = self.days.iter().position(|(known, _)| *known == day);
        let at = known.unwrap_or_else(|| {
            if self.vertiports + view.vertiports() > MOST_VERTIPORTS {
                *self = Self::default();
            }
            self.vertiports += view.vertiports();
            self.days.push((day, Board::of(view)));
            self.days.len() - 1
        });
        &mut self.days[at].1
    }
}

impl Board {
    fn of(view: View<'_>) -> Self {
        let vertiports = view.vertiports();
        let rows = view.aircraft_types().len() * PERIODS * vertiports;
        let never = Known { steady: Time::default()..Time::default(), onward: Onward::default() };
        Self {
            vertiports,
            units_usd: units_usd(view),
            known: vec![never; rows],
            waiting: vec![0; rows * vertiports],
            rates: vec![0.0; rows * vertiports],
        }
    }

    /// The profit of a typical full flight of a type, dollars.
    pub(crate) fn unit_usd(&self, kind: TypeIx) -> f64 {
        self.units_usd[kind.at()]
    }

    /// The flights that can leave a vertiport at a time of the day.
    pub(crate) fn onward(
        &mut self,
        view: View<'_>,
        kind: TypeIx,
        from: VertiportIx,
        time: Time,
    ) -> Onward {
        if time > view.day_end() {
            return Onward::default();
        }
        let row = self.look(view, kind, from, time);
        self.known[row].onward
    }

    /// Profit per hour of a flight from a vertiport to each other one, in units, clamped to [0, 3],
    /// and 0 out of range. The values are those of the last call of [`look`](Self::look) for the
    /// vertiport, the type and the demand period.
    pub(crate) fn rates(&self, kind: TypeIx, from: VertiportIx, period: usize) -> &[f32] {
        &self.rates[self.row(kind, from, period) * self.vertiports..][..self.vertiports]
    }

    fn row(&self, kind: TypeIx, from: VertiportIx, period: usize) -> usize {
        (kind.at() * PERIODS + period % PERIODS) * self.vertiports + from.at()
    }

    /// Brings the row of a vertiport's flights up to date, and returns its index.
    pub(crate) fn look(
        &mut self,
        view: View<'_>,
        kind: TypeIx,
        from: VertiportIx,
        time: Time,
    ) -> usize {
        let count = self.vertiports;
        let period = view.period_at(time);
        let row = self.row(kind, from, period);
        let waiting = &view.demand_left_in(period)[from.at() * count..][..count];
        let counted = &mut self.waiting[row * count..][..count];
        if self.known[row].steady.contains(&time) && counted == waiting {
            return row;
        }
        counted.copy_from_slice(waiting);
        let departures = view.departures(time, kind, from);
        let unit_usd = self.units_usd[kind.at()];
        let rates = &mut self.rates[row * count..][..count];
        let mut onward = Onward::default();
        for to in view.within_range(kind, from).iter() {
            let waiting = waiting[to.at()];
            let profit = departures.profit_usd(to, waiting) / unit_usd;
            let rate = profit / hours(departures.block_s(to)).max(0.1);
            rates[to.at()] = rate.clamp(0.0, 3.0) as f32;
            onward.add(rate, profit, f64::from(waiting) / f64::from(departures.seats()));
        }
        self.known[row] =
            Known { steady: departures.steady(view.within_range(kind, from)), onward };
        row
    }
}

impl Onward {
    /// Adds a destination: the profit per hour and the profit of a flight, in units, and the number
    /// of flights.
    fn add(&mut self, mut rate: f64, profit: f64, flights: f64) {
        if rate <= 0.0 {
            return;
        }
        self.flights += flights;
        self.profit += flights * profit;
        for best in &mut self.best {
            if rate > *best {
                std::mem::swap(&mut rate, best);
            }
        }
    }
}
