//! `random`: Feas-RND (§V.B), uniform over the feasible choices, hold included.

use vertifleet_core::VertiportIx;
use vertifleet_sim::{Decision, View};

use crate::{Policy, PolicyError, draw};

/// Draws uniformly from the mask.
///
/// The draw is a function of the policy's seed, the day's seed and the number of the decision. It
/// needs no memory, and does not depend on how days are batched.
#[derive(Debug, Clone, Copy)]
pub struct Random {
    seed: u64,
}

impl Random {
    /// A policy that draws by `seed`.
    pub fn new(seed: u64) -> Self {
        Self { seed }
    }
}

impl Policy for Random {
    #[inline]
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let mask = view.feasible(decision);
        // The upper half of the product spreads 2^64 draws evenly; with at most 257 outcomes the
        // bias is below 2^-55.
        let draw = u128::from(draw(self.seed, view.day_seed(), decision.index));
        #[expect(
            clippy::cast_possible_truncation,
            reason = "below the number of feasible vertiports"
        )]
        let rank = ((draw * u128::from(mask.len())) >> 64) as u32;
        Ok(mask.nth(rank).expect("the rank is below the number of members, and hold is always one"))
    }
}
