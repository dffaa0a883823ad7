//! The day's stand prices in the form that the search reads fastest.

use vertifleet_core::{Time, VertiportIx};
use vertifleet_policy::DayPrices;

use super::day::Day;

const MINUTE_S: u32 = 60;

/// Prices of stands over time as running sums, so that the rent of any stay is one subtraction. Rents guide the search
/// and prove no bound.
#[derive(Debug, Clone)]
pub(super) struct StandPrices {
    origin_s: u32,
    minutes: usize,
    /// By vertiport, then minute: the price of a stand from the first minute until then, dollars.
    until_usd: Vec<f64>,
}

impl StandPrices {
    /// Prices from `origin`, the time for which they were found, to the end of the day.
    pub(super) fn of(day: &Day, prices: &DayPrices, origin: Time) -> Self {
        let minutes = ((day.end_s - origin.seconds()) / MINUTE_S + 1) as usize;
        let mut until_usd = Vec::with_capacity(day.vertiports * (minutes + 1));
        for vertiport in VertiportIx::all(day.vertiports) {
            let times = (origin.seconds()..).step_by(MINUTE_S as usize).take(minutes + 1);
            until_usd
                .extend(times.map(|until_s| {
                    prices.rent_usd(vertiport, origin, Time::from_seconds(until_s))
                }));
        }
        Self { origin_s: origin.seconds(), minutes, until_usd }
    }

    /// The minute of a time, as [`rent_usd`](Self::rent_usd) takes it. Times outside the prices are free.
    #[inline]
    pub(super) fn minute(&self, time_s: u32) -> usize {
        ((time_s.saturating_sub(self.origin_s) / MINUTE_S) as usize).min(self.minutes)
    }

    /// Price of a stand between two minutes, dollars.
    #[inline]
    pub(super) fn rent_usd(&self, vertiport: VertiportIx, from: usize, until: usize) -> f64 {
        let row = &self.until_usd[vertiport.at() * (self.minutes + 1)..][..=self.minutes];
        row[until] - row[from]
    }
}
