//! How often a dive finds prices again, so that it ends in time.

use std::time::{Duration, Instant};

/// The tempo of a dive.
#[derive(Default)]
pub(super) struct Tempo {
    /// When the dive should end; `None` if its time is not limited.
    until: Option<Instant>,
    pub(super) planning: Spent,
    pub(super) pricing: Spent,
    /// The part of a search for prices that is due.
    due: f64,
}

/// The time that one kind of work has taken.
#[derive(Default)]
pub(super) struct Spent {
    times: u32,
    took: Duration,
}

impl Tempo {
    pub(super) fn until(until: Option<Instant>) -> Self {
        Self { until, ..Self::default() }
    }

    /// Whether prices should be found again when `left` aircraft are left: after each if there is
    /// time for that, and otherwise after every few.
    pub(super) fn is_time_to_price(&mut self, left: usize) -> bool {
        if left == 0 {
            return false;
        }
        let Some(until) = self.until else { return true };
        let left = left as f64;
        let spare_s = seconds_until(until) - left * self.planning.mean_s();
        self.due += (spare_s / (left * self.pricing.mean_s())).clamp(0.0, 1.0);
        let is_due = self.due >= 1.0;
        self.due -= f64::from(u8::from(is_due));
        is_due
    }
}

impl Spent {
    /// Does a piece of work and counts its time.
    pub(super) fn time<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let begun = Instant::now();
        let done = work();
        self.took += begun.elapsed();
        self.times += 1;
        done
    }

    fn mean_s(&self) -> f64 {
        self.took.as_secs_f64() / f64::from(self.times.max(1))
    }
}

/// Seconds until a time, 0 if it has passed.
pub(super) fn seconds_until(time: Instant) -> f64 {
    time.saturating_duration_since(Instant::now()).as_secs_f64()
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::{Spent, Tempo};

    /// After how many of 12 aircraft prices are found again, within a number of seconds, if
    /// planning an aircraft takes one and finding prices takes 10. The numbers are large enough for
    /// the time of the test itself to make no difference.
    fn times_priced(seconds: u64) -> usize {
        let spent = |s: u64| Spent { times: 1, took: Duration::from_secs(1_000 * s) };
        let until = |left_s: u64| Some(Instant::now() + Duration::from_secs(1_000 * left_s));
        let mut tempo = Tempo { planning: spent(1), pricing: spent(10), ..Tempo::default() };
        let mut left_s = seconds;
        let priced = (0..12_usize).rev().filter(|&left| {
            left_s = left_s.saturating_sub(1);
            tempo.until = until(left_s);
            let is_time = tempo.is_time_to_price(left);
            left_s = left_s.saturating_sub(if is_time { 10 } else { 0 });
            is_time
        });
        priced.count()
    }

    #[test]
    fn prices_are_found_as_often_as_there_is_time() {
        assert_eq!(times_priced(1_000), 11, "after each aircraft but the last");
        assert!((4..=6).contains(&times_priced(70)), "{}", times_priced(70));
        assert_eq!(times_priced(5), 0, "there is time to plan only");
    }

    #[test]
    fn without_a_limit_prices_are_found_after_each_aircraft_but_the_last() {
        let mut tempo = Tempo::default();
        let priced = (0..5).rev().filter(|&left| tempo.is_time_to_price(left));
        assert_eq!(priced.count(), 4);
    }
}
