//! The penalty of a day, from the worths of an expected day: v is the worth of an aircraft that
//! decides at a vertiport at a second if its flights have a given delay, and all is as expected
//! afterwards.

use vertifleet_core::{Scenario, TakeoffDelays, TypeIx};

use super::Penalty;
use crate::bound::certificate::Certificate;
use crate::bound::prices::whole;
use crate::bound::time_expanded_day::TimeExpandedDay;

/// v is worked out for this many delays from none to the longest, and is a straight line between
/// two of them.
const DELAYS: u32 = 30;
/// v is within this distance of its value without delay, micro-dollars, so that no sum leaves
/// `i64`.
const FARTHEST: i64 = 100_000_000_000_000;

/// A day that is expected, with the certificate of the prices that were found for it.
pub(in crate::bound) struct Expected<'a> {
    pub(in crate::bound) scenario: &'a Scenario,
    pub(in crate::bound) day: &'a TimeExpandedDay,
    pub(in crate::bound) certificate: &'a Certificate,
}

impl Penalty {
    /// The penalty for a day with these delays, which are drawn with these probabilities, by
    /// vertiport and seconds.
    pub(in crate::bound) fn of(
        delays: &TakeoffDelays,
        probabilities: &[Vec<f64>],
        expected: &Expected<'_>,
    ) -> Self {
        let slots_s = slots_s(expected.day, delays);
        let day_s = expected.day.slices.day_s();
        let vertiports = expected.day.size();
        let mut micro_usd =
            Vec::with_capacity(expected.day.layers.len() * vertiports * day_s as usize);
        for layer in 0..expected.day.layers.len() {
            for (at, probabilities) in probabilities.iter().enumerate() {
                let spread = Spread::of(probabilities);
                for (slot, delays_s) in delays.delay_s.iter().enumerate() {
                    let seconds = slots_s[slot]..slots_s[slot + 1];
                    let worths = expected.worths(layer, at, &spread, (seconds.start, seconds.end));
                    micro_usd.extend(spread.payments(&worths, delays_s[at]));
                }
            }
        }
        let kinds = kinds(expected.day);
        Self { kinds, vertiports, slots_s, micro_usd }
    }

    /// The penalty with these payments, by their position.
    #[cfg(test)]
    pub(in crate::bound) fn from_payments(
        day: &TimeExpandedDay,
        delays: &TakeoffDelays,
        payment: impl Fn(usize) -> i64,
    ) -> Self {
        let (kinds, vertiports, slots_s) = (kinds(day), day.size(), slots_s(day, delays));
        let payments = kinds.len() * vertiports * day.slices.day_s() as usize;
        Self { kinds, vertiports, slots_s, micro_usd: (0..payments).map(payment).collect() }
    }
}

/// The first second of each slot, and the second after the last one.
fn slots_s(day: &TimeExpandedDay, delays: &TakeoffDelays) -> Vec<u32> {
    let day_s = day.slices.day_s();
    (0..day_s).step_by(delays.slot_s as usize).chain([day_s]).collect()
}

/// The types of a fleet; aircraft with an outage are no separate type.
fn kinds(day: &TimeExpandedDay) -> Vec<TypeIx> {
    let mut kinds: Vec<TypeIx> = day.layers.iter().map(|layer| layer.kind).collect();
    kinds.dedup();
    kinds
}

/// The delays that v is worked out for.
struct Spread {
    /// From one to the next, seconds, at least 1.
    apart_s: u32,
    /// The longest delay that may be drawn.
    longest_s: u32,
    /// The weight of each in the mean of v; v is a straight line between two of them.
    weights: Vec<f64>,
}

impl Spread {
    fn of(probabilities: &[f64]) -> Self {
        let longest_s = u32::try_from(probabilities.len() - 1).expect("delays are of hours");
        let apart_s = longest_s.div_ceil(DELAYS).max(1);
        let mut weights = vec![0.0; longest_s.div_ceil(apart_s) as usize + 1];
        for (delay_s, probability) in (0..).zip(probabilities) {
            let (before, share) = split(delay_s, apart_s);
            weights[before] += probability * (1.0 - share);
            if share > 0.0 {
                weights[before + 1] += probability * share;
            }
        }
        Self { apart_s, longest_s, weights }
    }

    /// The payments, by second, if v has these `worths`, by delay and second, and the delay is
    /// `delay_s`. They are rounded down, and by more than the error of floating-point numbers.
    fn payments(&self, worths: &[Vec<i64>], delay_s: u32) -> impl Iterator<Item = i64> {
        let (before, share) = split(delay_s.min(self.longest_s), self.apart_s);
        let never = self.weights.len() == 1;
        (0..worths[0].len()).map(move |second| {
            if never {
                return 0;
            }
            let beyond = |at: usize| {
                (worths[at][second] - worths[0][second]).clamp(-FARTHEST, FARTHEST) as f64
            };
            let mean: f64 =
                self.weights.iter().enumerate().map(|(at, weight)| weight * beyond(at)).sum();
            let after = if share > 0.0 { beyond(before + 1) } else { 0.0 };
            let paid = beyond(before) * (1.0 - share) + after * share - mean;
            whole((paid - paid.abs() * 1e-9).floor()) - 1
        })
    }
}

/// The last delay worked out that is no longer, and how far the delay is from it towards the next.
fn split(delay_s: u32, apart_s: u32) -> (usize, f64) {
    let rest_s = delay_s % apart_s;
    ((delay_s / apart_s) as usize, f64::from(rest_s) / f64::from(apart_s))
}

impl Expected<'_> {
    /// The worth, less the price of the stand since the day began, of deciding at a vertiport at
    /// each second of a slot if its flights are so late, by delay and second. Afterwards all is as
    /// expected.
    fn worths(&self, layer: usize, at: usize, spread: &Spread, slot: (u32, u32)) -> Vec<Vec<i64>> {
        let seconds = (slot.1 - slot.0) as usize;
        let delays_s = (0_u32..).step_by(spread.apart_s as usize).take(spread.weights.len());
        let worths = delays_s.map(|delay_s| {
            let mut worths = vec![i64::MIN; seconds];
            self.work_out(layer, at, delay_s, slot, &mut worths);
            worths
        });
        worths.collect()
    }

    fn work_out(
        &self,
        layer: usize,
        at: usize,
        delay_s: u32,
        slot: (u32, u32),
        worths: &mut [i64],
    ) {
        let Self { day, certificate, .. } = *self;
        let slices = &day.slices;
        let first_s = slices.start_s(0);
        let expected_s = self.delay_s(at, slot.0);
        let hold = day.hold_s as usize;
        // No hold and no flight begins and ends in the same piece.
        let longest = day.shortest_s;
        let mut past = slot.1;
        while past > slot.0 {
            let slice = slices.containing(first_s + past - 1);
            let begin =
                slot.0.max(past.saturating_sub(longest)).max(slices.start_s(slice) - first_s);
            let (from, to) = ((begin - slot.0) as usize, (past - slot.0) as usize);
            for second in from..to {
                let until = second + hold;
                worths[second] = worths.get(until).copied().unwrap_or_else(|| {
                    certificate.worth_less_paid(day, layer, at, slot.0 as usize + until)
                });
            }
            let stays = certificate.paid(day, slice, at);
            let positions = day.positions(slice, layer, at);
            for (position, flight) in positions.zip(day.flights(slice, layer, at)) {
                let to_at = flight.to.at();
                let earned = certificate.earned(position);
                let flies = earned + certificate.paid(day, slice, to_at) - stays;
                let ready = begin + flight.block_s - expected_s + delay_s;
                let onward = certificate.worths_less_paid(day, layer, to_at, ready as usize);
                for (worth, onward) in worths[from..to].iter_mut().zip(onward) {
                    *worth = (*worth).max(flies + onward);
                }
            }
            past = begin;
        }
    }

    /// The delay that is expected of flights from a vertiport that are decided in a slot, seconds.
    fn delay_s(&self, at: usize, second: u32) -> u32 {
        let delays = self.scenario.disturbances.takeoff_delays.as_ref();
        delays.map_or(0, |delays| delays.delay_s[(second / delays.slot_s) as usize][at])
    }
}

#[cfg(test)]
mod tests {
    use super::Spread;

    #[test]
    fn payments_are_zero_on_the_mean_but_for_rounding() {
        for longest_s in [1, 29, 30, 31, 900, 4_001] {
            let shares: Vec<f64> =
                (0..=longest_s).map(|delay_s| f64::from(delay_s % 7 + 1)).collect();
            let all: f64 = shares.iter().sum();
            let probabilities: Vec<f64> = shares.iter().map(|share| share / all).collect();
            let spread = Spread::of(&probabilities);
            let worth = |delay: i64| 5_000_000_000 - 1_234_567 * delay.pow(2);
            let worths: Vec<Vec<i64>> =
                (0..).map(|delay| vec![worth(delay); 2]).take(spread.weights.len()).collect();
            let payment =
                |delay_s: u32| spread.payments(&worths, delay_s).next().expect("two seconds");
            let mean: f64 = probabilities
                .iter()
                .zip(0..)
                .map(|(share, delay_s)| share * payment(delay_s) as f64)
                .sum();
            assert!((-5.0..=0.0).contains(&mean), "{longest_s} s: {mean} micro-dollars");
            assert!(payment(0) > payment(longest_s), "being late is worse");
        }
    }
}
