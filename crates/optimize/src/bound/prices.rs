//! Prices: those of a stand when a slice ends and of a second of charging, which aircraft pay, and
//! that of a flight, which passengers pay.
//!
//! Any prices within the limits of this file prove a bound (`certificate.rs`); good ones prove a
//! tight one.

use super::charging_time::MOST_A_SECOND;
use super::slices::Slices;
use super::time_expanded_day::TimeExpandedDay;

/// The most that a stand may cost in a slice, micro-dollars. It keeps every sum of `certificate.rs`
/// within `i64`.
pub(super) const MOST_FOR_A_STAND: i64 = 100_000_000_000_000;

/// Pace of the price of a flight of one seat, relative to that of a stand in a slice of a quarter
/// of an hour.
pub(super) const PACE_OF_A_SEAT: f64 = 0.2;

/// Prices in whole micro-dollars.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Prices {
    /// Price that an aircraft pays for its stand when a slice ends, by slice, then vertiport.
    pub(super) stand: Vec<i64>,
    /// Price of a flight, by period, from, to; of each, before and after those have left who waited
    /// for it, if passengers wait; of each, by number of seats. No more than a flight can bring.
    pub(super) flight: Vec<i64>,
    /// Price of a second of charging, by type, then demand period; none on days that charge to
    /// full.
    pub(super) charging: Vec<i64>,
}

impl Prices {
    /// Free stands, and every flight at its highest price.
    pub(super) fn first(day: &TimeExpandedDay) -> Self {
        let flight = (0..day.market.prices()).map(|position| day.market.most(position));
        Self {
            stand: vec![0; day.slices.len() * day.size()],
            flight: flight.collect(),
            charging: vec![0; day.charging.prices()],
        }
    }

    /// The prices of a file or of another day, if they are valid prices for this day.
    pub(super) fn checked(self, day: &TimeExpandedDay) -> Option<Self> {
        let Self { stand, flight, charging } = &self;
        let lengths = stand.len() == day.slices.len() * day.size()
            && flight.len() == day.market.prices()
            && charging.len() == day.charging.prices();
        let within =
            |(position, price): (usize, &i64)| (0..=day.market.most(position)).contains(price);
        let within = stand.iter().all(|price| (0..=MOST_FOR_A_STAND).contains(price))
            && charging.iter().all(|price| (0..=MOST_A_SECOND).contains(price))
            && lengths
            && flight.iter().enumerate().all(within);
        within.then_some(self)
    }

    /// The same prices in other slices of the same day. The price of a stand in a slice is spread
    /// evenly over its seconds, so that the rent of a long stay is unchanged.
    pub(super) fn in_slices(&self, from: &Slices, to: &Slices, size: usize) -> Self {
        let mut stand = Vec::with_capacity(to.len() * size);
        for slice in 0..to.len() {
            let (start_s, past_s) = (to.start_s(slice), to.start_s(slice + 1));
            for at in 0..size {
                let parts = (from.containing(start_s)..=from.containing(past_s - 1)).map(|old| {
                    let (begins_s, ends_s) = (from.start_s(old), from.start_s(old + 1));
                    let shared_s = past_s.min(ends_s) - start_s.max(begins_s);
                    self.stand[old * size + at] as f64 * f64::from(shared_s)
                        / f64::from(ends_s - begins_s)
                });
                stand.push(whole(parts.sum()).clamp(0, MOST_FOR_A_STAND));
            }
        }
        Self { stand, flight: self.flight.clone(), charging: self.charging.clone() }
    }
}

/// The pace at which prices move. A stand's price in a slice moves in proportion to the length of
/// the slice, so that the rent of a stay moves equally fast in slices of any length.
#[derive(Debug, Clone)]
pub(super) struct Pace {
    /// The pace of a stand's price, by slice.
    stand: Vec<f64>,
}

impl Pace {
    pub(super) fn of(slices: &Slices) -> Self {
        let pace = |slice| f64::from(slices.start_s(slice + 1) - slices.start_s(slice)) / 900.0;
        Self { stand: (0..slices.len()).map(pace).collect() }
    }

    /// The pace of a stand's price in a slice.
    pub(super) fn of_stands(&self, slice: usize) -> f64 {
        self.stand[slice]
    }
}

#[expect(clippy::cast_possible_truncation, reason = "`as` saturates, and limits follow")]
pub(super) fn whole(micro: f64) -> i64 {
    micro.round() as i64
}
