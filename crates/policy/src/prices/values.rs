//! The worth of being ready anywhere at any time, at given prices, and the best choice there.
//!
//! Worth is computed at the boundaries of slots and taken to be linear in between. It follows from
//! the worth at later times, so one pass from the end of the day back to now finds it
//! (`backward_pass.rs`).

use pulp::Arch;
use vertifleet_core::{TypeIx, VertiportIx};
use vertifleet_sim::View;

use super::backward_pass::{BackwardPass, Hold, MOST_LANES};
use super::clock::{Clock, Place, SLOT_S};
use super::hops::{Hops, Stay, ready_after_hold};
use super::levels::{Level, Levels, ReadyAt};

/// In place of a destination: the best choice is to hold.
pub(super) const HOLD: u16 = u16::MAX;

/// The tables of a day, by vertiport, then boundary between two slots.
#[derive(Debug, Clone)]
pub(super) struct ValueTable {
    clock: Clock,
    vertiports: usize,
    levels: usize,
    /// By type, vertiport, then level.
    holds: Vec<Hold>,
    /// Distance from a row to the next in the tables: its boundaries, and padding to read past the
    /// last one.
    stride: usize,
    /// Price of a stand from now until a boundary.
    paid_usd: Vec<f64>,
    /// By type, and by level of charge at each vertiport: the worth of being ready *less*
    /// `paid_usd`, so that the rent of a stay is one subtraction.
    worth_less_paid_usd: Vec<f64>,
    /// By type, vertiport, level, then slot: index of the best destination at its beginning, or
    /// [`HOLD`].
    best: Vec<u16>,
    arch: Arch,
}

impl ValueTable {
    pub(super) fn of(view: View<'_>, clock: &Clock, levels: &Levels) -> Self {
        let (vertiports, kinds) = (view.vertiports(), view.aircraft_types().len());
        let stride = Self::stride(clock);
        let rows = kinds * vertiports * levels.count;
        let mut holds = Vec::with_capacity(rows);
        for kind in TypeIx::all(kinds) {
            for at in VertiportIx::all(vertiports) {
                for level in (0..).take(levels.count) {
                    let ready = ready_after_hold(view, levels, (kind, at), level);
                    let stay = Stay::of(ready.time_s, clock);
                    let above = usize::from(level - ready.level) * stride;
                    holds.push(Hold { stay, above, paid: at.at() * stride });
                }
            }
        }
        Self {
            clock: *clock,
            vertiports,
            levels: levels.count,
            holds,
            stride,
            paid_usd: vec![0.0; vertiports * stride],
            worth_less_paid_usd: vec![0.0; rows * stride],
            best: vec![HOLD; rows * clock.slots],
            arch: Arch::new(),
        }
    }

    /// Distance from a row to the next in the tables of a day.
    pub(super) fn stride(clock: &Clock) -> usize {
        2 * clock.slots + MOST_LANES + 1
    }

    /// Sums the prices of stands, given by slot and then vertiport, up to each boundary from the
    /// first slot on.
    pub(super) fn pay(&mut self, stand_usd: &[f64], first_slot: usize) {
        let (stride, slots) = (self.stride, self.clock.slots);
        for paid_usd in self.paid_usd[first_slot..].iter_mut().step_by(stride) {
            *paid_usd = 0.0;
        }
        let prices = stand_usd.chunks_exact(self.vertiports);
        for (slot, prices) in prices.enumerate().take(slots).skip(first_slot) {
            let paid_usd = self.paid_usd[slot..].chunks_mut(stride);
            for (paid_usd, price_usd) in paid_usd.zip(prices) {
                paid_usd[1] = paid_usd[0] + price_usd;
            }
        }
    }

    /// Computes the best choice everywhere and its worth, for each type, from the first slot on.
    pub(super) fn value(&mut self, hops: &Hops, first_slot: usize) {
        let (rows, slots) = (self.vertiports * self.levels, self.clock.slots);
        let worths = self.worth_less_paid_usd.chunks_exact_mut(rows * self.stride);
        let bests = self.best.chunks_exact_mut(rows * slots);
        let holds = self.holds.chunks_exact(rows);
        for (kind, ((worth_usd, best), holds)) in worths.zip(bests).zip(holds).enumerate() {
            let places = worth_usd.chunks_exact_mut(self.levels * self.stride);
            for (worth_usd, paid_usd) in places.zip(self.paid_usd.chunks_exact(self.stride)) {
                for worth_usd in worth_usd[slots..].iter_mut().step_by(self.stride) {
                    *worth_usd = -paid_usd[slots];
                }
            }
            self.arch.dispatch(BackwardPass {
                hops,
                quads: hops.quads.of_kind(TypeIx::new(kind)),
                first_slot,
                slots,
                stride: self.stride,
                levels: self.levels,
                holds,
                paid_usd: &self.paid_usd,
                worth_usd,
                best,
            });
        }
    }

    /// Index of the best destination of an aircraft of a type that is ready when a slot begins, or
    /// [`HOLD`].
    #[inline]
    pub(super) fn best(&self, kind: TypeIx, place: VertiportIx, level: Level, slot: usize) -> u16 {
        let place = kind.at() * self.vertiports + place.at();
        let row = place * self.levels + usize::from(level);
        self.best[row * self.clock.slots + slot]
    }

    /// The worth of aircraft of a type that decide now.
    #[inline]
    pub(super) fn worths_from(&self, kind: TypeIx, now_s: u32) -> WorthsFrom<'_> {
        let table = self.vertiports * self.levels * self.stride;
        WorthsFrom {
            worth_less_paid_usd: &self.worth_less_paid_usd[kind.at() * table..][..table],
            paid_usd: &self.paid_usd,
            stride: self.stride,
            vertiport_stride: self.levels * self.stride,
            clock: &self.clock,
            now: self.clock.place(now_s),
        }
    }

    /// The most that [`WorthsFrom::at_level_usd`] returns for flights that are decided in a slot
    /// and of which the aircraft is ready between two times after its decision. Between two
    /// boundaries nothing is worth more than at the better one.
    pub(super) fn most_usd(
        &self,
        kind: TypeIx,
        to: VertiportIx,
        slot: usize,
        (level, earliest_s, latest_s): (Level, u32, u32),
    ) -> f64 {
        let begin_s = self.clock.begin_s(slot);
        let first = self.clock.place(begin_s + earliest_s).slot;
        let last = self.clock.place(begin_s + latest_s + SLOT_S).slot + 1;
        let most = |row: &[f64]| row.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let place = kind.at() * self.vertiports + to.at();
        let row = place * self.levels + usize::from(level);
        let worth_usd = &self.worth_less_paid_usd[row * self.stride..];
        let paid_usd = &self.paid_usd[to.at() * self.stride + slot..][..2];
        most(&worth_usd[first..=last]) + most(paid_usd)
    }

    /// The worth of being ready at `ready_s`, less the price of the stand from `now_s` until then.
    #[inline]
    pub(super) fn usd(&self, kind: TypeIx, place: VertiportIx, now_s: u32, ready_s: u32) -> f64 {
        self.worths_from(kind, now_s).usd(place, ready_s)
    }

    /// The worth of being ready at a level of charge, less the price of the stand from `now_s`
    /// until then.
    pub(super) fn at_level_usd(
        &self,
        kind: TypeIx,
        place: VertiportIx,
        now_s: u32,
        ready: ReadyAt,
    ) -> f64 {
        self.worths_from(kind, now_s).at_level_usd(place, ready)
    }

    /// The worth of being ready at a level of charge.
    pub(super) fn worth_at_level_usd(
        &self,
        kind: TypeIx,
        place: VertiportIx,
        ready: ReadyAt,
    ) -> f64 {
        if ready.time_s > self.clock.end_s {
            return 0.0;
        }
        self.at_level_usd(kind, place, ready.time_s, ready)
    }

    pub(super) fn worth_usd(&self, kind: TypeIx, place: VertiportIx, time_s: u32) -> f64 {
        if time_s > self.clock.end_s { 0.0 } else { self.usd(kind, place, time_s, time_s) }
    }

    pub(super) fn rent_usd(&self, place: VertiportIx, from_s: u32, until_s: u32) -> f64 {
        self.between(&self.paid_usd, place, until_s) - self.between(&self.paid_usd, place, from_s)
    }

    #[inline]
    fn between(&self, table: &[f64], place: VertiportIx, time_s: u32) -> f64 {
        between(&table[place.at() * self.stride..], self.clock.place(time_s))
    }
}

/// The number at a place between the boundaries of a row.
#[inline]
fn between(row: &[f64], Place { slot, share }: Place) -> f64 {
    let around = &row[slot..slot + 2];
    around[0] + share * (around[1] - around[0])
}

/// The worth of being ready anywhere, for aircraft of one type that decide at one time.
#[derive(Debug, Clone, Copy)]
pub(super) struct WorthsFrom<'a> {
    worth_less_paid_usd: &'a [f64],
    paid_usd: &'a [f64],
    /// Distance from a level of charge to the next in the table of worths, and from a vertiport.
    stride: usize,
    vertiport_stride: usize,
    clock: &'a Clock,
    now: Place,
}

impl WorthsFrom<'_> {
    /// The worth of being ready at `ready_s`, less the price of the stand from now until then.
    #[inline]
    pub(super) fn usd(&self, place: VertiportIx, ready_s: u32) -> f64 {
        self.at_level_usd(place, ReadyAt { level: 0, time_s: ready_s })
    }

    /// The same with a level of charge.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "most days have one level")]
    pub(super) fn at_level_usd(&self, place: VertiportIx, ready: ReadyAt) -> f64 {
        let row = place.at() * self.vertiport_stride + usize::from(ready.level) * self.stride;
        let row_usd = &self.worth_less_paid_usd[row..row + self.stride];
        let worth_usd = if ready.time_s > self.clock.end_s {
            row_usd[self.clock.slots]
        } else {
            between(row_usd, self.clock.place(ready.time_s))
        };
        let row = place.at() * self.stride;
        worth_usd + between(&self.paid_usd[row..row + self.stride], self.now)
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
    use super::super::levels::Levels;
    use super::ValueTable;

    #[test]
    fn vectors_of_any_width_give_the_same_tables() {
        let network = Network::shipped("new-york").expect("a shipped network");
        let day = Arc::new(network.draw(DaySeed::validation(1).expect("a seed")));
        let simulation = Simulation::new(day);
        let view = simulation.view();
        let clock = Clock::of(view);
        let levels = Levels::of(view);
        let mut hops = Hops::of(view, &clock, &levels, ValueTable::stride(&clock));
        hops.load(view);
        let pairs = view.period_starts().len() * view.vertiports() * view.vertiports();
        hops.charge_all(0, &vec![1.5; pairs]);
        let stand_usd: Vec<f64> =
            (0..clock.slots * view.vertiports()).map(|at| (at % 7) as f64 / 3.0).collect();
        let tables = |arch: Arch| {
            let mut values = ValueTable::of(view, &clock, &levels);
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
