//! The choices of the aircraft of a day, laid out for the search of their best itineraries: legs,
//! holds, limits, and the market for flights.
//!
//! Aircraft of one type are alike, so there is one layer for each type. Aircraft that have an
//! outage today form a separate layer, in which outages are dropped and waiting is free. The cost
//! of a flight depends on the slice in which it begins, never on the second within it.

use std::collections::BTreeMap;

use vertifleet_core::{ClosedTimes, Scenario, Time, TypeIx, Vertiport, VertiportIx};
use vertifleet_sim::{Leg, Legs};

use super::market::{Market, Part, compact};
use super::money;
use super::penalty::Penalty;
use super::slices::Slices;
use crate::Error;

/// The most flights of a day in all slices. More would take too much memory and time.
const MOST_FLIGHTS: usize = 20_000_000;
/// The most layers x vertiports x seconds of a day, for the same reason.
const MOST_PLACES: usize = 100_000_000;

/// A flight that an aircraft of some type may begin in some slice at some vertiport.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Flight {
    /// The vertiport that it flies to.
    pub(super) to: VertiportIx,
    /// Seconds from the decision until the aircraft may decide again, its delay included.
    pub(super) block_s: u32,
    /// The position of its price in [`Prices::flight`](super::prices::Prices::flight).
    pub(super) sold_at: u32,
    /// The least that it may cost with or without passengers, including its energy; micro-dollars.
    pub(super) cost: i64,
}

/// The aircraft of one type, either those with outages or those without.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Layer {
    pub(super) kind: TypeIx,
    /// Whether its aircraft may wait for any time and not only for holds. An aircraft without
    /// outages that may wait for any time can do everything that an aircraft kept on the ground by
    /// an outage does.
    pub(super) waits_freely: bool,
    /// Where and when its aircraft start, those alike together, by vertiport and time.
    pub(super) starts: Vec<Start>,
}

/// Aircraft that start alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Start {
    /// Position of the vertiport where they stand, and take a stand, from the start of the day on.
    pub(super) at: usize,
    /// Seconds from the first take-off time until they are ready for their first decision.
    pub(super) ready_s: u32,
    /// Their number.
    pub(super) count: u32,
}

/// A day, laid out in time.
#[derive(Debug, Clone)]
pub(super) struct TimeExpandedDay {
    pub(super) slices: Slices,
    /// The types that have an aircraft in the fleet.
    pub(super) layers: Vec<Layer>,
    /// Number of stands that are left, by slice, then vertiport: U_max, unless aircraft have been
    /// planned.
    pub(super) stands: Vec<u32>,
    vertiports: usize,
    /// The passengers, who buy flights.
    pub(super) market: Market,
    /// The least that the fleet may cost, whether or not it flies, micro-dollars.
    pub(super) fixed_cost: i64,
    /// Duration of a hold, seconds.
    pub(super) hold_s: u32,
    /// The shortest time from a take-off to the next one, or the duration of a hold if that is
    /// shorter; seconds, at least 1.
    pub(super) shortest_s: u32,
    /// The payments of aircraft for knowing delays, for a bound without foresight.
    pub(super) penalty: Option<Penalty>,
    flights: Vec<Flight>,
    /// Position in `flights` of the first flight from each vertiport, by slice, layer, vertiport.
    offsets: Vec<usize>,
}

impl TimeExpandedDay {
    /// Lays out a day in slices of at most `step_s` seconds. Aircraft decide first when they are
    /// `ready`; those past its end are ready from the start.
    ///
    /// # Errors
    /// [`Error::TooManyFlights`].
    pub(super) fn of(scenario: &Scenario, ready: &[Time], step_s: u32) -> Result<Self, Error> {
        Self::fits(scenario, step_s)?;
        let legs = Legs::of(scenario);
        let layers = layers(scenario, ready);
        let slices = Slices::of(scenario, step_s);
        let mut day = Self {
            stands: scenario.vertiports.iter().map(room).collect::<Vec<_>>().repeat(slices.len()),
            vertiports: scenario.vertiports.len(),
            market: Market::of(scenario),
            fixed_cost: fixed_cost(scenario),
            hold_s: scenario.operations.hold_s,
            shortest_s: scenario.operations.hold_s,
            penalty: None,
            flights: Vec::new(),
            offsets: vec![0],
            slices,
            layers,
        };
        day.add_flights(scenario, &legs);
        day.market.find_choosing_blocks();
        Ok(day)
    }

    /// Checks that a day is not too large for slices of at most `step_s` seconds.
    ///
    /// # Errors
    /// [`Error::TooManyFlights`] if the day is too large.
    pub(super) fn fits(scenario: &Scenario, step_s: u32) -> Result<(), Error> {
        let layers = layers(scenario, &[]);
        let slices = Slices::of(scenario, step_s);
        let size = scenario.vertiports.len();
        let flights = slices.len() * pairs(&Legs::of(scenario), &layers, size);
        let places = layers.len() * size * slices.day_s() as usize;
        if flights <= MOST_FLIGHTS && places <= MOST_PLACES {
            return Ok(());
        }
        Err(Error::TooManyFlights {
            step_s,
            flights,
            most_flights: MOST_FLIGHTS,
            places,
            most_places: MOST_PLACES,
        })
    }

    /// The same day on a clock that only ticks every `tick_s` seconds, with all durations rounded
    /// to whole ticks. Results on it are near the truth and take a fraction of the time, but prove
    /// nothing.
    pub(super) fn on_coarse_clock(mut self, tick_s: u32) -> Self {
        let nearest = |seconds: u32| ((seconds + tick_s / 2) / tick_s).max(1);
        self.hold_s = nearest(self.hold_s);
        self.shortest_s = nearest(self.shortest_s);
        for flight in &mut self.flights {
            flight.block_s = nearest(flight.block_s);
        }
        for start in self.layers.iter_mut().flat_map(|layer| &mut layer.starts) {
            start.ready_s = (start.ready_s + tick_s / 2) / tick_s;
        }
        self.slices = self.slices.on_coarse_clock(tick_s);
        self.penalty = self.penalty.map(|penalty| penalty.on_coarse_clock(tick_s));
        self
    }

    fn add_flights(&mut self, scenario: &Scenario, legs: &Legs) {
        let size = self.size();
        let closed = ClosedTimes::of(&scenario.disturbances.closures, size);
        for slice in 0..self.slices.len() {
            let first_cell = self.slices.period(slice) * size * size;
            let times_s = (self.slices.start_s(slice), self.slices.last_s(slice));
            let [first, last] = [times_s.0, times_s.1].map(Time::from_seconds);
            for layer in 0..self.layers.len() {
                let kind = self.layers[layer].kind;
                let seats = scenario.aircraft_types[kind.at()].seats;
                for from in VertiportIx::all(size) {
                    for to in legs.within_range(kind, from).iter() {
                        if !closed.is_closed_throughout(from, to, first, last) {
                            let leg = *legs.leg(kind, from, to);
                            self.add_flight(scenario, (slice, first_cell), leg, (from, to), seats);
                        }
                    }
                    self.offsets.push(self.flights.len());
                }
            }
        }
    }

    /// Adds a flight of a slice. The cells of the slice's demand period begin with `first_cell`.
    fn add_flight(
        &mut self,
        scenario: &Scenario,
        (slice, first_cell): (usize, usize),
        leg: Leg,
        (from, to): (VertiportIx, VertiportIx),
        seats: u16,
    ) {
        let size = self.size();
        let first_s = self.slices.start_s(slice);
        let late_s = delay_s(scenario, from, first_s);
        let flight_s = leg.flight_s + late_s;
        let arrivals_s = (first_s + flight_s, self.slices.last_s(slice) + flight_s);
        let price_usd = lowest_energy_price_usd(scenario, arrivals_s);
        let cost_usd = leg.energy_kwh * price_usd + scenario.flight_cost_usd[(from, to)];
        let part = if self.slices.wait(slice) { Part::Early } else { Part::Late };
        let cell = first_cell + from.at() * size + to.at();
        let sold_at = self.market.position(cell, part, seats);
        self.market.offer(sold_at);
        self.flights.push(Flight {
            to,
            block_s: leg.block_s() + late_s,
            sold_at: compact(sold_at),
            cost: money::down(cost_usd),
        });
        self.shortest_s = self.shortest_s.min(leg.block_s());
    }

    /// The position of each aircraft's start among those of all layers.
    pub(super) fn group_of(&self, scenario: &Scenario) -> Vec<usize> {
        let starts: Vec<(TypeIx, bool, usize)> = self
            .layers
            .iter()
            .flat_map(|layer| {
                let Layer { kind, waits_freely, starts } = layer;
                starts.iter().map(move |start| (*kind, *waits_freely, start.at))
            })
            .collect();
        let has_outage = has_outage(scenario);
        let fleet = scenario.aircraft.iter().zip(has_outage);
        let group = fleet.map(|(aircraft, has_outage)| {
            let own = (aircraft.kind, has_outage, aircraft.at.at());
            starts.iter().position(|&start| start == own).expect("each aircraft has a group")
        });
        group.collect()
    }

    /// Number of vertiports.
    pub(super) fn size(&self) -> usize {
        self.vertiports
    }

    /// The flights that aircraft of a layer may begin at a vertiport in a slice.
    pub(super) fn flights(&self, slice: usize, layer: usize, from: usize) -> &[Flight] {
        let at = (slice * self.layers.len() + layer) * self.size() + from;
        &self.flights[self.offsets[at]..self.offsets[at + 1]]
    }
}

/// Number of aircraft that may be at a vertiport or on their way to it. Where chargers are counted
/// apart, each has a charger or a stand.
fn room(vertiport: &Vertiport) -> u32 {
    u32::from(vertiport.stands) + vertiport.chargers.map_or(0, u32::from)
}

/// The layers of the fleet, by aircraft type in file order; of each type, the aircraft without
/// outages come first.
fn layers(scenario: &Scenario, ready: &[Time]) -> Vec<Layer> {
    let has_outage = has_outage(scenario);
    let mut layers = Vec::new();
    for kind in TypeIx::all(scenario.aircraft_types.len()) {
        for waits_freely in [false, true] {
            let mut alike: BTreeMap<(usize, u32), u32> = BTreeMap::new();
            for (position, aircraft) in scenario.aircraft.iter().enumerate() {
                if aircraft.kind == kind && has_outage[position] == waits_freely {
                    let ready = ready.get(position);
                    let ready_s = ready.map_or(0, |ready| ready.since(scenario.operations.start));
                    *alike.entry((aircraft.at.at(), ready_s)).or_default() += 1;
                }
            }
            let start = |((at, ready_s), count)| Start { at, ready_s, count };
            let starts: Vec<Start> = alike.into_iter().map(start).collect();
            if !starts.is_empty() {
                layers.push(Layer { kind, waits_freely, starts });
            }
        }
    }
    layers
}

/// Whether each aircraft has an outage.
fn has_outage(scenario: &Scenario) -> Vec<bool> {
    let mut has_outage = vec![false; scenario.aircraft.len()];
    for outage in &scenario.disturbances.outages {
        has_outage[outage.aircraft.at()] = true;
    }
    has_outage
}

/// Seconds by which flights from a vertiport take off late in the slot that contains a time.
fn delay_s(scenario: &Scenario, from: VertiportIx, time_s: u32) -> u32 {
    let start = scenario.operations.start;
    let delays = scenario.disturbances.takeoff_delays.as_ref();
    delays.map_or(0, |delays| delays.at(start, Time::from_seconds(time_s), from))
}

/// Number of flights that may begin in each slice.
fn pairs(legs: &Legs, layers: &[Layer], size: usize) -> usize {
    let within_range = |layer: &Layer| -> usize {
        VertiportIx::all(size).map(|from| legs.within_range(layer.kind, from).iter().count()).sum()
    };
    layers.iter().map(within_range).sum()
}

/// The fixed cost of the fleet, the stands and the chargers. It is rounded down for each, but to no
/// less than 0, because rounding down would make a cost of nothing negative.
fn fixed_cost(scenario: &Scenario) -> i64 {
    let each = |cost_usd: f64| money::down(cost_usd).max(0);
    let fleet = i64::try_from(scenario.aircraft.len()).expect("at most 10,000 aircraft");
    let site = |vertiport: &Vertiport| {
        i64::from(vertiport.stands) * each(vertiport.stand_cost_usd)
            + i64::from(vertiport.chargers.unwrap_or(0)) * each(vertiport.charger_cost_usd)
    };
    fleet * each(scenario.aircraft_cost_usd) + scenario.vertiports.iter().map(site).sum::<i64>()
}

/// The lowest price of energy at any time within `arrivals_s`, both ends included.
fn lowest_energy_price_usd(scenario: &Scenario, arrivals_s: (u32, u32)) -> f64 {
    let period = |time_s| scenario.period_at(Time::from_seconds(time_s));
    let prices = &scenario.energy_price_usd[period(arrivals_s.0)..=period(arrivals_s.1)];
    prices.iter().copied().fold(f64::INFINITY, f64::min)
}
