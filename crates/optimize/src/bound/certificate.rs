//! The certificate: prices prove a bound in exact whole numbers, however they were found.
//!
//! Let aircraft pay for the stands that they take, and sell their flights to the passengers. Give
//! back the price of every stand once, and the surplus of the passengers (`market.rs`). A schedule
//! that keeps to the limits pays no more for stands than is given back, and its passengers bring no
//! more beyond what they pay than their surplus. The amount given back plus the most that each
//! aircraft can earn at these prices is therefore at least the profit of any schedule (Lagrangian
//! relaxation; docs/src/concepts/bound.md has the proof). The most that an aircraft can earn is a
//! longest path through vertiports and whole seconds, found from the end of the day back to its
//! start. Flights and holds last exactly as long on this path as in the simulator.

use pulp::{Arch, Simd, WithSimd};

use super::prices::Prices;
use super::time_expanded_day::{Flight, Start, TimeExpandedDay};
use vertifleet_core::Stop;

/// Seconds that are computed side by side, so that their worths so far stay in the fastest memory.
const SIDE_BY_SIDE: usize = 512;

/// The bound that prices prove, and the worth of being ready anywhere at any time at these prices.
/// It is evaluated again and again without a new allocation.
#[derive(Debug, Clone)]
pub(super) struct Certificate {
    /// Price of a stand from the first slice until each slice begins and the last one ends, by
    /// slice, then vertiport.
    paid: Vec<i64>,
    /// The worth of being ready, *less* the price of the stand since the day began, so that the
    /// payment from one second to another is one subtraction. By layer, place, second of the day,
    /// and as many seconds past its end as are ever read.
    ///
    /// A day has at most 7,202 slices (36 hours in minutes, 1,440 more where periods begin, as many
    /// where passengers have waited long enough, and 2,161 where slots of delays begin). An
    /// aircraft flies at most 2,161 times, a flight earns at most 1,000 x 10^12, and a stand costs
    /// at most 10^14 a slice, so every entry is below 2^62.
    worth_less_paid: Vec<i64>,
    /// On a day with a penalty, `worth_less_paid` is the worth to an aircraft that comes from an
    /// earlier slot and still has to pay, and this is the worth to one that decided in the same
    /// slot before. Empty on other days.
    within_slot: Vec<i64>,
    /// What each flight earns: its price less its cost and what it pays for its charging.
    earned: Vec<i64>,
    /// Distance from a place to the next in `worth_less_paid`.
    stride: usize,
    arch: Arch,
}

impl Certificate {
    /// A certificate with memory for the evaluations of a day.
    pub(super) fn new(day: &TimeExpandedDay) -> Self {
        let stride = (day.slices.day_s() + day.shortest_s) as usize;
        let places = day.layers.len() * day.places() * stride;
        Self {
            paid: Vec::with_capacity((day.slices.len() + 1) * day.size()),
            worth_less_paid: vec![0; places],
            within_slot: vec![0; if day.penalty.is_some() { places } else { 0 }],
            earned: Vec::with_capacity(day.all_flights().len()),
            stride,
            arch: Arch::new(),
        }
    }

    /// Computes the bound that `prices` prove, micro-dollars, before the cost of the fleet is
    /// deducted. Returns `None` soon after `stopped` is requested.
    pub(super) fn evaluate(
        &mut self,
        day: &TimeExpandedDay,
        prices: &Prices,
        stopped: &Stop,
    ) -> Option<i128> {
        self.pay(day, prices);
        self.earn(day, prices);
        let of_layer = self.stride * day.places();
        let mut within_slot = self.within_slot.chunks_exact_mut(of_layer);
        let layers = self.worth_less_paid.chunks_exact_mut(of_layer);
        for (layer, worths) in layers.enumerate() {
            let (paid, earned, stride) = (&self.paid[..], &self.earned[..], self.stride);
            let within_slot = within_slot.next().unwrap_or_default();
            let pass = LayerPass { day, paid, earned, layer, stride, worths, within_slot, stopped };
            if !self.arch.dispatch(pass) {
                return None;
            }
        }
        Some(self.fleet(day, prices) + dual_constant(day, prices))
    }

    /// What the flight at a position among all flights earns.
    #[inline]
    pub(super) fn earned(&self, position: usize) -> i64 {
        self.earned[position]
    }

    /// Price of a stand at a vertiport from the start of the day until a slice begins.
    #[inline]
    pub(super) fn paid(&self, day: &TimeExpandedDay, slice: usize, at: usize) -> i64 {
        self.paid[slice * day.size() + at]
    }

    /// The worth of being ready, less the price of the stand since the day began; micro-dollars.
    /// `second` counts from the first take-off time. Past the last one nothing can be earned, and
    /// the stand is paid for until the last slice ends.
    #[inline]
    pub(super) fn worth_less_paid(
        &self,
        day: &TimeExpandedDay,
        layer: usize,
        place: usize,
        second: usize,
    ) -> i64 {
        self.worths_less_paid(day, layer, place, second)[0]
    }

    /// The same from a second on, for at least as many seconds as a hold or a flight lasts.
    pub(super) fn worths_less_paid(
        &self,
        day: &TimeExpandedDay,
        layer: usize,
        place: usize,
        second: usize,
    ) -> &[i64] {
        let second = second.min(day.slices.day_s() as usize);
        &self.worth_less_paid[(layer * day.places() + place) * self.stride..][second..self.stride]
    }

    /// The worth to an aircraft that decided in the same slot before, less the price of the stand
    /// since the day began.
    #[inline]
    pub(super) fn worth_within_slot(
        &self,
        day: &TimeExpandedDay,
        layer: usize,
        place: usize,
        second: usize,
    ) -> i64 {
        let known =
            if self.within_slot.is_empty() { &self.worth_less_paid } else { &self.within_slot };
        known
            [(layer * day.places() + place) * self.stride + second.min(day.slices.day_s() as usize)]
    }

    fn pay(&mut self, day: &TimeExpandedDay, prices: &Prices) {
        self.paid.clear();
        self.paid.resize(day.size(), 0);
        for (at, price) in prices.stand.iter().enumerate() {
            self.paid.push(self.paid[at] + price);
        }
    }

    fn earn(&mut self, day: &TimeExpandedDay, prices: &Prices) {
        let earnings = |flight: &Flight| prices.flight[flight.sold_at as usize] - flight.cost;
        self.earned.clear();
        self.earned.extend(day.all_flights().iter().map(earnings));
        for (earned, used) in self.earned.iter_mut().zip(day.uses()) {
            *earned -= used.payment(&prices.charging);
        }
    }

    /// The most that the whole fleet earns after payments. Nothing has been paid when the day
    /// begins.
    fn fleet(&self, day: &TimeExpandedDay, prices: &Prices) -> i128 {
        let layers = day.layers.iter().enumerate();
        let starts =
            layers.flat_map(|(layer, kind)| kind.starts.iter().map(move |one| (layer, one)));
        let gift = |layer: usize, start: &Start| {
            day.charging.gift(&prices.charging, day.layers[layer].kind, start.charged_s)
        };
        let earned = |(layer, start): (usize, &Start)| {
            // The price of the stand until they are ready has been deducted.
            let place = day.place(start.at, start.level);
            let worth = self.worth_less_paid(day, layer, place, start.ready_s as usize);
            i128::from(start.count) * i128::from(worth + gift(layer, start))
        };
        starts.map(earned).sum()
    }
}

/// The pass of one layer over the day, from its end back to its start.
struct LayerPass<'a> {
    day: &'a TimeExpandedDay,
    paid: &'a [i64],
    earned: &'a [i64],
    layer: usize,
    stride: usize,
    worths: &'a mut [i64],
    within_slot: &'a mut [i64],
    stopped: &'a Stop,
}

impl WithSimd for LayerPass<'_> {
    /// Whether the pass came to its end.
    type Output = bool;

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
    fn with_simd<S: Simd>(mut self, _: S) -> bool {
        let slices = &self.day.slices;
        let day_s = slices.day_s() as usize;
        for &place in self.day.reached(self.layer) {
            let over = -self.paid(slices.len(), self.day.vertiport(place));
            self.worths[place * self.stride..][..self.stride][day_s..].fill(over);
            if !self.within_slot.is_empty() {
                self.within_slot[place * self.stride..][..self.stride][day_s..].fill(over);
            }
        }
        let second = |slice| (slices.start_s(slice) - slices.start_s(0)) as usize;
        // No flight and no hold begins and ends in the same piece, so everything that a piece needs
        // has been computed.
        let longest = SIDE_BY_SIDE.min(self.day.shortest_s as usize);
        let only_falls = self.day.layers[self.layer].waits_freely && self.day.penalty.is_none();
        let mut best = [0; SIDE_BY_SIDE];
        for slice in (0..slices.len()).rev() {
            let (first, mut past) = (second(slice), second(slice + 1));
            while past > first {
                if self.stopped.is_requested() {
                    return false;
                }
                let begin = first.max(past.saturating_sub(longest));
                let best = &mut best[..past - begin];
                for &place in self.day.reached(self.layer) {
                    if only_falls {
                        self.work_out_falling_piece(slice, place, begin, best);
                    } else {
                        self.work_out_piece(slice, place, begin, best);
                    }
                }
                past = begin;
            }
        }
        true
    }
}

impl LayerPass<'_> {
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "part of the pass")]
    fn paid(&self, slice: usize, at: usize) -> i64 {
        self.paid[slice * self.day.size() + at]
    }

    /// Computes the seconds from `begin` on, as many as `best` has room for, all of which are in
    /// `slice`, from the seconds after them.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
    fn work_out_piece(&mut self, slice: usize, place: usize, begin: usize, best: &mut [i64]) {
        let from = self.day.vertiport(place);
        let past = begin + best.len();
        best.fill(i64::MIN);
        let past_slot = self.day.penalty.as_ref().map_or(0, |penalty| penalty.past_slot(begin));
        let stays = self.paid(slice, from);
        let held = self.day.held(self.layer, place);
        self.raise(best, held, begin + self.day.hold_s as usize, past_slot, 0);
        let flights = self.day.flights(slice, self.layer, place);
        let earned = &self.earned[self.day.positions(slice, self.layer, place)];
        for (flight, earned) in flights.iter().zip(earned) {
            let to = self.day.place(flight.to.at(), flight.level);
            let flies = earned + self.paid(slice, flight.to.at()) - stays;
            self.raise(best, to, begin + flight.block_s as usize, past_slot, flies);
        }
        let layer = &self.day.layers[self.layer];
        let own = &mut self.worths[place * self.stride..][..self.stride];
        if let Some(penalty) = &self.day.penalty {
            let within = &mut self.within_slot[place * self.stride..][..self.stride];
            within[begin..past].copy_from_slice(best);
            if layer.waits_freely {
                let afterwards = if past < past_slot { within[past] } else { own[past] };
                wait_freely(&mut within[begin..past], afterwards);
            }
            let payments = &penalty.at(layer.kind, from)[begin..past];
            best.iter_mut().zip(payments).for_each(|(best, payment)| *best -= payment);
        }
        own[begin..past].copy_from_slice(best);
        if layer.waits_freely {
            let afterwards = own[past];
            wait_freely(&mut own[begin..past], afterwards);
        }
    }

    /// Does the same as [`work_out_piece`](Self::work_out_piece) where aircraft may wait freely and
    /// there is no penalty. The worth less the price of the stand since the day began then never
    /// rises with time. So the first entry of a choice is its highest, and the last one of `best`
    /// the lowest; a choice whose first entry is no higher than that is left out.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
    fn work_out_falling_piece(
        &mut self,
        slice: usize,
        place: usize,
        begin: usize,
        best: &mut [i64],
    ) {
        let (day_s, last) = (self.day.slices.day_s() as usize, best.len() - 1);
        let at = |to: usize, takes_s: u32| to * self.stride + (begin + takes_s as usize).min(day_s);
        let own = place * self.stride + begin;
        let waits = self.worths[own + best.len()];
        let held = at(self.day.held(self.layer, place), self.day.hold_s);
        for (best, held) in best.iter_mut().zip(&self.worths[held..]) {
            *best = waits.max(*held);
        }
        let stays = self.paid(slice, self.day.vertiport(place));
        let flights = self.day.flights(slice, self.layer, place);
        let earned = &self.earned[self.day.positions(slice, self.layer, place)];
        for (flight, earned) in flights.iter().zip(earned) {
            let flies = earned + self.paid(slice, flight.to.at()) - stays;
            let to = at(self.day.place(flight.to.at(), flight.level), flight.block_s);
            if flies + self.worths[to] > best[last] {
                raise_to(best, &self.worths[to..], flies);
            }
        }
        self.worths[own..own + best.len()].copy_from_slice(best);
    }

    /// Raises each entry of `best` to the worth of another choice: `gain`, plus the worth at `to`
    /// from `ready` on. Before `past_slot` nothing more has to be paid there.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
    fn raise(&self, best: &mut [i64], to: usize, ready: usize, past_slot: usize, gain: i64) {
        let ready = ready.min(self.day.slices.day_s() as usize);
        let (within, beyond) = best.split_at_mut(past_slot.saturating_sub(ready).min(best.len()));
        let at = to * self.stride + ready;
        if !within.is_empty() {
            raise_to(within, &self.within_slot[at..], gain);
        }
        let at = at + within.len();
        raise_to(beyond, &self.worths[at..], gain);
    }
}

/// Raises each entry to `gain` plus a worth.
#[inline(always)]
#[expect(clippy::inline_always, reason = "the vectors' width is chosen outside")]
fn raise_to(best: &mut [i64], worths: &[i64], gain: i64) {
    for (best, worth) in best.iter_mut().zip(worths) {
        *best = (*best).max(gain + worth);
    }
}

/// Being ready is worth no less than being ready a second later at the same vertiport: apart from
/// the price of the stand, waiting is free. `later` is the worth after the last of these seconds.
fn wait_freely(worths: &mut [i64], mut later: i64) {
    for worth in worths.iter_mut().rev() {
        later = later.max(*worth);
        *worth = later;
    }
}

/// The amount that is given back: the price of all stands, and the surplus of all passengers.
fn dual_constant(day: &TimeExpandedDay, prices: &Prices) -> i128 {
    let stands = day.stands.iter().zip(&prices.stand);
    let stands = stands.map(|(&count, &price)| i128::from(count) * i128::from(price));
    stands.sum::<i128>() + day.market.surplus(&prices.flight)
}
