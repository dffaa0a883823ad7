//! Time slices: the day's take-off times cut into short intervals, within each of which prices are
//! constant.
//!
//! Every take-off time, up to and including the end of operations, is in exactly one slice. A new
//! slice begins wherever a demand period or a slot of take-off delays begins, so that a slice lies
//! in one period and one slot, and where those leave who have waited since the period before, so
//! that they can be carried in all of a slice or in none of it.

use vertifleet_core::{Scenario, Time};

/// The slices of a day, in order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Slices {
    /// First second of each slice, and at the end the second after the last take-off time, which
    /// belongs to no slice.
    starts_s: Vec<u32>,
    /// The demand period of each slice.
    periods: Vec<usize>,
    /// Whether passengers of the period before wait in each slice.
    wait: Vec<bool>,
}

impl Slices {
    /// Cuts a day into slices of at most `step_s` seconds, which must be at least 1.
    pub(super) fn of(scenario: &Scenario, step_s: u32) -> Self {
        let first_s = scenario.operations.start.seconds();
        let past_s = scenario.operations.end.seconds() + 1;
        let periods_s = scenario.periods.iter().map(|period| period.seconds());
        let delays = scenario.disturbances.takeoff_delays.iter();
        let slots_s = delays.flat_map(|delays| (first_s..past_s).step_by(delays.slot_s as usize));
        let wait_s = scenario.operations.passenger_wait_s;
        let waited_s = periods_s.clone().skip(1).map(|period_s| period_s + wait_s);
        let mut cuts_s: Vec<u32> =
            periods_s.chain(waited_s).chain(slots_s).chain([past_s]).collect();
        cuts_s.retain(|&cut_s| first_s < cut_s && cut_s <= past_s);
        cuts_s.sort_unstable();
        cuts_s.dedup();

        let (mut starts_s, mut periods, mut wait) = (Vec::new(), Vec::new(), Vec::new());
        let mut from_s = first_s;
        for cut_s in cuts_s {
            let period = scenario.period_at(Time::from_seconds(from_s));
            let begins_s = scenario.periods[period].seconds();
            for start_s in (from_s..cut_s).step_by(step_s as usize) {
                starts_s.push(start_s);
                periods.push(period);
                wait.push(period > 0 && start_s < begins_s + wait_s);
            }
            from_s = cut_s;
        }
        starts_s.push(past_s);
        Self { starts_s, periods, wait }
    }

    /// The same slices on a clock that only ticks every `tick_s` seconds, from 0 on. Slices shorter
    /// than a tick may be empty there.
    pub(super) fn on_coarse_clock(&self, tick_s: u32) -> Self {
        let first_s = self.start_s(0);
        let starts_s = self.starts_s.iter().map(|start_s| (start_s - first_s).div_ceil(tick_s));
        Self {
            starts_s: starts_s.collect(),
            periods: self.periods.clone(),
            wait: self.wait.clone(),
        }
    }

    /// Number of slices, at least 1.
    pub(super) fn len(&self) -> usize {
        self.periods.len()
    }

    /// Seconds from the first take-off time to the last, both included.
    pub(super) fn day_s(&self) -> u32 {
        self.start_s(self.len()) - self.start_s(0)
    }

    /// First second of a slice. For the slice past the last one, it is the second after the last
    /// take-off time.
    pub(super) fn start_s(&self, slice: usize) -> u32 {
        self.starts_s[slice]
    }

    /// Last second of a slice.
    pub(super) fn last_s(&self, slice: usize) -> u32 {
        self.starts_s[slice + 1] - 1
    }

    /// The demand period in which a slice lies.
    pub(super) fn period(&self, slice: usize) -> usize {
        self.periods[slice]
    }

    /// Whether passengers of the period before can still be carried in a slice.
    pub(super) fn wait(&self, slice: usize) -> bool {
        self.wait[slice]
    }

    /// The slice that contains a time. It is the first one for earlier times, and [`Slices::len`]
    /// past the last take-off time.
    pub(super) fn containing(&self, time_s: u32) -> usize {
        self.starts_s.partition_point(|&start_s| start_s <= time_s).saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use vertifleet_core::{DaySeed, Network, Scenario, Time};

    use super::Slices;

    fn waiting(day: &Scenario, wait_s: u32) -> Scenario {
        let mut day = day.clone().into_day();
        day.operations.passenger_wait_s = wait_s;
        day.check("waiting").expect("periods of an hour")
    }

    #[test]
    fn every_take_off_time_is_in_one_slice_and_every_slice_in_one_period() {
        let day = Network::shipped("paper").expect("a shipped day");
        let day = waiting(&day.draw(DaySeed::comparison(1).expect("a seed")), 700);
        for step_s in [60, 300, 420, 3_600] {
            let slices = Slices::of(&day, step_s);
            assert_eq!(slices.day_s(), 12 * 3600 + 1, "18:00:00 is a take-off time");
            assert_eq!(slices.last_s(slices.len() - 1), 18 * 3600);
            for slice in 0..slices.len() {
                let (first_s, last_s) = (slices.start_s(slice), slices.last_s(slice));
                assert!((1..=step_s).contains(&(last_s + 1 - first_s)));
                for time_s in [first_s, last_s] {
                    assert_eq!(slices.containing(time_s), slice);
                    let time = Time::from_seconds(time_s);
                    let period = day.period_at(time);
                    assert_eq!(period, slices.period(slice));
                    let waits = period > 0 && time < day.periods[period] + 700;
                    assert_eq!(waits, slices.wait(slice), "at {time}");
                }
            }
            assert_eq!(slices.containing(18 * 3600 + 1), slices.len());
        }
    }
}
