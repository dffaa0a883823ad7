//! The choices of the aircraft of a day, laid out for the search of their best itineraries: legs,
//! holds, limits, and the market for flights.
//!
//! Aircraft of one type are alike, so there is one layer for each type. Aircraft that have an
//! outage today form a separate layer, in which outages are dropped and waiting is free. The cost
//! of a flight depends on the slice in which it begins, never on the second within it.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use vertifleet_core::{
    AircraftIx, Charging, ClosedTimes, Scenario, Time, TypeIx, Vertiport, VertiportIx,
};
use vertifleet_sim::{Legs, first_decision};

use super::charge_levels::{ChargeLevels, Charged, Level};
use super::charging_time::{ChargingTime, Use};
use super::market::{Market, Part, compact};
use super::money;
use super::outages;
use super::penalty::Penalty;
use super::slices::Slices;
use crate::Error;

/// The most flights of a day in all slices. More would take too much memory and time.
const MOST_FLIGHTS: usize = 20_000_000;
/// The most layers x vertiports x levels x seconds of a day, for the same reason.
const MOST_PLACES: usize = 200_000_000;

/// A flight that an aircraft of some type may begin in some slice at some vertiport.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Flight {
    /// The vertiport that it flies to.
    pub(super) to: VertiportIx,
    /// The level of charge at the next decision.
    pub(super) level: Level,
    /// Seconds from the decision until the aircraft may decide again, its delay included.
    pub(super) block_s: u32,
    /// The position of its price in [`Prices::flight`](super::prices::Prices::flight).
    pub(super) sold_at: u32,
    /// The least that it may cost with or without passengers, including its energy; micro-dollars.
    pub(super) cost: i64,
}

/// A flight between two vertiports that is decided at a level of charge.
#[derive(Clone, Copy)]
struct Hop {
    layer: usize,
    pair: (VertiportIx, VertiportIx),
    level: Level,
}

/// The aircraft of one type, either those with outages or those without.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Layer {
    pub(super) kind: TypeIx,
    /// Whether its aircraft may wait for any time and not only for holds. An aircraft without
    /// outages that may wait for any time can do everything that an aircraft kept on the ground by
    /// an outage does, and everything that one does that waits for charge.
    pub(super) waits_freely: bool,
    /// Whether its aircraft have outages. While one is out of service it charges, for longer than
    /// levels know of, so it is full at every decision.
    has_outages: bool,
    /// Where and when its aircraft start, those alike together, by vertiport and time.
    pub(super) starts: Vec<Start>,
}

/// Aircraft that start alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Start {
    /// Position of the vertiport where they stand, and take a stand, from the start of the day on.
    pub(super) at: usize,
    pub(super) level: Level,
    /// Seconds from the first take-off time until they are ready for their first decision.
    pub(super) ready_s: u32,
    /// The seconds of charging above the reserve that each has.
    pub(super) charged_s: i64,
    /// Their number.
    pub(super) count: u32,
}

/// A day, laid out in time.
#[derive(Debug, Clone)]
pub(super) struct TimeExpandedDay {
    pub(super) slices: Slices,
    /// The types that have an aircraft in the fleet.
    pub(super) layers: Vec<Layer>,
    /// The position of each aircraft's start among those of all layers.
    pub(super) group_of: Vec<usize>,
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
    /// Number of levels of charge, at least 1; 1 on days that charge to full.
    pub(super) levels: u16,
    /// The charging time of aircraft.
    pub(super) charging: ChargingTime,
    /// By layer, vertiport, then level: the level after a hold.
    holds: Vec<Level>,
    /// By layer: the places that its aircraft may reach, in order.
    reached: Vec<Vec<usize>>,
    /// The payments of aircraft for knowing delays, for a bound without foresight.
    pub(super) penalty: Option<Penalty>,
    flights: Vec<Flight>,
    /// What each flight uses of the charging time; empty on days that charge to full.
    uses: Vec<Use>,
    /// Position in `flights` of the first flight from each place, by slice, layer, place.
    offsets: Vec<usize>,
}

impl TimeExpandedDay {
    /// Lays out a day in slices of at most `step_s` seconds, with a number of levels of charge,
    /// which only matters on days that charge as needed. Aircraft decide first when they are
    /// `ready`; those past its end when the day lets them.
    ///
    /// # Errors
    /// [`Error::TooManyFlights`].
    pub(super) fn of(
        scenario: &Scenario,
        ready: &[Time],
        step_s: u32,
        levels: u16,
    ) -> Result<Self, Error> {
        let as_needed = scenario.operations.charging == Charging::AsNeeded;
        let levels = if as_needed { levels } else { 1 };
        Self::fits(scenario, step_s, levels)?;
        let legs = Legs::of(scenario);
        let of_charge = as_needed.then(|| ChargeLevels::of(scenario, &legs, levels));
        let of_charge = of_charge.as_ref();
        let charging = ChargingTime::of(scenario);
        let (layers, group_of) = layers(scenario, ready, of_charge.map(|it| (it, &charging)));
        let slices = Slices::of(scenario, step_s);
        let mut day = Self {
            stands: scenario.vertiports.iter().map(room).collect::<Vec<_>>().repeat(slices.len()),
            vertiports: scenario.vertiports.len(),
            market: Market::of(scenario),
            fixed_cost: fixed_cost(scenario),
            hold_s: scenario.operations.hold_s,
            shortest_s: scenario.operations.hold_s,
            levels,
            charging,
            holds: holds(of_charge, &layers, scenario.vertiports.len()),
            reached: Vec::new(),
            penalty: None,
            flights: Vec::new(),
            uses: Vec::new(),
            offsets: vec![0],
            slices,
            layers,
            group_of,
        };
        day.reached = (0..day.layers.len()).map(|layer| day.reached_by(layer)).collect();
        day.add_flights(scenario, &legs, of_charge);
        day.market.find_choosing_blocks();
        Ok(day)
    }

    /// The places that aircraft of a layer may reach, in order. With an outage, a flight leads to a
    /// full battery, so aircraft only have another level at their start, and after holds there.
    /// Aircraft of other designs start full at any vertiport.
    fn reached_by(&self, layer: usize) -> Vec<usize> {
        let Layer { has_outages, starts, .. } = &self.layers[layer];
        if !has_outages {
            return (0..self.places()).collect();
        }
        let mut reached: BTreeSet<usize> =
            (0..self.size()).map(|at| self.place(at, self.full())).collect();
        for start in starts {
            let mut place = self.place(start.at, start.level);
            while reached.insert(place) {
                place = self.held(layer, place);
            }
        }
        reached.into_iter().collect()
    }

    /// Checks that a day is not too large for slices of at most `step_s` seconds.
    ///
    /// # Errors
    /// [`Error::TooManyFlights`] if the day is too large.
    pub(super) fn fits(scenario: &Scenario, step_s: u32, levels: u16) -> Result<(), Error> {
        let (layers, _) = layers(scenario, &[], None);
        let slices = Slices::of(scenario, step_s);
        let size = scenario.vertiports.len();
        let levels = usize::from(levels);
        let flights = slices.len() * pairs(&Legs::of(scenario), &layers, size) * levels;
        let places = layers.len() * size * levels * slices.day_s() as usize;
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

    fn add_flights(&mut self, scenario: &Scenario, legs: &Legs, levels: Option<&ChargeLevels<'_>>) {
        let size = self.size();
        let closed = ClosedTimes::of(&scenario.disturbances.closures, size);
        for slice in 0..self.slices.len() {
            let first_cell = self.slices.period(slice) * size * size;
            let times_s = (self.slices.start_s(slice), self.slices.last_s(slice));
            let [first, last] = [times_s.0, times_s.1].map(Time::from_seconds);
            for layer in 0..self.layers.len() {
                let kind = self.layers[layer].kind;
                for from in VertiportIx::all(size) {
                    let open = legs.within_range(kind, from);
                    let is_open =
                        |to: &VertiportIx| !closed.is_closed_throughout(from, *to, first, last);
                    for level in (0..).take(self.levels.into()) {
                        let place = self.place(from.at(), level);
                        let is_reached = self.reached[layer].binary_search(&place).is_ok();
                        for to in open.iter().filter(|to| is_reached && is_open(to)) {
                            let cell = first_cell + from.at() * size + to.at();
                            let hop = Hop { layer, pair: (from, to), level };
                            self.add_flight((scenario, legs), (slice, cell), hop, levels);
                        }
                        self.offsets.push(self.flights.len());
                    }
                }
            }
        }
    }

    /// Adds a flight of a slice and a cell of the demand. One that waits for charge past the end of
    /// operations is left out.
    fn add_flight(
        &mut self,
        (scenario, legs): (&Scenario, &Legs),
        (slice, cell): (usize, usize),
        Hop { layer, pair: (from, to), level }: Hop,
        levels: Option<&ChargeLevels<'_>>,
    ) {
        let Layer { kind, has_outages, .. } = self.layers[layer];
        let leg = legs.leg(kind, from, to);
        let seats = scenario.aircraft_types[kind.at()].seats;
        let (first_s, last_s) = (self.slices.start_s(slice), self.slices.last_s(slice));
        let late_s = delay_s(scenario, from, first_s);
        let (mut charged, mut takeoff_s) = (Charged { wait_s: 0, level: 0 }, last_s);
        if let Some(levels) = levels {
            let end_s = scenario.operations.end.seconds();
            charged = levels.flight(kind, (from, to), level, late_s);
            if has_outages {
                charged.level = levels.full();
            }
            if first_s + charged.wait_s > end_s {
                return;
            }
            // An aircraft with less charge than its level waits for longer.
            let needed_mwh = scenario.aircraft_types[kind.at()].needed_mwh(leg.energy_kwh);
            let longest_s = self.charging.longest_wait_s(legs.rate(kind, from), kind, needed_mwh);
            takeoff_s = last_s.max(end_s.min(last_s + longest_s));
            let leaves_s = (first_s + charged.wait_s + late_s, takeoff_s + late_s);
            self.uses.push(self.charging.of_flight(kind, leg, leaves_s));
        }
        let flight_s = leg.flight_s + late_s;
        let arrivals_s = (first_s + charged.wait_s + flight_s, takeoff_s + flight_s);
        let price_usd = lowest_energy_price_usd(scenario, arrivals_s);
        let cost_usd = leg.energy_kwh * price_usd + scenario.flight_cost_usd[(from, to)];
        let part = if self.slices.wait(slice) { Part::Early } else { Part::Late };
        let sold_at = self.market.position(cell, part, seats);
        self.market.offer(sold_at);
        self.flights.push(Flight {
            to,
            level: charged.level,
            block_s: charged.wait_s + leg.block_s() + late_s,
            sold_at: compact(sold_at),
            cost: money::down(cost_usd),
        });
        self.shortest_s = self.shortest_s.min(leg.block_s());
    }

    /// Number of vertiports.
    pub(super) fn size(&self) -> usize {
        self.vertiports
    }

    /// Number of places: vertiports, each with every level of charge.
    pub(super) fn places(&self) -> usize {
        self.vertiports * usize::from(self.levels)
    }

    /// The place of aircraft at a vertiport with a level of charge.
    #[inline]
    pub(super) fn place(&self, at: usize, level: Level) -> usize {
        at * usize::from(self.levels) + usize::from(level)
    }

    /// The vertiport of a place.
    #[inline]
    pub(super) fn vertiport(&self, place: usize) -> usize {
        place / usize::from(self.levels)
    }

    /// The places that aircraft of a layer may reach, in order.
    pub(super) fn reached(&self, layer: usize) -> &[usize] {
        &self.reached[layer]
    }

    /// The highest level of charge.
    pub(super) fn full(&self) -> Level {
        self.levels - 1
    }

    /// The place of an aircraft of a layer after a hold.
    #[inline]
    pub(super) fn held(&self, layer: usize, place: usize) -> usize {
        if self.holds.is_empty() {
            return place;
        }
        self.place(self.vertiport(place), self.holds[layer * self.places() + place])
    }

    /// The positions among all flights of those that aircraft of a layer may begin at a place in a
    /// slice.
    #[inline]
    pub(super) fn positions(&self, slice: usize, layer: usize, place: usize) -> Range<usize> {
        let at = (slice * self.layers.len() + layer) * self.places() + place;
        self.offsets[at]..self.offsets[at + 1]
    }

    /// The flights that aircraft of a layer may begin at a place in a slice.
    pub(super) fn flights(&self, slice: usize, layer: usize, place: usize) -> &[Flight] {
        &self.flights[self.positions(slice, layer, place)]
    }

    /// The flights of all slices, layers and places.
    pub(super) fn all_flights(&self) -> &[Flight] {
        &self.flights
    }

    /// What each flight uses of the charging time; nothing on days that charge to full.
    pub(super) fn uses(&self) -> &[Use] {
        &self.uses
    }
}

/// The level of each place after a hold, by layer; empty on a day that charges to full.
fn holds(levels: Option<&ChargeLevels<'_>>, layers: &[Layer], size: usize) -> Vec<Level> {
    let Some(levels) = levels else { return Vec::new() };
    let of_layer = |layer: &Layer| {
        let kind = layer.kind;
        let of_vertiport =
            move |at| (0..).take(levels.count).map(move |level| levels.hold(kind, at, level));
        VertiportIx::all(size).flat_map(of_vertiport).collect::<Vec<Level>>()
    };
    layers.iter().flat_map(of_layer).collect()
}

/// Number of aircraft that may be at a vertiport or on their way to it. Where chargers are counted
/// apart, each has a charger or a stand.
fn room(vertiport: &Vertiport) -> u32 {
    u32::from(vertiport.stands) + vertiport.chargers.map_or(0, u32::from)
}

/// The layers of the fleet, by aircraft type in file order; of each type, the aircraft without
/// outages come first. Also the position of each aircraft's start among those of all layers.
fn layers(
    scenario: &Scenario,
    ready: &[Time],
    charging: Option<(&ChargeLevels<'_>, &ChargingTime)>,
) -> (Vec<Layer>, Vec<usize>) {
    let ready_at = |position: usize| {
        let first = || first_decision(scenario, AircraftIx::new(position));
        ready.get(position).copied().unwrap_or_else(first)
    };
    let has_outage = outages::may_happen(scenario, ready_at);
    // An aircraft that waits for charge decides at other times than on its way without the wait.
    let all_wait = scenario.operations.charging == Charging::AsNeeded;
    let start_of = |position: usize| {
        let aircraft = &scenario.aircraft[position];
        let ready_s = ready_at(position).since(scenario.operations.start);
        let (kind, charge_kwh) = (aircraft.kind, scenario.start_charge_kwh(aircraft));
        let charged = charging.map(|(levels, time)| {
            (levels.at_start(kind, charge_kwh), time.at_start_s(kind, charge_kwh))
        });
        let (level, charged_s) = charged.unwrap_or_default();
        (aircraft.at.at(), level, ready_s, charged_s)
    };
    let (mut layers, mut group_of) = (Vec::new(), vec![0; scenario.aircraft.len()]);
    let mut groups = 0;
    for kind in TypeIx::all(scenario.aircraft_types.len()) {
        for has_outages in [false, true] {
            let mut alike: BTreeMap<(usize, Level, u32, i64), Vec<usize>> = BTreeMap::new();
            for (position, aircraft) in scenario.aircraft.iter().enumerate() {
                if aircraft.kind == kind && has_outage[position] == has_outages {
                    alike.entry(start_of(position)).or_default().push(position);
                }
            }
            let mut starts = Vec::with_capacity(alike.len());
            for ((at, level, ready_s, charged_s), positions) in alike {
                let count = u32::try_from(positions.len()).expect("at most 10,000 aircraft");
                starts.push(Start { at, level, ready_s, charged_s, count });
                for position in positions {
                    group_of[position] = groups;
                }
                groups += 1;
            }
            if !starts.is_empty() {
                let waits_freely = has_outages || all_wait;
                layers.push(Layer { kind, waits_freely, has_outages, starts });
            }
        }
    }
    (layers, group_of)
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
