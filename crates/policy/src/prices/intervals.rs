//! The day cut into intervals. Within an interval the same flights may leave, with the same profit:
//! intervals are demand periods, cut once more where known closures begin and end.

use std::ops::Range;

use vertifleet_core::{ClosedTimes, Time, VertiportIx};
use vertifleet_sim::View;

use super::clock::Clock;

/// A run of slots in one demand period.
#[derive(Debug, Clone, Copy)]
pub(super) struct Interval {
    /// Its demand period.
    pub(super) period: usize,
    /// Start of its first slot. A route that is known to be closed then is closed at the start of
    /// each of its slots.
    begin: Time,
}

impl Interval {
    /// Whether a route is known to be closed in this interval.
    #[inline]
    pub(super) fn is_closed(
        &self,
        known: &ClosedTimes,
        from: VertiportIx,
        to: VertiportIx,
    ) -> bool {
        known.is_closed(from, to, self.begin)
    }
}

/// The intervals of a day, in order.
#[derive(Debug, Clone)]
pub(super) struct Intervals {
    pub(super) all: Vec<Interval>,
    /// The interval of each slot.
    pub(super) of_slot: Vec<usize>,
    /// By demand period, and at the end for the time after the last one: the first interval in
    /// which it, or a later one, is in force.
    begins: Vec<usize>,
}

impl Intervals {
    pub(super) fn of(view: View<'_>, clock: &Clock) -> Self {
        let changes = view.known_closures().changes();
        let of_slot = Vec::with_capacity(clock.slots);
        let mut intervals = Self { all: Vec::new(), of_slot, begins: Vec::new() };
        let mut past = 0;
        for slot in 0..clock.slots {
            let begin = Time::from_seconds(clock.begin_s(slot));
            let period = view.period_at(begin);
            let new = changes[past..].iter().take_while(|&&change| change <= begin).count();
            past += new;
            if new > 0 || intervals.all.last().is_none_or(|last| last.period != period) {
                intervals.all.push(Interval { period, begin });
            }
            intervals.of_slot.push(intervals.all.len() - 1);
        }
        let first_of = |period| intervals.all.partition_point(|interval| interval.period < period);
        intervals.begins = (0..=view.period_starts().len()).map(first_of).collect();
        intervals
    }

    /// The first interval in which a demand period, or a later one, is in force.
    pub(super) fn first_of(&self, period: usize) -> usize {
        self.begins[period]
    }

    /// The intervals of a demand period.
    #[inline]
    pub(super) fn of_period(&self, period: usize) -> Range<usize> {
        self.begins[period]..self.begins[period + 1]
    }
}
