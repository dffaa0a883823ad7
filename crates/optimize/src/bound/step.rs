//! How finely a bound divides the day into slices of time, and batteries into levels of charge.

use vertifleet_core::{Charging, Scenario};

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

/// All numbers of levels of charge above 1, from the fewest. The fewest are the default, because
/// more take long: the bound of `paper-quick` is 3.5 % lower with 64, that of `new-york-quick`
/// 0.5 %, in 11 to 15 times the time.
pub(super) const LEVELS: [u16; 4] = [4, 8, 16, 64];

/// All steps, from the longest to the shortest.
pub(super) const STEPS: [Step; 5] = [
    Step { minutes: 60, levels: LEVELS[0] },
    Step { minutes: 15, levels: LEVELS[0] },
    Step { minutes: 5, levels: LEVELS[0] },
    Step { minutes: 3, levels: LEVELS[0] },
    Step { minutes: 1, levels: LEVELS[0] },
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

    /// The same step with more levels of charge than the default of 4 on days that charge as
    /// needed: 4, 8, 16 or 64, the most of these that are no more than `levels`. More levels never
    /// give a looser bound, and take longer.
    ///
    /// # Errors
    /// [`Error::Levels`] unless `levels` is from 4 to 64.
    pub fn with_levels(self, levels: u16) -> Result<Self, Error> {
        let most = *LEVELS.last().expect("there are some");
        let allowed = LEVELS.into_iter().rev().find(|&allowed| allowed <= levels);
        let levels = allowed.filter(|_| levels <= most).ok_or(Error::Levels { found: levels })?;
        Ok(Self { levels, ..self })
    }

    /// The most levels of charge of a day: 1 if it charges to full.
    pub(super) fn most_levels(self, scenario: &Scenario) -> u16 {
        if scenario.operations.charging == Charging::AsNeeded { self.levels } else { 1 }
    }

    /// The length of the slices, seconds.
    pub fn seconds(self) -> u32 {
        60 * self.minutes
    }
}

impl Default for Step {
    /// A step of 5 minutes.
    fn default() -> Self {
        Self { minutes: 5, levels: LEVELS[0] }
    }
}
