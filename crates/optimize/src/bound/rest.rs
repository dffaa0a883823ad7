//! The rest of a day while its aircraft are planned one after another, and its prices.
//!
//! The prices come from the same search as those of a bound, on the coarse clock, in slices as fine
//! as time allows. They prove nothing. Once an aircraft has been planned, its stands and passengers
//! are gone, and a few more steps of the search find the prices of the rest.

use std::ops::Range;

use vertifleet_core::{AircraftIx, Scenario, Stop, VertiportIx};

use super::descent::{Bundle, Descent};
use super::itinerary::Itinerary;
use super::ladder::{CUTS, Cut, TICK_S};
use super::market::Part;
use super::master::Groups;
use super::money;
use super::prices::{Pace, Prices};
use super::slices::Slices;
use super::time_expanded_day::{Start, TimeExpandedDay};

/// The least price of a stand in a slice where none is left, micro-dollars: far more than flights
/// gain in a minute on the shipped networks.
const NONE_LEFT: i64 = 300_000_000;

/// The way of an aircraft through the day.
pub(crate) struct Way {
    pub(crate) start: VertiportIx,
    /// The second of each take-off, and the vertiport that it is towards.
    pub(crate) flights: Vec<(u32, VertiportIx)>,
}

/// The rest of a day, and its prices.
#[derive(Debug, Clone)]
pub(crate) struct Rest {
    day: TimeExpandedDay,
    /// The slices in seconds, while those of `day` are on the coarse clock.
    slices: Slices,
    pace: Pace,
    prices: Prices,
    groups: Groups,
    /// The group of each aircraft.
    group_of: Vec<usize>,
    /// The number of groups of aircraft. Those of passengers follow, and then those of batteries.
    aircraft_groups: usize,
}

impl Rest {
    /// A whole day, with prices. `allows` is asked with the number of steps so far: before each cut
    /// also with the most that it takes, and with 0 after each step. The prices are as fine as it
    /// allows. Returns `None` if the day is too large, or `stopped` is requested before the prices
    /// are found.
    pub(crate) fn of(
        scenario: &Scenario,
        stopped: &Stop,
        allows: &mut dyn FnMut(u32, u32) -> bool,
    ) -> Option<Self> {
        let mut found: Option<Self> = None;
        let mut steps = 0;
        for Cut { step, on_coarse_clock: descent, .. } in &CUTS {
            if !allows(steps, descent.steps) {
                break;
            }
            let Ok(day) = TimeExpandedDay::of(scenario, &[], step.seconds(), 1) else {
                break;
            };
            let day = day.on_coarse_clock(TICK_S);
            let slices = Slices::of(scenario, step.seconds());
            let start = match &found {
                None => Prices::first(&day),
                Some(coarser) => coarser.prices.in_slices(&coarser.slices, &slices, day.size()),
            };
            let pace = Pace::of(&slices);
            let mut bundle = Bundle::begin(*descent, (&day, &pace), &start, stopped)?;
            bundle.descend(*descent, stopped, &mut |_| {
                steps += 1;
                allows(steps, 0)
            });
            if stopped.is_requested() {
                return None;
            }
            let (prices, groups) = bundle.into_parts();
            let group_of = day.group_of.clone();
            let aircraft_groups = day.layers.iter().map(|layer| layer.starts.len()).sum();
            found = Some(Self { day, slices, pace, prices, groups, group_of, aircraft_groups });
        }
        found
    }

    /// The most steps that the search for the prices of a whole day takes.
    pub(crate) fn most_steps() -> u32 {
        CUTS.iter().map(|cut| cut.on_coarse_clock.steps).sum()
    }

    /// Of some aircraft, the one on whose itinerary the search agrees most.
    pub(crate) fn clearest(&self, of: impl Iterator<Item = AircraftIx>) -> Option<AircraftIx> {
        let agreed = |aircraft: AircraftIx| self.groups.agreed(self.group_of[aircraft.at()]);
        of.max_by(|&one, &other| agreed(one).total_cmp(&agreed(other)).then(other.cmp(&one)))
    }

    /// Takes an aircraft out that has been planned.
    pub(crate) fn remove(&mut self, aircraft: AircraftIx, way: &Way) {
        for at in self.stands_of(way) {
            self.day.stands[at] -= 1;
            if self.day.stands[at] == 0 {
                self.prices.stand[at] = self.prices.stand[at].max(NONE_LEFT);
            }
        }
        let group = self.group_of[aircraft.at()];
        self.groups.leave(group);
        self.stores_of(group).for_each(|store| self.groups.leave(store));
        self.start_of(group).count -= 1;
    }

    /// Brings an aircraft back that had been planned.
    pub(crate) fn take_back(&mut self, aircraft: AircraftIx, way: &Way) {
        for at in self.stands_of(way) {
            if self.day.stands[at] == 0 && self.prices.stand[at] >= NONE_LEFT {
                self.prices.stand[at] = 0;
            }
            self.day.stands[at] += 1;
        }
        let group = self.group_of[aircraft.at()];
        self.groups.come_back(group);
        self.stores_of(group).for_each(|store| self.groups.come_back(store));
        self.start_of(group).count += 1;
    }

    /// The groups of the batteries of the type of a group of aircraft.
    fn stores_of(&self, group: usize) -> Range<usize> {
        let mut groups = 0;
        let layer = self.day.layers.iter().find(|layer| {
            groups += layer.starts.len();
            group < groups
        });
        let stores = self.day.charging.stores_of(layer.expect("a group of aircraft").kind);
        let first = self.aircraft_groups + self.day.market.blocks_that_choose().count();
        first + stores.start..first + stores.end
    }

    fn start_of(&mut self, group: usize) -> &mut Start {
        let mut starts = self.day.layers.iter_mut().flat_map(|layer| &mut layer.starts);
        starts.nth(group).expect("a group of aircraft")
    }

    /// The positions of the prices of the stands that an aircraft takes.
    fn stands_of(&self, way: &Way) -> Vec<usize> {
        let (mut place, mut flights) = (way.start, way.flights.iter().peekable());
        let stand = |slice| {
            let last_s = self.slices.last_s(slice);
            while let Some(&(_, to)) = flights.next_if(|&&(take_off_s, _)| take_off_s <= last_s) {
                place = to;
            }
            slice * self.day.size() + place.at()
        };
        (0..self.slices.len()).map(stand).collect()
    }

    /// Finds the prices of the rest by a number of steps. `left` are the passengers who are left,
    /// by cell.
    pub(crate) fn price(&mut self, left: Vec<u32>, steps: u32, stopped: &Stop) {
        self.day.market.set_passengers(left);
        for (position, price) in self.prices.flight.iter_mut().enumerate() {
            *price = (*price).min(self.day.market.most(position));
        }
        let market = &self.day.market;
        for (group, block) in (self.aircraft_groups..).zip(market.blocks_that_choose()) {
            let buyers = Itinerary::of_buyers(market, block, &self.prices.flight);
            self.groups.replace_itineraries(group, buyers);
        }
        let groups = self.groups.clone();
        let bundle = Bundle::resume((&self.day, &self.pace), &self.prices, groups, stopped);
        if let Some(mut bundle) = bundle {
            let descent = Descent { steps, first: 0.0, enough: 0.0 };
            bundle.descend(descent, stopped, &mut |_| true);
            (self.prices, self.groups) = bundle.into_parts();
        }
    }

    /// The price of a stand from the start of the day to each of some moments in order, which are
    /// seconds; dollars.
    pub(crate) fn rents_usd(
        &self,
        vertiport: VertiportIx,
        until_s: impl Iterator<Item = u32>,
    ) -> impl Iterator<Item = f64> {
        let (slices, size) = (&self.slices, self.day.size());
        let price_usd =
            move |slice: usize| money::usd(self.prices.stand[slice * size + vertiport.at()]);
        let (mut slice, mut paid_usd) = (0, 0.0);
        until_s.map(move |until_s| {
            while slice < slices.len() && slices.start_s(slice + 1) <= until_s {
                paid_usd += price_usd(slice);
                slice += 1;
            }
            if slice == slices.len() {
                return paid_usd;
            }
            let (begins_s, ends_s) = (slices.start_s(slice), slices.start_s(slice + 1));
            let passed_s = until_s.saturating_sub(begins_s);
            paid_usd + price_usd(slice) * f64::from(passed_s) / f64::from(ends_s - begins_s)
        })
    }

    /// The price that passengers pay for a flight of a type in a cell, before or after those have
    /// left who waited for it; dollars.
    pub(crate) fn flights_usd(&self, seats: u16, is_early: bool) -> Vec<f64> {
        let part = if is_early { Part::Early } else { Part::Late };
        let market = &self.day.market;
        let cells = self.prices.flight.len() / market.prices_a_cell();
        let price = |cell| money::usd(self.prices.flight[market.position(cell, part, seats)]);
        (0..cells).map(price).collect()
    }
}
