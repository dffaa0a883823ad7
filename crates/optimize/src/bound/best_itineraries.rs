//! What the fleet would do at given prices: every aircraft takes the itinerary through the day that is worth most to
//! it. Where more or less is then asked for than is available, prices should rise or fall.

use super::certificate::{Certificate, earnings};
use super::itinerary::Itinerary;
use super::prices::Prices;
use super::time_expanded_day::{Flight, Start, TimeExpandedDay};

/// A day at the prices that its certificate was evaluated with last.
pub(super) struct BestItineraries<'a> {
    pub(super) day: &'a TimeExpandedDay,
    pub(super) prices: &'a Prices,
    pub(super) certificate: &'a Certificate,
}

impl BestItineraries<'_> {
    /// The best itinerary of each group, which is the aircraft of one layer that start alike, and their number.
    pub(super) fn of_groups(&self) -> Vec<(u32, Itinerary)> {
        let layers = self.day.layers.iter().enumerate();
        let groups =
            layers.flat_map(|(layer, kind)| kind.starts.iter().map(move |start| (layer, start)));
        groups.map(|(layer, start)| (start.count, self.itinerary(layer, start))).collect()
    }

    fn itinerary(&self, layer: usize, start: &Start) -> Itinerary {
        let slices = &self.day.slices;
        let day_s = slices.day_s();
        let mut itinerary = Itinerary { earnings: 0.0, stays: Vec::new(), flights: Vec::new() };
        let (mut at, mut second) = (start.at, start.ready_s);
        let mut slice = slices.containing(slices.start_s(0) + second.min(day_s));
        itinerary.stay(at, 0..slice);
        while slice < slices.len() {
            let leaves = self.waits_until(layer, at, second);
            if leaves > second {
                second = leaves;
            } else if let Some(flight) = self.best_flight(layer, at, second, slice) {
                let margin = self.day.margin[flight.cell as usize] as f64;
                itinerary.earnings += f64::from(flight.passengers) * margin - flight.cost as f64;
                itinerary.flights.push((flight.cell, flight.passengers));
                at = flight.to.at();
                second += flight.block_s;
            } else {
                second += self.day.hold_s;
            }
            let until = slices.containing(slices.start_s(0) + second.min(day_s));
            itinerary.stay(at, slice..until);
            slice = until;
        }
        itinerary
    }

    fn worth_less_paid(&self, layer: usize, at: usize, second: u32) -> i64 {
        self.certificate.worth_less_paid(self.day, layer, at, second as usize)
    }

    /// The second until which an aircraft that may wait freely does so: as long as being ready later is worth as much.
    fn waits_until(&self, layer: usize, at: usize, mut second: u32) -> u32 {
        let worth = |second| self.worth_less_paid(layer, at, second);
        while self.day.layers[layer].waits_freely
            && second < self.day.slices.day_s()
            && worth(second) == worth(second + 1)
        {
            second += 1;
        }
        second
    }

    /// The first flight in file order whose worth equals that of being ready at a vertiport, second and slice.
    fn best_flight(&self, layer: usize, at: usize, second: u32, slice: usize) -> Option<&Flight> {
        let paid = |at| self.certificate.paid(self.day, slice, at);
        let here = self.worth_less_paid(layer, at, second) + paid(at);
        self.day.flights(slice, layer, at).iter().find(|flight| {
            let to = flight.to.at();
            let goes_on = self.worth_less_paid(layer, to, second + flight.block_s);
            here == earnings(self.day, self.prices, flight) + paid(to) + goes_on
        })
    }
}
