//! Random draws without state: each is a function of seed, day and decision, so days may be played in any order and
//! batch.

use rand::{Rng, SeedableRng};
use rand_xoshiro::SplitMix64;

/// 64 random bits that belong to one decision of one day of one run.
#[inline]
pub fn draw(seed: u64, day: u64, decision: u32) -> u64 {
    let scramble = |state: u64| SplitMix64::seed_from_u64(state).next_u64();
    scramble(scramble(scramble(seed) ^ day) ^ u64::from(decision))
}
