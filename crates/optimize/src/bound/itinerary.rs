//! What one aircraft does all day, in the slices of a bound.

use std::ops::Range;

use super::certificate::parties;
use super::prices::Prices;
use super::time_expanded_day::{Flight, TimeExpandedDay};

/// An itinerary through the day for one aircraft.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Itinerary {
    /// The profit of its flights before payments, micro-dollars.
    pub(super) earnings: f64,
    /// The stays of the aircraft, one after the other, each as the slice before which it ends and its vertiport: the
    /// one where the aircraft is, or flies to, when slices end.
    pub(super) stays: Vec<(u32, u32)>,
    /// For the passengers of each flight, their position in [`TimeExpandedDay::demand`] and their number. A flight that
    /// passengers of two periods may board has an entry for each.
    pub(super) flights: Vec<(u32, u32)>,
}

impl Itinerary {
    /// Adds a flight, with the passengers with whom it earns the most at the prices.
    pub(super) fn fly(&mut self, day: &TimeExpandedDay, prices: &Prices, flight: &Flight) {
        let margin = day.margin[flight.cell as usize] as f64;
        let mut on_board = 0;
        for party in parties(day, prices, flight) {
            self.flights.push((party.cell, party.passengers.into()));
            on_board += u32::from(party.passengers);
        }
        self.earnings += f64::from(on_board) * margin - flight.cost as f64;
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

    /// The slices in which this itinerary and another are at different vertiports, with the vertiport of this one and
    /// of the other, in order.
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
