//! The best itineraries of the fleet at given prices: every aircraft takes the itinerary through
//! the day that is worth most to it. Where the fleet then asks for more or less than is available,
//! prices should rise or fall.

use super::certificate::Certificate;
use super::charge_levels::Level;
use super::itinerary::Itinerary;
use super::prices::Prices;
use super::time_expanded_day::{Flight, Start, TimeExpandedDay};

/// A day at the prices that its certificate was evaluated with last.
pub(super) struct BestItineraries<'a> {
    pub(super) day: &'a TimeExpandedDay,
    pub(super) prices: &'a Prices,
    pub(super) certificate: &'a Certificate,
}

/// An aircraft of a layer that is ready at a vertiport.
#[derive(Debug, Clone, Copy)]
struct Ready {
    layer: usize,
    at: usize,
    level: Level,
    second: u32,
    /// Whether it still has to pay for knowing the delays of the slot, because it did not decide in
    /// it before.
    owes: bool,
}

impl BestItineraries<'_> {
    /// The best itinerary of each group, which is the aircraft of one layer that start alike, and
    /// their number. Where passengers choose between flights with several prices, those of each
    /// part of the market are a group too, and on days that charge as needed the batteries of a
    /// type from one period to the next.
    pub(super) fn of_groups(&self) -> Vec<(u32, Itinerary)> {
        let layers = self.day.layers.iter().enumerate();
        let groups =
            layers.flat_map(|(layer, kind)| kind.starts.iter().map(move |start| (layer, start)));
        let aircraft = groups.map(|(layer, start)| (start.count, self.itinerary(layer, start)));
        let market = &self.day.market;
        let buyers = market.blocks_that_choose();
        let buyers =
            buyers.map(|block| (1, Itinerary::of_buyers(market, block, &self.prices.flight)));
        let stores = self.day.charging.stores(&self.prices.charging);
        aircraft.chain(buyers).chain(stores).collect()
    }

    fn itinerary(&self, layer: usize, start: &Start) -> Itinerary {
        let slices = &self.day.slices;
        let day_s = slices.day_s();
        let prices = self.day.charging.of_kind(self.day.layers[layer].kind);
        let charges_from = u32::try_from(prices.start).expect("a day has few prices");
        let charging_s = vec![0.0; prices.len()];
        let mut itinerary = Itinerary { charging_s, charges_from, ..Itinerary::default() };
        let Start { at, level, ready_s: second, .. } = *start;
        let mut ready = Ready { layer, at, level, second, owes: true };
        let mut slice = slices.containing(slices.start_s(0) + ready.second.min(day_s));
        itinerary.stay(ready.at, 0..slice);
        while slice < slices.len() {
            let waits = self.waits(ready);
            if waits.second > ready.second {
                ready = waits;
            } else {
                let payment = self.payment(ready);
                itinerary.earnings -= payment as f64;
                ready = if let Some((position, flight)) = self.best_flight(ready, payment, slice) {
                    itinerary.fly(flight);
                    if let Some(used) = self.day.uses().get(position) {
                        used.at(&self.prices.charging)
                            .into_iter()
                            .for_each(|used| itinerary.charge(used));
                    }
                    self.goes_on(ready, (flight.to.at(), flight.level), flight.block_s)
                } else {
                    let place = self.day.place(ready.at, ready.level);
                    let held = self.day.held(ready.layer, place) - self.day.place(ready.at, 0);
                    let level = Level::try_from(held).expect("there are few levels");
                    self.goes_on(ready, (ready.at, level), self.day.hold_s)
                };
            }
            let until = slices.containing(slices.start_s(0) + ready.second.min(day_s));
            itinerary.stay(ready.at, slice..until);
            slice = until;
        }
        itinerary
    }

    /// The worth of being ready, less the price of the stand since the day began.
    fn worth_less_paid(&self, Ready { layer, at, level, second, owes }: Ready) -> i64 {
        let (place, second) = (self.day.place(at, level), second as usize);
        if owes {
            self.certificate.worth_less_paid(self.day, layer, place, second)
        } else {
            self.certificate.worth_within_slot(self.day, layer, place, second)
        }
    }

    /// The payment of an aircraft for knowing the delays of its slot when it decides.
    fn payment(&self, ready: Ready) -> i64 {
        let penalty = self.day.penalty.as_ref().filter(|_| ready.owes);
        penalty.map_or(0, |penalty| {
            penalty.at(self.day.layers[ready.layer].kind, ready.at)[ready.second as usize]
        })
    }

    /// An aircraft that decided when it was `ready`, `seconds` later.
    fn goes_on(&self, ready: Ready, (at, level): (usize, Level), seconds: u32) -> Ready {
        let second = ready.second + seconds;
        let penalty = self.day.penalty.as_ref();
        let past_slot = penalty.map_or(0, |penalty| penalty.past_slot(ready.second as usize));
        Ready { at, level, second, owes: second as usize >= past_slot, ..ready }
    }

    /// An aircraft that may wait freely after it has waited for as long as being ready later is
    /// worth as much.
    fn waits(&self, mut ready: Ready) -> Ready {
        while self.day.layers[ready.layer].waits_freely && ready.second < self.day.slices.day_s() {
            let later = self.goes_on(ready, (ready.at, ready.level), 1);
            let later = Ready { owes: later.owes || ready.owes, ..later };
            if self.worth_less_paid(ready) != self.worth_less_paid(later) {
                break;
            }
            ready = later;
        }
        ready
    }

    /// The first flight in file order whose worth equals that of being ready in a slice, after a
    /// payment.
    fn best_flight(&self, ready: Ready, payment: i64, slice: usize) -> Option<(usize, &Flight)> {
        let paid = |at| self.certificate.paid(self.day, slice, at);
        let here = self.worth_less_paid(ready) + payment + paid(ready.at);
        let place = self.day.place(ready.at, ready.level);
        let positions = self.day.positions(slice, ready.layer, place);
        let flights = self.day.flights(slice, ready.layer, place);
        positions.zip(flights).find(|&(position, flight)| {
            let to = flight.to.at();
            let next = self.goes_on(ready, (to, flight.level), flight.block_s);
            let goes_on = self.worth_less_paid(next);
            here == self.certificate.earned(position) + paid(to) + goes_on
        })
    }
}
