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

    /// Whether prices should be found again now that so many aircraft are left: after each if there is time for that, and
    /// otherwise after every few.
    pub(super) fn is_time_to_price(&mut self, left: usize) -> bool {
        let Some(until) = self.until else { return left > 0 };
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
