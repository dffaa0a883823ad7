//! The pass from the end of the day back to the first slot, which values being ready anywhere at
//! any time for one type of aircraft.
//!
//! No flight ends within its first few slots, so that as many slots can be valued side by side in
//! the lanes of the machine's vectors: every hop of a vertiport is then looked at once for all of
//! these slots. Each lane computes what a scalar would, so results do not depend on the width of a
//! vector. This loop takes most of the time of a search.

use std::ops::Range;

use pulp::{Simd, WithSimd};

use super::hops::{Hops, Stay};
use super::quads::{Arrival, QUAD, QuadsOfKind};
use super::values::HOLD;

/// Lanes of the widest vectors, in numbers of 64 bits.
pub(super) const MOST_LANES: usize = 8;
/// In place of a destination in a lane: there is none.
const NOWHERE: u64 = u64::MAX;

/// The pass of one type.
pub(super) struct BackwardPass<'a> {
    pub(super) hops: &'a Hops,
    pub(super) quads: QuadsOfKind<'a>,
    pub(super) first_slot: usize,
    pub(super) slots: usize,
    /// Distance from a vertiport to the next in the tables of dollars.
    pub(super) stride: usize,
    /// Levels of charge, each a row of a vertiport.
    pub(super) levels: usize,
    /// By row.
    pub(super) holds: &'a [Hold],
    pub(super) paid_usd: &'a [f64],
    pub(super) worth_usd: &'a mut [f64],
    /// By row, then slot.
    pub(super) best: &'a mut [u16],
}

/// The hold of an aircraft at a vertiport with a level of charge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hold {
    pub(super) stay: Stay,
    /// How far before the row of this level that of the level is at which the hold ends.
    pub(super) above: usize,
    /// Where the prices of the vertiport's stands begin.
    pub(super) paid: usize,
}

impl WithSimd for BackwardPass<'_> {
    type Output = ();

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let most = self.quads.shortest.min(S::F64_LANES);
        let mut until = self.slots;
        while until > self.first_slot {
            let begin = until.saturating_sub(most).max(self.first_slot);
            let block = Block::of(&self.hops.intervals.of_slot, begin..until, S::F64_LANES);
            let is_late = (block.first_lane + S::F64_LANES) as f64 > self.quads.first_late;
            match (is_late, block.change) {
                (false, None) => self.value_block::<S, false, false>(simd, &block),
                (false, Some(_)) => self.value_block::<S, false, true>(simd, &block),
                (true, None) => self.value_block::<S, true, false>(simd, &block),
                (true, Some(_)) => self.value_block::<S, true, true>(simd, &block),
            }
            until = block.boundaries.start;
        }
    }
}

/// Boundaries that are valued side by side.
struct Block {
    boundaries: Range<usize>,
    first_lane: usize,
    /// The interval of the last boundary.
    interval: usize,
    /// Where some of the boundaries are of the interval before it: that interval, and the first
    /// boundary that is not.
    change: Option<(usize, usize)>,
}

impl Block {
    /// The last boundaries of some that are of two intervals at most, given by boundary.
    fn of(intervals: &[usize], boundaries: Range<usize>, lanes: usize) -> Self {
        let until = boundaries.end;
        let interval = intervals[until - 1];
        let mut begin = until - 1;
        let mut change = None;
        while begin > boundaries.start {
            let before = intervals[begin - 1];
            match change {
                None if before != interval => change = Some((before, begin)),
                Some((earlier, _)) if before != earlier => break,
                _ => {}
            }
            begin -= 1;
        }
        // The lanes past `until` have been computed already and are not written again.
        let first_lane = until.saturating_sub(lanes);
        Self { boundaries: begin..until, first_lane, interval, change }
    }
}

/// The best hop in each lane so far.
#[derive(Clone, Copy)]
struct Best<S: Simd> {
    usd: S::f64s,
    to: S::u64s,
}

/// The lanes of a block.
#[derive(Clone, Copy)]
struct Lanes<S: Simd> {
    boundaries: S::f64s,
    /// The first boundary of the later interval.
    change: S::f64s,
}

/// The amount that a hop to one destination may bring, from the first lane of a block on.
struct Destination<'a, S: Simd> {
    /// Its worth less what has been paid, at all boundaries from the first lane on.
    worth_usd: &'a [f64],
    paid_usd: S::f64s,
    /// The same as `worth_usd` past the end of operations.
    end_usd: S::f64s,
    /// Its index.
    to: S::u64s,
}

#[inline(always)]
#[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
fn load<S: Simd>(lanes: &[f64]) -> S::f64s {
    S::as_simd_f64s(&lanes[..S::F64_LANES]).0[0]
}

impl<S: Simd> Best<S> {
    /// Looks at a hop to a destination that comes after those looked at before. Its gain is given
    /// for the earlier and the later interval. Some lanes may end past the end of operations only
    /// if `LATE`, and be of the earlier interval only if `MIXED`.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
    fn look_at<const LATE: bool, const MIXED: bool>(
        &mut self,
        simd: S,
        lanes: Lanes<S>,
        destination: &Destination<'_, S>,
        arrival: &Arrival,
        (earlier_usd, later_usd): (&f64, &f64),
    ) {
        let begin = arrival.offset as usize;
        let end = begin + S::F64_LANES + 1;
        let around = &destination.worth_usd[begin..end];
        let (before, after) = (load::<S>(around), load::<S>(&around[1..]));
        let rise = simd.mul_f64s(simd.splat_f64s(arrival.share), simd.sub_f64s(after, before));
        let mut follows = simd.add_f64s(before, rise);
        if LATE {
            let in_time =
                simd.less_than_f64s(lanes.boundaries, simd.splat_f64s(arrival.first_late));
            follows = simd.select_f64s(in_time, follows, destination.end_usd);
        }
        let follows = simd.add_f64s(destination.paid_usd, follows);
        let mut gain_usd = simd.splat_f64s(*later_usd);
        if MIXED {
            let is_earlier = simd.less_than_f64s(lanes.boundaries, lanes.change);
            gain_usd = simd.select_f64s(is_earlier, simd.splat_f64s(*earlier_usd), gain_usd);
        }
        let mut usd = simd.add_f64s(gain_usd, follows);
        if LATE {
            let may_leave =
                simd.less_than_f64s(lanes.boundaries, simd.splat_f64s(arrival.first_closed));
            usd = simd.select_f64s(may_leave, usd, simd.splat_f64s(f64::NEG_INFINITY));
        }
        let better = simd.greater_than_f64s(usd, self.usd);
        self.usd = simd.select_f64s(better, usd, self.usd);
        self.to = simd.select_u64s(better, destination.to, self.to);
    }
}

impl BackwardPass<'_> {
    /// Values a block everywhere.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
    fn value_block<S: Simd, const LATE: bool, const MIXED: bool>(
        &mut self,
        simd: S,
        block: &Block,
    ) {
        for quad in 0..self.quads.count() {
            let best = self.best_hops::<S, LATE, MIXED>(simd, block, quad);
            for (number, best) in best.iter().enumerate() {
                let row = QUAD * quad + number;
                if row >= self.holds.len() {
                    break;
                }
                let mut found = ([0.0; MOST_LANES], [NOWHERE; MOST_LANES]);
                S::as_mut_simd_f64s(&mut found.0).0[0] = best.usd;
                S::as_mut_simd_u64s(&mut found.1).0[0] = best.to;
                self.hold_or_fly(row, block, (&found.0, &found.1));
            }
        }
    }

    /// The best hop from each vertiport of a quad at each of the boundaries from the first lane on.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
    fn best_hops<S: Simd, const LATE: bool, const MIXED: bool>(
        &self,
        simd: S,
        block: &Block,
        quad: usize,
    ) -> [Best<S>; QUAD] {
        let lanes: [f64; MOST_LANES] = std::array::from_fn(|lane| (block.first_lane + lane) as f64);
        let (earlier, change) = block.change.unwrap_or((block.interval, 0));
        let change = simd.splat_f64s(change as f64);
        let lanes = Lanes { boundaries: load::<S>(&lanes), change };
        let (paid_usd, worth_usd) =
            (&self.paid_usd[block.first_lane..], &self.worth_usd[block.first_lane..]);
        let end = self.slots - block.first_lane;
        let none = Best { usd: simd.splat_f64s(f64::NEG_INFINITY), to: simd.splat_u64s(NOWHERE) };
        let mut best = [none; QUAD];
        let earlier_usd = self.quads.gains_usd(quad, self.hops.gains_usd(earlier));
        let later_usd = self.quads.gains_usd(quad, self.hops.gains_usd(block.interval));
        for ((hops, earlier_usd), later_usd) in
            self.quads.hops(quad).iter().zip(earlier_usd).zip(later_usd)
        {
            let to = usize::try_from(hops.to).expect("an index");
            let (row, rows) = (to * self.stride, self.levels * self.stride);
            let worth_usd = &worth_usd[to * rows..(to + 1) * rows - block.first_lane];
            let destination = Destination::<S> {
                worth_usd,
                paid_usd: load::<S>(&paid_usd[row..row + S::F64_LANES]),
                end_usd: simd.splat_f64s(worth_usd[end]),
                to: simd.splat_u64s(hops.to),
            };
            for number in 0..QUAD {
                best[number].look_at::<LATE, MIXED>(
                    simd,
                    lanes,
                    &destination,
                    &hops.arrivals[number],
                    (&earlier_usd[number], &later_usd[number]),
                );
            }
        }
        best
    }

    /// Enters the better of the best hop and a hold at the boundaries of a block. It starts with
    /// the last boundary, because a hold may lead from one of them to another. A hold leads to the
    /// row of no lower level, which comes first.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
    fn hold_or_fly(
        &mut self,
        row: usize,
        block: &Block,
        (fly_usd, destinations): (&[f64; MOST_LANES], &[u64; MOST_LANES]),
    ) {
        let Hold { stay: hold, above, paid } = self.holds[row];
        let paid_usd = &self.paid_usd[paid..][..self.stride];
        let own = row * self.stride;
        let (before, worth_usd) = self.worth_usd[..own + self.stride].split_at_mut(own);
        let best = &mut self.best[row * self.slots..][..self.slots];
        for at in block.boundaries.clone().rev() {
            let ready = at + hold.slots;
            let follows = if at >= hold.first_late {
                worth_usd[self.slots]
            } else {
                let held_usd = match above {
                    0 => &*worth_usd,
                    above => &before[own - above..],
                };
                held_usd[ready] + hold.share * (held_usd[ready + 1] - held_usd[ready])
            };
            let hold_usd = paid_usd[at] + follows;
            let fly_usd = fly_usd[at - block.first_lane];
            let flies = fly_usd > hold_usd;
            worth_usd[at] = if flies { fly_usd } else { hold_usd } - paid_usd[at];
            best[at] = if flies { index(destinations[at - block.first_lane]) } else { HOLD };
        }
    }
}

/// The index of a destination in a lane.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "a day has fewer vertiports than 2^16")]
fn index(to: u64) -> u16 {
    to as u16
}
