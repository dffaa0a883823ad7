//! Which demand period the passengers of a played day come from, for accounts by period.

use vertifleet_core::{Matrix, Scenario, Time};

use crate::TraceRow;

/// Follows the flights of a day in the order of their decisions. On days whose passengers wait into
/// the next period, a flight takes those who have waited first.
#[derive(Debug, Clone)]
pub struct Boarded<'a> {
    day: &'a Scenario,
    left: Vec<Matrix<u32>>,
}

impl<'a> Boarded<'a> {
    /// The day before its first flight.
    pub fn of(day: &'a Scenario) -> Self {
        Self { day, left: day.demand.clone() }
    }

    /// Takes the passengers of the next decision, and returns how many of them wanted to fly in
    /// which period: those who have waited since the period before, and those of this period.
    pub fn board(&mut self, row: &TraceRow) -> [(usize, u16); 2] {
        let (period, pair) = (self.day.period_at(row.time), (row.from, row.to));
        let before = self.waiting_in(row.time);
        let waited = before.map_or(0, |before| {
            let left = &mut self.left[before][pair];
            let waited =
                u16::try_from(*left).map_or(row.passengers, |left| left.min(row.passengers));
            *left -= u32::from(waited);
            waited
        });
        let left = &mut self.left[period][pair];
        *left = left.saturating_sub(u32::from(row.passengers - waited));
        [(before.unwrap_or(period), waited), (period, row.passengers - waited)]
    }

    /// Passengers who want to fly at a time and have not been carried by the flights so far, of all
    /// periods that count then.
    pub fn waiting(&self, time: Time) -> impl Iterator<Item = &Matrix<u32>> {
        let periods = self.waiting_in(time).into_iter().chain([self.day.period_at(time)]);
        periods.map(|period| &self.left[period])
    }

    /// The period whose passengers still wait in the next one at a time, if there is one.
    fn waiting_in(&self, time: Time) -> Option<usize> {
        let period = self.day.period_at(time);
        let gone = self.day.periods[period] + self.day.operations.passenger_wait_s;
        period.checked_sub(1).filter(|_| time < gone)
    }
}
