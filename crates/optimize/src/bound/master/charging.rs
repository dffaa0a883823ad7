//! The charging time in the model: seconds that are used in each demand period, and their prices.

use super::super::charging_time::MOST_A_SECOND;
use super::super::itinerary::Itinerary;
use super::super::prices::whole;
use super::super::time_expanded_day::TimeExpandedDay;

/// Seconds of a slice in which the price of a stand moves at a pace of 1: an aircraft that charges
/// in all of a period counts as one that stands there.
const SLICE_S: f64 = 900.0;

/// The prices of charging of a model. There are none on days that charge to full.
pub(super) struct ChargingPrices {
    /// The seconds used less those that there are, and the model's prices, by type, then period.
    excess_s: Vec<f64>,
    prices: Vec<f64>,
    /// The seconds that there are.
    supply_s: Vec<f64>,
    /// By price: micro-dollars by which it moves for a second in excess, at a reach of 1.
    pace: Vec<f64>,
}

impl ChargingPrices {
    pub(super) fn of(day: &TimeExpandedDay, centre: &[i64]) -> Self {
        let lengths = (0..centre.len()).map(|at| f64::from(day.charging.length_s(at)));
        let mut made = Self {
            excess_s: vec![0.0; centre.len()],
            prices: centre.iter().map(|&price| price as f64).collect(),
            supply_s: vec![0.0; centre.len()],
            pace: lengths.map(|length_s| 1.0 / (SLICE_S * length_s)).collect(),
        };
        made.count_supply(day);
        made
    }

    /// Counts the seconds that aircraft have: while operations last, and at their start.
    fn count_supply(&mut self, day: &TimeExpandedDay) {
        for layer in &day.layers {
            let own = day.charging.of_kind(layer.kind);
            for start in &layer.starts {
                let count = f64::from(start.count);
                for at in own.clone().take(self.supply_s.len()) {
                    self.supply_s[at] += count * f64::from(day.charging.length_s(at));
                }
                if let Some(first_s) = self.supply_s.get_mut(own.start) {
                    *first_s += count * start.charged_s as f64;
                }
            }
        }
    }

    /// Begins to count the seconds in excess again.
    pub(super) fn clear(&mut self) {
        for (excess_s, supply_s) in self.excess_s.iter_mut().zip(&self.supply_s) {
            *excess_s = -supply_s;
        }
    }

    /// Counts the seconds that some aircraft use on an itinerary.
    #[inline]
    pub(super) fn add(&mut self, itinerary: &Itinerary, aircraft: f64) {
        for (at, seconds) in itinerary.charging() {
            self.excess_s[at] += aircraft * seconds;
        }
    }

    /// Moves the prices from those of the centre by the excess.
    pub(super) fn reprice(&mut self, centre: &[i64], reach: f64) {
        for at in 0..self.prices.len() {
            self.prices[at] = self.price(at, centre, reach);
        }
    }

    fn price(&self, at: usize, centre: &[i64], reach: f64) -> f64 {
        let moved = reach * self.pace[at] * self.excess_s[at];
        (centre[at] as f64 + moved).clamp(0.0, MOST_A_SECOND as f64)
    }

    /// Counts the seconds of an itinerary and reprices them.
    #[inline]
    pub(super) fn shift(
        &mut self,
        itinerary: &Itinerary,
        aircraft: f64,
        (centre, reach): (&[i64], f64),
    ) {
        for (at, seconds) in itinerary.charging() {
            self.excess_s[at] += aircraft * seconds;
            self.prices[at] = self.price(at, centre, reach);
        }
    }

    /// What an aircraft pays on an itinerary.
    #[inline]
    pub(super) fn payment(&self, itinerary: &Itinerary) -> f64 {
        let prices = &self.prices[itinerary.charges_from as usize..];
        prices.iter().zip(&itinerary.charging_s).map(|(price, seconds)| price * seconds).sum()
    }

    /// The rate at which the bound would fall with the reach if the excess stayed the same.
    pub(super) fn fall(&self, centre: &[i64]) -> f64 {
        let falls = self.excess_s.iter().zip(centre).zip(&self.pace);
        let falls = falls.map(|((&excess_s, &price), pace)| {
            let stuck = if excess_s < 0.0 { price <= 0 } else { price >= MOST_A_SECOND };
            if stuck { 0.0 } else { pace * excess_s * excess_s }
        });
        falls.sum()
    }

    /// By how much a shift from one itinerary to another is worth less for each aircraft that has
    /// shifted, through the prices that are not at a limit, at a reach of 1.
    pub(super) fn resistance(&self, from: &Itinerary, to: &Itinerary) -> f64 {
        let is_free = |at: usize| self.prices[at] > 0.0 && self.prices[at] < MOST_A_SECOND as f64;
        // Both are of one group, and so of the same prices.
        let pairs = from.charging().zip(&to.charging_s).filter(|((at, _), _)| is_free(*at));
        pairs.map(|((at, leaves_s), takes_s)| self.pace[at] * (takes_s - leaves_s).powi(2)).sum()
    }

    /// The worth of all seconds that there are.
    pub(super) fn value(&self) -> f64 {
        self.supply_s.iter().zip(&self.prices).map(|(seconds, price)| seconds * price).sum()
    }

    /// The prices, in whole micro-dollars.
    pub(super) fn write(&self, to: &mut [i64]) {
        for (to, &price) in to.iter_mut().zip(&self.prices) {
            *to = whole(price);
        }
    }
}
