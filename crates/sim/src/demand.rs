//! Passengers who still want to fly, per demand period and pair of vertiports.

use std::borrow::Cow;

use vertifleet_core::{Matrix, Scenario, VertiportIx};

use crate::room::clone_into_room;

/// The known demand of the rest of the day: actual demand in periods that have begun,
/// and the forecast in later ones. A flight takes its passengers at the moment it is decided.
///
/// On days whose passengers wait, those who are left when a period ends are counted in the next
/// period from then on, until they leave ([`Demand::leave`]). Every passenger is counted in one
/// period at every moment.
#[derive(Debug)]
pub(crate) struct Demand {
    vertiports: usize,
    /// Those who can still be carried in a period, by period, then from, then to.
    left: Vec<u32>,
    /// How many of them have waited since the period before, by from, then to. Empty if passengers
    /// of the day never wait.
    waiting: Vec<u32>,
    /// The period in which they wait now, if they have not left.
    waiting_in: Option<usize>,
    total: u64,
}

clone_into_room!(Demand { vertiports, left, waiting, waiting_in, total });

impl Demand {
    /// The demand of a day before its first flight.
    pub(crate) fn of(scenario: &Scenario) -> Self {
        let known = scenario.disturbances.forecast.as_ref().unwrap_or(&scenario.demand);
        // The tables are copied one by one, because they are most of what a new day has to copy.
        let left: Vec<u32> = known.iter().map(Matrix::cells).collect::<Vec<_>>().concat();
        let sum = |table: &Matrix<u32>| {
            table.cells().iter().map(|&passengers| u64::from(passengers)).sum::<u64>()
        };
        let total = scenario.demand.iter().map(sum).sum();
        let vertiports = scenario.vertiports.len();
        let pairs = if scenario.operations.passenger_wait_s > 0 { vertiports.pow(2) } else { 0 };
        let waiting = vec![0; pairs];
        let mut demand = Self { vertiports, left, waiting, waiting_in: None, total };
        demand.reveal(0, &scenario.demand[0]);
        demand
    }

    /// Makes the actual demand of a period known that begins.
    pub(crate) fn reveal(&mut self, period: usize, actual: &Matrix<u32>) {
        let pairs = self.vertiports * self.vertiports;
        self.left[period * pairs..][..pairs].copy_from_slice(actual.cells());
    }

    /// Lets those who are left of the period before a period wait in it, if passengers of the day
    /// wait.
    pub(crate) fn wait_in(&mut self, period: usize) {
        if self.waiting.is_empty() {
            return;
        }
        for (waiting, before, now) in self.pairs_of(period) {
            *waiting = std::mem::take(before);
            *now += *waiting;
        }
        self.waiting_in = Some(period);
    }

    /// Lets those who have waited leave, and returns whether any passenger could have waited. They
    /// are counted in their own period again, whose passengers cannot be carried any more.
    pub(crate) fn leave(&mut self) -> bool {
        let Some(period) = self.waiting_in.take() else { return false };
        for (waiting, before, now) in self.pairs_of(period) {
            *now -= *waiting;
            *before += std::mem::take(waiting);
        }
        true
    }

    /// The numbers of each pair: who waits, and who is counted in the period before a period and in
    /// that period.
    fn pairs_of(&mut self, period: usize) -> impl Iterator<Item = (&mut u32, &mut u32, &mut u32)> {
        let pairs = self.waiting.len();
        let (before, now) = self.left[(period - 1) * pairs..].split_at_mut(pairs);
        let periods = before.iter_mut().zip(now);
        self.waiting.iter_mut().zip(periods).map(|(waiting, (before, now))| (waiting, before, now))
    }

    /// The period in which passengers of the one before it wait now, if any can.
    #[inline]
    pub(crate) fn waiting_in(&self) -> Option<usize> {
        self.waiting_in
    }

    /// The position of a pair of a period.
    #[inline]
    pub(crate) fn at(&self, period: usize, from: VertiportIx, to: VertiportIx) -> usize {
        (period * self.vertiports + from.at()) * self.vertiports + to.at()
    }

    /// Passengers who can still be carried from one vertiport to another in a period, those who
    /// wait among them.
    #[inline]
    pub(crate) fn left(&self, period: usize, from: VertiportIx, to: VertiportIx) -> u32 {
        self.left[self.at(period, from, to)]
    }

    /// All pairs of a period, `[from][to]` row by row.
    #[inline]
    pub(crate) fn period(&self, period: usize) -> &[u32] {
        let pairs = self.vertiports * self.vertiports;
        &self.left[period * pairs..][..pairs]
    }

    /// Takes as many passengers as want to fly and fit in `seats`, first those who have waited, and
    /// returns their number.
    #[inline]
    pub(crate) fn board(
        &mut self,
        period: usize,
        from: VertiportIx,
        to: VertiportIx,
        seats: u16,
    ) -> u16 {
        let at = self.at(period, from, to);
        let left = &mut self.left[at];
        let boarded = u16::try_from(*left).map_or(seats, |left| left.min(seats));
        *left -= u32::from(boarded);
        if let Some(waiting) = self.waiting.get_mut(from.at() * self.vertiports + to.at()) {
            *waiting = waiting.saturating_sub(u32::from(boarded));
        }
        boarded
    }

    /// Number of passengers of the whole day, before the first flight.
    pub(crate) fn total(&self) -> u64 {
        self.total
    }
}

/// Queries and changes by the reports of a live day: passengers by the period in which they wanted
/// to fly, wherever they are counted now.
impl Demand {
    /// How many passengers of a pair have waited since the period before.
    pub(crate) fn waiting(&self, from: VertiportIx, to: VertiportIx) -> u32 {
        self.waiting.get(from.at() * self.vertiports + to.at()).copied().unwrap_or(0)
    }

    /// Whether the passengers of a period wait in the next one now.
    pub(crate) fn waits(&self, period: usize) -> bool {
        self.waiting_in == Some(period + 1)
    }

    /// Passengers of a period who still want to fly.
    pub(crate) fn own(&self, period: usize, from: VertiportIx, to: VertiportIx) -> u32 {
        if self.waits(period) {
            return self.waiting(from, to);
        }
        let waiting = if self.waiting_in == Some(period) { self.waiting(from, to) } else { 0 };
        self.left(period, from, to) - waiting
    }

    /// The same for all pairs of all periods: by period, then from, then to.
    pub(crate) fn all_own(&self) -> Cow<'_, [u32]> {
        if self.waiting_in.is_none() {
            return Cow::Borrowed(&self.left);
        }
        let mut without_waiting = self.clone();
        without_waiting.leave();
        Cow::Owned(without_waiting.left)
    }

    /// Sets how many passengers of a period still want to fly.
    pub(crate) fn set_own(&mut self, period: usize, from: VertiportIx, to: VertiportIx, own: u32) {
        let before = self.own(period, from, to);
        let counted_in = if self.waits(period) { period + 1 } else { period };
        let at = self.at(counted_in, from, to);
        self.left[at] = self.left[at] - before + own;
        if self.waits(period) {
            self.waiting[from.at() * self.vertiports + to.at()] = own;
        }
    }

    /// Number of pairs of vertiports in all periods.
    pub(crate) fn cells(&self) -> usize {
        self.left.len()
    }

    /// Recounts the passengers of the whole day: those who still want to fly, and those who
    /// have.
    pub(crate) fn set_total(&mut self, boarded: &[u32]) {
        self.total = self.left.iter().chain(boarded).map(|&passengers| u64::from(passengers)).sum();
    }
}
