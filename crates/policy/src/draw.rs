//! Random draws without state: each is a function of seed, day and decision, so days may be played
//! in any order and batch.

use rand::{Rng, SeedableRng};
use rand_xoshiro::SplitMix64;

/// 64 random bits that belong to one decision of one day of one run.
#[inline]
pub fn draw(seed: u64, day: u64, decision: u32) -> u64 {
    Draws::of(seed, day).bits(decision)
}

/// The random draws of one day of one run, for several of its decisions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Draws {
    of_day: u64,
}

impl Draws {
    pub(crate) fn of(seed: u64, day: u64) -> Self {
        Self { of_day: scramble(scramble(seed) ^ day) }
    }

    #[inline]
    pub(crate) fn bits(self, decision: u32) -> u64 {
        scramble(self.of_day ^ u64::from(decision))
    }
}

#[inline]
fn scramble(state: u64) -> u64 {
    SplitMix64::seed_from_u64(state).next_u64()
}
