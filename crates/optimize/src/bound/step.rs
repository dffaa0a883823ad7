//! How finely a bound divides the day into slices of time, and batteries into levels of charge.

use vertifleet_core::{Charging, Scenario};

use super::time_expanded_day::TimeExpandedDay;
use crate::Error;

/// The longest time over which prices stay the same: a whole number of minutes from 1 to 60. A
/// shorter step never gives a looser bound, and takes longer.
///
/// Slices of time have 60, 15, 5, 3 or 1 minutes: the longest of these that is no longer than the
/// requested step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    pub(super) minutes: u32,
    /// The most levels of charge, on days that charge as needed.
    pub(super) levels: u16,
}

/// All numbers of levels of charge above 1, from the fewest.
pub(super) const LEVELS: [u16; 3] = [4, 16, MOST_LEVELS];
/// The default. With 64 levels the bound of `new-york-quick` is 0.5 % lower than with 4, and that
/// of `paper-quick` 3.5 %. Twice as many would lower the former by another 0.2 %, in twice the time
/// and memory.
const MOST_LEVELS: u16 = 64;

/// All steps, from the longest to the shortest.
pub(super) const STEPS: [Step; 5] = [
    Step { minutes: 60, levels: MOST_LEVELS },
    Step { minutes: 15, levels: MOST_LEVELS },
    Step { minutes: 5, levels: MOST_LEVELS },
    Step { minutes: 3, levels: MOST_LEVELS },
    Step { minutes: 1, levels: MOST_LEVELS },
];

impl Step {
    /// A step in which prices stay the same for at most `minutes`.
    ///
    /// # Errors
    /// [`Error::Step`] unless `minutes` is from 1 to 60.
    pub fn from_minutes(minutes: u32) -> Result<Self, Error> {
        let step = STEPS.into_iter().find(|step| step.minutes <= minutes);
        step.filter(|_| minutes <= 60).ok_or(Error::Step { found: minutes })
    }

    /// The same step with no more than some levels of charge on days that charge as needed: 4, 16
    /// or 64, the most of these that are no more than `levels` and for which the day is not too
    /// large. Slices of 60 minutes always have one level, those of 15 minutes at most 16. More
    /// levels never give a looser bound, and take longer.
    ///
    /// # Errors
    /// [`Error::Levels`] unless `levels` is from 4 to 64.
    pub fn with_levels(self, levels: u16) -> Result<Self, Error> {
        let allowed = LEVELS.into_iter().rev().find(|&allowed| allowed <= levels);
        let allowed = allowed.filter(|_| levels <= MOST_LEVELS);
        let levels = allowed.ok_or(Error::Levels { found: levels })?;
        Ok(Self { levels, ..self })
    }

    /// The numbers of levels of charge with which a day is searched, one after the other: 1 if it
    /// charges to full, or is too large for more.
    pub(super) fn all_levels(self, scenario: &Scenario) -> &'static [u16] {
        let as_needed = scenario.operations.charging == Charging::AsNeeded;
        let fits = |&levels: &u16| {
            levels <= self.levels && TimeExpandedDay::fits(scenario, self.seconds(), levels).is_ok()
        };
        match LEVELS.iter().take_while(|levels| as_needed && fits(levels)).count() {
            0 => &[1],
            number => &LEVELS[..number],
        }
    }

    /// The length of the slices, seconds.
    pub fn seconds(self) -> u32 {
        60 * self.minutes
    }
}

impl Default for Step {
    /// A step of 5 minutes.
    fn default() -> Self {
        Self { minutes: 5, levels: MOST_LEVELS }
    }
}

#[cfg(test)]
mod tests {
    use vertifleet_core::{DaySeed, Network};

    use super::*;

    #[test]
    fn a_large_day_has_fewer_levels_the_finer_its_slices() {
        let network = Network::shipped("large").expect("a shipped network");
        let mut day = network.draw(DaySeed::comparison(1).expect("a seed")).into_day();
        let levels = |minutes: u32, day: &Scenario| {
            Step::from_minutes(minutes).expect("a step").all_levels(day)
        };
        let to_full = day.clone().check("large").expect("a day");
        day.operations.charging = Charging::AsNeeded;
        let as_needed = day.check("large").expect("a day");
        assert_eq!(levels(15, &to_full), [1]);
        // 64 levels would take more than 200 million places. In slices of 3 minutes 16 levels, and
        // in those of a minute 4, would take more than 20 million flights.
        assert_eq!(levels(15, &as_needed), [4, 16]);
        assert_eq!(levels(3, &as_needed), [4]);
        assert_eq!(levels(1, &as_needed), [1]);
    }
}
