//! The worth of being ready anywhere at any time, at given prices, and the best choice there.
//!
//! Worth is computed at the boundaries of slots and taken to be linear in between. It follows from the worth at later
//! times, so one pass from the end of the day back to now finds it. No flight ends within its first few slots, so that
//! as many slots can be valued side by side in the lanes of the machine's vectors: every hop of a vertiport is then
//! looked at once for all of these slots. Each lane computes what a scalar would, so results do not depend on the width
//! of a vector.

use pulp::{Arch, Simd, WithSimd};
use vertifleet_core::{TypeIx, VertiportIx};
use vertifleet_sim::View;

use super::clock::{Clock, Place};
use super::hops::{Hops, Stay};

/// In place of the position of a hop: the best choice is to hold.
pub(super) const HOLD: u64 = u64::MAX;
/// Lanes of the widest vectors, in numbers of 64 bits.
const MOST_LANES: usize = 8;

/// The tables of a day, by vertiport, then boundary between two slots.
#[derive(Debug, Clone)]
pub(super) struct ValueTable {
    clock: Clock,
    vertiports: usize,
    hold: Stay,
    /// Distance from a vertiport to the next in the tables: its boundaries, and padding to read past the last one.
    stride: usize,
    /// Price of a stand from now until a boundary.
    paid_usd: Vec<f64>,
    /// By type: the worth of being ready *less* `paid_usd`, so that the rent of a stay is one subtraction.
    worth_less_paid_usd: Vec<f64>,
    /// By type: position of the best hop, or [`HOLD`].
    best: Vec<u64>,
    arch: Arch,
}

impl ValueTable {
    pub(super) fn of(view: View<'_>, clock: &Clock) -> Self {
        let (vertiports, kinds) = (view.vertiports(), view.aircraft_types().len());
        let stride = 2 * clock.slots + MOST_LANES + 1;
        Self {
            clock: *clock,
            vertiports,
            hold: Stay::of(view.hold_s(), clock),
            stride,
            paid_usd: vec![0.0; vertiports * stride],
            worth_less_paid_usd: vec![0.0; kinds * vertiports * stride],
            best: vec![HOLD; kinds * vertiports * stride],
            arch: Arch::new(),
        }
    }

    /// Sums the prices of stands, given by slot and then vertiport, up to each boundary from the first slot on.
    pub(super) fn pay(&mut self, stand_usd: &[f64], first_slot: usize) {
        let rows = self.paid_usd.chunks_exact_mut(self.stride);
        for (at, row) in rows.enumerate() {
            let mut paid_usd = 0.0;
            let prices = stand_usd[first_slot * self.vertiports..].iter().skip(at);
            for (paid, price_usd) in
                row[first_slot..].iter_mut().zip(prices.step_by(self.vertiports))
            {
                *paid = paid_usd;
                paid_usd += price_usd;
            }
            row[self.clock.slots] = paid_usd;
        }
    }

    /// Computes the best choice everywhere and its worth, for each type, from the first slot on.
    pub(super) fn value(&mut self, hops: &Hops, first_slot: usize) {
        let table = self.vertiports * self.stride;
        let worths = self.worth_less_paid_usd.chunks_exact_mut(table);
        for (kind, (worth_usd, best)) in worths.zip(self.best.chunks_exact_mut(table)).enumerate() {
            let rows = worth_usd.chunks_exact_mut(self.stride);
            for (worth_usd, paid_usd) in rows.zip(self.paid_usd.chunks_exact(self.stride)) {
                worth_usd[self.clock.slots] = -paid_usd[self.clock.slots];
            }
            self.arch.dispatch(BackwardPass {
                hops,
                kind: TypeIx::new(kind),
                first_slot,
                slots: self.clock.slots,
                stride: self.stride,
                hold: self.hold,
                paid_usd: &self.paid_usd,
                worth_usd,
                best,
            });
        }
    }

    /// Position of the best hop of an aircraft of a type that is ready at a boundary, or [`HOLD`].
    #[inline]
    pub(super) fn best(&self, kind: TypeIx, place: VertiportIx, boundary: usize) -> u64 {
        self.best[(kind.at() * self.vertiports + place.at()) * self.stride + boundary]
    }

    /// The worth of being ready at `ready_s`, less the price of the stand from `now_s` until then.
    #[inline]
    pub(super) fn usd(&self, kind: TypeIx, place: VertiportIx, now_s: u32, ready_s: u32) -> f64 {
        let table = &self.worth_less_paid_usd[kind.at() * self.vertiports * self.stride..];
        let worth_usd = if ready_s > self.clock.end_s {
            table[place.at() * self.stride + self.clock.slots]
        } else {
            self.between(table, place, ready_s)
        };
        worth_usd + self.between(&self.paid_usd, place, now_s)
    }

    pub(super) fn worth_usd(&self, kind: TypeIx, place: VertiportIx, time_s: u32) -> f64 {
        if time_s > self.clock.end_s { 0.0 } else { self.usd(kind, place, time_s, time_s) }
    }

    pub(super) fn rent_usd(&self, place: VertiportIx, from_s: u32, until_s: u32) -> f64 {
        self.between(&self.paid_usd, place, until_s) - self.between(&self.paid_usd, place, from_s)
    }

    #[inline]
    fn between(&self, table: &[f64], place: VertiportIx, time_s: u32) -> f64 {
        let Place { slot, share } = self.clock.place(time_s);
        let at = place.at() * self.stride + slot;
        table[at] + share * (table[at + 1] - table[at])
    }
}

/// The pass of one type from the end of the day back to the first slot.
struct BackwardPass<'a> {
    hops: &'a Hops,
    kind: TypeIx,
    first_slot: usize,
    slots: usize,
    stride: usize,
    hold: Stay,
    paid_usd: &'a [f64],
    worth_usd: &'a mut [f64],
    best: &'a mut [u64],
}

impl WithSimd for BackwardPass<'_> {
    type Output = ();

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let most = self.hops.shortest(self.kind).min(S::F64_LANES);
        let intervals = &self.hops.intervals.of_slot;
        let mut until = self.slots;
        while until > self.first_slot {
            let interval = intervals[until - 1];
            let mut begin = until - 1;
            while begin > self.first_slot
                && until - begin < most
                && intervals[begin - 1] == interval
            {
                begin -= 1;
            }
            // The lanes past `until` have been computed already and are not written again.
            let first_lane = until.saturating_sub(S::F64_LANES);
            for from in VertiportIx::all(self.paid_usd.len() / self.stride) {
                let (usd, best) = self.best_hop(simd, interval, from, first_lane);
                self.hold_or_fly(from, first_lane, begin..until, (&usd, &best));
            }
            until = begin;
        }
    }
}

impl BackwardPass<'_> {
    /// The best hop from a vertiport at each of the boundaries from `first_lane` on, and its worth.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
    fn best_hop<S: Simd>(
        &self,
        simd: S,
        interval: usize,
        from: VertiportIx,
        first_lane: usize,
    ) -> ([f64; MOST_LANES], [u64; MOST_LANES]) {
        let load = |table: &[f64], at: usize| S::as_simd_f64s(&table[at..at + S::F64_LANES]).0[0];
        let boundaries: [f64; MOST_LANES] = std::array::from_fn(|lane| (first_lane + lane) as f64);
        let boundaries = load(&boundaries, 0);
        let mut most_usd = simd.splat_f64s(f64::NEG_INFINITY);
        let mut best = simd.splat_u64s(HOLD);
        let range = self.hops.range(self.kind, from);
        for (at, (hop, gain_usd)) in range.clone().zip(self.hops.gains(interval, range)) {
            let row = hop.to.at() * self.stride;
            let ready = row + first_lane + hop.stay.slots;
            let (before, after) = (load(self.worth_usd, ready), load(self.worth_usd, ready + 1));
            let rise = simd.mul_f64s(simd.splat_f64s(hop.stay.share), simd.sub_f64s(after, before));
            let follows = simd.select_f64s(
                simd.less_than_f64s(boundaries, simd.splat_f64s(hop.stay.first_late as f64)),
                simd.add_f64s(before, rise),
                simd.splat_f64s(self.worth_usd[row + self.slots]),
            );
            let follows = simd.add_f64s(load(self.paid_usd, row + first_lane), follows);
            let usd = simd.add_f64s(simd.splat_f64s(gain_usd), follows);
            let better = simd.greater_than_f64s(usd, most_usd);
            most_usd = simd.select_f64s(better, usd, most_usd);
            best = simd.select_u64s(better, simd.splat_u64s(at as u64), best);
        }
        let mut found = ([0.0; MOST_LANES], [HOLD; MOST_LANES]);
        S::as_mut_simd_f64s(&mut found.0).0[0] = most_usd;
        S::as_mut_simd_u64s(&mut found.1).0[0] = best;
        found
    }

    /// Enters the better of the best hop and a hold at some boundaries of a vertiport. It starts with the last
    /// boundary, because a hold may lead from one of them to another.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
    fn hold_or_fly(
        &mut self,
        from: VertiportIx,
        first_lane: usize,
        boundaries: std::ops::Range<usize>,
        (fly_usd, hops): (&[f64; MOST_LANES], &[u64; MOST_LANES]),
    ) {
        let row = from.at() * self.stride..(from.at() + 1) * self.stride;
        let paid_usd = &self.paid_usd[row.clone()];
        let worth_usd = &mut self.worth_usd[row.clone()];
        let best = &mut self.best[row];
        for at in boundaries.rev() {
            let ready = at + self.hold.slots;
            let follows = if at < self.hold.first_late {
                worth_usd[ready] + self.hold.share * (worth_usd[ready + 1] - worth_usd[ready])
            } else {
                worth_usd[self.slots]
            };
            let hold_usd = paid_usd[at] + follows;
            let fly_usd = fly_usd[at - first_lane];
            let flies = fly_usd > hold_usd;
            worth_usd[at] = if flies { fly_usd } else { hold_usd } - paid_usd[at];
            best[at] = if flies { hops[at - first_lane] } else { HOLD };
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use pulp::Arch;
    use vertifleet_core::{DaySeed, Network};
    use vertifleet_sim::Simulation;

    use super::super::clock::Clock;
    use super::super::hops::Hops;
    use super::ValueTable;

    #[test]
    fn vectors_of_any_width_give_the_same_tables() {
        let network = Network::shipped("new-york").expect("a shipped network");
        let day = Arc::new(network.draw(DaySeed::validation(1).expect("a seed")));
        let simulation = Simulation::new(day);
        let view = simulation.view();
        let clock = Clock::of(view);
        let mut hops = Hops::of(view, &clock);
        hops.load(view);
        let pairs = view.period_starts().len() * view.vertiports() * view.vertiports();
        hops.charge(0, &vec![1.5; pairs]);
        let stand_usd: Vec<f64> =
            (0..clock.slots * view.vertiports()).map(|at| (at % 7) as f64 / 3.0).collect();
        let tables = |arch: Arch| {
            let mut values = ValueTable::of(view, &clock);
            values.arch = arch;
            values.pay(&stand_usd, 3);
            values.value(&hops, 3);
            (values.worth_less_paid_usd, values.best)
        };
        let widest = tables(Arch::new());
        assert!(widest.0.iter().any(|&usd| usd > 100.0), "flights are worth something");
        assert_eq!(tables(Arch::Scalar), widest);
    }
}
