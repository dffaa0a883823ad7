//! How finely a bound divides the day into slices of time.

use crate::Error;

/// The longest time over which prices stay the same: a whole number of minutes from 1 to 60. A
/// shorter step never gives a looser bound, and takes longer.
///
/// Slices of time have 60, 15, 5, 3 or 1 minutes: the longest of these that is no longer than the
/// requested step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    pub(super) minutes: u32,
}

/// All steps, from the longest to the shortest.
pub(super) const STEPS: [Step; 5] = [
    Step { minutes: 60 },
    Step { minutes: 15 },
    Step { minutes: 5 },
    Step { minutes: 3 },
    Step { minutes: 1 },
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

    /// The length of the slices, seconds.
    pub fn seconds(self) -> u32 {
        60 * self.minutes
    }
}

impl Default for Step {
    /// A step of 5 minutes.
    fn default() -> Self {
        Self { minutes: 5 }
    }
}
