//! What one aircraft does all day, in the slices of a bound, or what passengers buy all day.

use std::ops::Range;

use super::market::Market;
use super::time_expanded_day::Flight;

/// An itinerary through the day for one aircraft, or the flights that some passengers buy.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Itinerary {
    /// The earnings apart from the prices of flights and stands, micro-dollars: of an aircraft,
    /// minus the cost of its flights; of passengers, what they bring.
    pub(super) earnings: f64,
    /// The stays of the aircraft, one after the other, each as the slice before which it ends and
    /// its vertiport: the one where the aircraft is, or flies to, when slices end.
    pub(super) stays: Vec<(u32, u32)>,
    /// The position of the price of each flight, and how many of them are sold; those that are
    /// bought have a minus.
    pub(super) flights: Vec<(u32, f64)>,
    /// The seconds of charging that it uses, by period from `charges_from` on, which is the
    /// position of a price. Empty on days that charge to full.
    pub(super) charging_s: Vec<f64>,
    pub(super) charges_from: u32,
}

impl Itinerary {
    /// The purchases of the passengers of a part of the market at these prices. They take no
    /// stands.
    pub(super) fn of_buyers(market: &Market, block: usize, prices: &[i64]) -> Self {
        let (surplus, bought) = market.buy(block, prices, None);
        let paid = |&(at, number): &(u32, f64)| number * prices[at as usize] as f64;
        let earnings = surplus as f64 + bought.iter().map(paid).sum::<f64>();
        let flights = bought.into_iter().map(|(at, number)| (at, -number)).collect();
        Self { earnings, flights, ..Self::default() }
    }

    /// The itinerary of a battery that keeps some seconds of charging from one period, given by the
    /// position of its price, to the next.
    pub(super) fn of_store(at: usize, kept_s: f64) -> Self {
        let charges_from = u32::try_from(at).expect("a day has few prices of charging");
        Self { charging_s: vec![kept_s, -kept_s], charges_from, ..Self::default() }
    }

    /// Adds a flight.
    pub(super) fn fly(&mut self, flight: &Flight) {
        self.earnings -= flight.cost as f64;
        self.flights.push((flight.sold_at, 1.0));
    }

    /// Adds seconds of charging that are used at the price at a position.
    pub(super) fn charge(&mut self, (at, seconds): (usize, u32)) {
        self.charging_s[at - self.charges_from as usize] += f64::from(seconds);
    }

    /// The positions of the prices of charging and the seconds that are used at them.
    pub(super) fn charging(&self) -> impl Iterator<Item = (usize, f64)> {
        (self.charges_from as usize..).zip(self.charging_s.iter().copied())
    }

    /// Adds a stay: the aircraft is at a vertiport, or flies there, at the ends of these slices.
    pub(super) fn stay(&mut self, place: usize, slices: Range<usize>) {
        let position = |at: usize| u32::try_from(at).expect("a day has few slices and vertiports");
        if !slices.is_empty() {
            self.stays.push((position(slices.end), position(place)));
        }
    }

    /// The slices and the vertiport of each stay.
    pub(super) fn stays(&self) -> impl Iterator<Item = (Range<usize>, usize)> {
        let mut begin = 0;
        self.stays.iter().map(move |&(until, place)| {
            let slices = begin..until as usize;
            begin = slices.end;
            (slices, place as usize)
        })
    }

    /// The slices in which this itinerary and another are at different vertiports, with the
    /// vertiport of this one and of the other, in order.
    pub(super) fn apart(&self, other: &Self) -> impl Iterator<Item = (Range<usize>, usize, usize)> {
        let (mut one, mut two, mut begin) = (0, 0, 0);
        std::iter::from_fn(move || {
            loop {
                let (&(one_until, here), &(two_until, there)) =
                    (self.stays.get(one)?, other.stays.get(two)?);
                let until = one_until.min(two_until);
                one += usize::from(one_until == until);
                two += usize::from(two_until == until);
                let slices = begin as usize..until as usize;
                begin = until;
                if here != there {
                    return Some((slices, here as usize, there as usize));
                }
            }
        })
    }
}
