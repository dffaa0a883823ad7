//! Passengers who still wait, per demand period and pair of vertiports.

use vertifleet_core::{Matrix, Scenario, VertiportIx};

use crate::room::clone_into_room;

/// The rest of the day's demand as far as it is known: actual demand in periods that have begun, and the forecast in
/// later ones. A flight takes its passengers at the moment it is decided.
#[derive(Debug)]
pub(crate) struct Demand {
    vertiports: usize,
    /// By period, then from, then to.
    left: Vec<u32>,
    total: u64,
}

clone_into_room!(Demand { vertiports, left, total });

impl Demand {
    /// The demand of a day before its first flight.
    pub(crate) fn of(scenario: &Scenario) -> Self {
        let known = scenario.disturbances.forecast.as_ref().unwrap_or(&scenario.demand);
        // The tables are copied one by one, because they are most of what a new day has to copy.
        let left: Vec<u32> = known.iter().map(Matrix::cells).collect::<Vec<_>>().concat();
        let sum = |table: &Matrix<u32>| {
            table.cells().iter().map(|&waiting| u64::from(waiting)).sum::<u64>()
        };
        let total = scenario.demand.iter().map(sum).sum();
        let mut demand = Self { vertiports: scenario.vertiports.len(), left, total };
        demand.begin(0, &scenario.demand[0]);
        demand
    }

    /// Begins a period, whose actual demand is known from now on.
    pub(crate) fn begin(&mut self, period: usize, actual: &Matrix<u32>) {
        let pairs = self.vertiports * self.vertiports;
        self.left[period * pairs..][..pairs].copy_from_slice(actual.cells());
    }

    /// The position of a pair of a period.
    #[inline]
    pub(crate) fn at(&self, period: usize, from: VertiportIx, to: VertiportIx) -> usize {
        (period * self.vertiports + from.at()) * self.vertiports + to.at()
    }

    /// Passengers who still want to fly from one vertiport to another in a period.
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

    /// Takes as many passengers as want to fly and fit in `seats`, and returns their number.
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
        boarded
    }

    /// Passengers who still want to fly, of all periods and pairs: by period, then from, then to.
    pub(crate) fn all(&self) -> &[u32] {
        &self.left
    }

    /// Sets how many passengers still want to fly.
    pub(crate) fn set(&mut self, period: usize, from: VertiportIx, to: VertiportIx, left: u32) {
        let at = self.at(period, from, to);
        self.left[at] = left;
    }

    /// Counts the passengers of the whole day anew: those who still want to fly, and those who have.
    pub(crate) fn set_total(&mut self, boarded: &[u32]) {
        self.total = self.left.iter().chain(boarded).map(|&passengers| u64::from(passengers)).sum();
    }

    /// Number of passengers of the whole day, before the first flight.
    pub(crate) fn total(&self) -> u64 {
        self.total
    }
}
