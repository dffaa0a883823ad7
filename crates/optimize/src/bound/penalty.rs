//! The penalty for knowing the future: the payment of an aircraft that comes into a slot of
//! take-off delays and knows these delays.
//!
//! A bound of a day that is known in full is above the profit of any policy that learns of delays
//! only as they come. A penalty takes back the worth of that knowledge (D. Brown, J. Smith, P. Sun,
//! *Information relaxations and duality in stochastic dynamic programs*, Operations Research 58,
//! 2010). With any function v of an aircraft's place and time and of the delay there, an aircraft
//! that will decide next at vertiport j at time t, in a slot that it did not decide in before, pays
//!
//! ```text
//! v(j, t, delay of the slot at j)  -  mean of v(j, t, .) over the delays that may be drawn
//! ```
//!
//! The mean of this payment is zero for every policy that does not know a slot's delays before the
//! slot begins, because where its aircraft are by then does not depend on them. So the mean over
//! days of the bounds with penalty is no lower than the mean profit of such a policy;
//! docs/src/concepts/bound.md has the proof. It holds for any v; a good one is near the true worth.
//! `penalty/worths.rs` works one out on the day that the forecast expects, at its prices.

pub(super) mod worths;

use vertifleet_core::TypeIx;

/// The payments of aircraft that come into a slot, on the clock of a time-expanded day.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Penalty {
    /// The aircraft types in the order of the payments.
    kinds: Vec<TypeIx>,
    vertiports: usize,
    /// The first second of each slot, counted from the first take-off time, and the second after
    /// the last one.
    slots_s: Vec<u32>,
    /// By type, vertiport, second: the payment of an aircraft that decides then, and before in an
    /// earlier slot; micro-dollars, rounded down.
    micro_usd: Vec<i64>,
}

impl Penalty {
    /// The same on a clock that only ticks every `tick_s` seconds.
    pub(super) fn on_coarse_clock(&self, tick_s: u32) -> Self {
        let coarsely = |second: &u32| second.div_ceil(tick_s);
        let rows = self.micro_usd.chunks_exact(self.day_s());
        Self {
            kinds: self.kinds.clone(),
            vertiports: self.vertiports,
            slots_s: self.slots_s.iter().map(coarsely).collect(),
            micro_usd: rows.flat_map(|row| row.iter().step_by(tick_s as usize)).copied().collect(),
        }
    }

    /// The payments of aircraft of a type that decide at a vertiport, by second.
    pub(super) fn at(&self, kind: TypeIx, vertiport: usize) -> &[i64] {
        let kind = self.kinds.iter().position(|&one| one == kind);
        let kind = kind.expect("the expected day has the same fleet");
        &self.micro_usd[(kind * self.vertiports + vertiport) * self.day_s()..][..self.day_s()]
    }

    /// The first second after the slot that contains one.
    pub(super) fn past_slot(&self, second: usize) -> usize {
        let slot = self.slots_s.partition_point(|&start_s| start_s as usize <= second);
        self.slots_s.get(slot).map_or(usize::MAX, |&past_s| past_s as usize)
    }

    /// Payments of nothing on a day of some types and vertiports that is one slot.
    #[cfg(test)]
    pub(super) fn of_nothing(kinds: Vec<TypeIx>, vertiports: usize, day_s: u32) -> Self {
        let micro_usd = vec![0; kinds.len() * vertiports * day_s as usize];
        Self { kinds, vertiports, slots_s: vec![0, day_s], micro_usd }
    }

    fn day_s(&self) -> usize {
        *self.slots_s.last().expect("a day has a slot") as usize
    }
}
