//! Who was carried and who was not: by period, by pair, and by both.
//!
//! Pairs that no aircraft of the day can fly, because they have no corridor or are beyond the range
//! of every aircraft, lose all of their demand whatever is decided. They are counted apart and come
//! last.

use std::cmp::Ordering;

use serde::Serialize;
use vertifleet_core::{Scenario, Time, TypeIx, VertiportIx};
use vertifleet_sim::{Boarded, Legs, TraceRow};

/// Demand served and spilled.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Loss {
    /// Passengers who wanted to fly.
    pub wanted: u64,
    /// Passengers carried.
    pub carried: u64,
    /// Passengers who were not.
    pub spilled: u64,
    /// What those would have paid less what carrying them costs, dollars.
    pub spilled_margin_usd: f64,
}

/// Demand served and spilled in a period.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PeriodLoss {
    /// The start of the period.
    pub period: String,
    /// Its demand.
    #[serde(flatten)]
    pub demand: Loss,
    /// Flights that were decided in the period.
    pub flights: u32,
    /// Flights without passengers.
    pub repositioning_flights: u32,
    /// Decisions to stay.
    pub holds: u32,
}

/// Demand served and spilled between two vertiports.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairLoss {
    /// Where passengers leave.
    pub from: String,
    /// Where they want to go.
    pub to: String,
    /// Its demand.
    #[serde(flatten)]
    pub demand: Loss,
    /// Whether some aircraft of the day can fly it: there is a corridor, and it is within the
    /// range.
    pub can_be_flown: bool,
    /// Flights.
    pub flights: u32,
    /// Flights without passengers.
    pub repositioning_flights: u32,
    /// Profit of the flights, dollars.
    pub profit_usd: f64,
}

/// Passengers of a pair who wanted to fly in a period and were not carried.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CellLoss {
    /// Where passengers leave.
    pub from: String,
    /// Where they want to go.
    pub to: String,
    /// The start of the period.
    pub period: String,
    /// Whether some aircraft of the day can fly the pair.
    pub can_be_flown: bool,
    /// Its demand.
    #[serde(flatten)]
    pub demand: Loss,
}

impl Loss {
    pub(super) fn add(&mut self, other: Self) {
        self.wanted += other.wanted;
        self.carried += other.carried;
        self.spilled += other.spilled;
        self.spilled_margin_usd += other.spilled_margin_usd;
    }
}

/// Passengers carried by the period in which they wanted to fly, from and to.
struct Carried {
    size: usize,
    passengers: Vec<u64>,
}

impl Carried {
    fn of(day: &Scenario, rows: &[TraceRow]) -> Self {
        let size = day.vertiports.len();
        let mut carried = Self { size, passengers: vec![0; day.periods.len() * size * size] };
        let mut boarded = Boarded::of(day);
        for row in rows {
            for (period, passengers) in boarded.board(row) {
                let at = carried.position(period, row.from, row.to);
                carried.passengers[at] += u64::from(passengers);
            }
        }
        carried
    }

    fn position(&self, period: usize, from: VertiportIx, to: VertiportIx) -> usize {
        (period * self.size + from.at()) * self.size + to.at()
    }

    /// The loss of a pair in a period.
    fn loss(&self, day: &Scenario, period: usize, (from, to): (VertiportIx, VertiportIx)) -> Loss {
        let wanted = u64::from(day.demand[period][(from, to)]);
        let carried = self.passengers[self.position(period, from, to)];
        let spilled = wanted.saturating_sub(carried);
        let margin_usd =
            day.fare_usd.in_period(period)[(from, to)] - day.passenger_cost_usd[(from, to)];
        Loss { wanted, carried, spilled, spilled_margin_usd: spilled as f64 * margin_usd.max(0.0) }
    }
}

fn pairs(size: usize) -> impl Iterator<Item = (VertiportIx, VertiportIx)> {
    VertiportIx::all(size)
        .flat_map(move |from| VertiportIx::all(size).map(move |to| (from, to)))
        .filter(|(from, to)| from != to)
}

/// The losses by period.
pub(super) fn by_period(day: &Scenario, rows: &[TraceRow]) -> Vec<PeriodLoss> {
    let carried = Carried::of(day, rows);
    let of_period = |(period, start): (usize, &Time)| {
        let mut demand = Loss::default();
        for pair in pairs(day.vertiports.len()) {
            demand.add(carried.loss(day, period, pair));
        }
        let decided = rows.iter().filter(|row| day.period_at(row.time) == period);
        let (flights, holds): (Vec<&TraceRow>, Vec<&TraceRow>) =
            decided.partition(|row| row.from != row.to);
        PeriodLoss {
            period: start.to_string(),
            demand,
            flights: count(&flights),
            repositioning_flights: empty(&flights),
            holds: count(&holds),
        }
    };
    day.periods.iter().enumerate().map(of_period).collect()
}

/// The pairs that some aircraft of a day can fly.
struct Flyable<'a> {
    day: &'a Scenario,
    legs: Legs,
}

impl<'a> Flyable<'a> {
    fn of(day: &'a Scenario) -> Self {
        Self { day, legs: Legs::of(day) }
    }

    fn has(&self, (from, to): (VertiportIx, VertiportIx)) -> bool {
        let types = (0..self.day.aircraft_types.len()).map(TypeIx::new);
        types
            .filter(|&kind| self.legs.within_range(kind, from).contains(to))
            .any(|kind| self.day.aircraft.iter().any(|aircraft| aircraft.kind == kind))
    }
}

/// The order of losses: pairs that can be flown first, and then the most money first.
fn order((can_be_flown, loss): (bool, &Loss), (other_can, other): (bool, &Loss)) -> Ordering {
    let money = other.spilled_margin_usd.total_cmp(&loss.spilled_margin_usd);
    other_can.cmp(&can_be_flown).then(money)
}

/// The losses by pair and period, of those who were not carried; the most money first.
pub(super) fn by_cell(day: &Scenario, rows: &[TraceRow]) -> Vec<CellLoss> {
    let (carried, flyable) = (Carried::of(day, rows), Flyable::of(day));
    let id = |at: VertiportIx| day.vertiports[at.at()].id.clone();
    let mut losses = Vec::new();
    for pair in pairs(day.vertiports.len()) {
        let can_be_flown = flyable.has(pair);
        let of_periods = day.periods.iter().enumerate().map(|(period, start)| CellLoss {
            from: id(pair.0),
            to: id(pair.1),
            period: start.to_string(),
            can_be_flown,
            demand: carried.loss(day, period, pair),
        });
        losses.extend(of_periods.filter(|one| one.demand.spilled > 0));
    }
    losses.sort_by(|one, other| {
        order((one.can_be_flown, &one.demand), (other.can_be_flown, &other.demand))
    });
    losses
}

/// The losses by pair, the most money first.
pub(super) fn by_pair(day: &Scenario, rows: &[TraceRow]) -> Vec<PairLoss> {
    let (carried, flyable) = (Carried::of(day, rows), Flyable::of(day));
    let id = |at: VertiportIx| day.vertiports[at.at()].id.clone();
    let of_pair = |pair: (VertiportIx, VertiportIx)| {
        let mut demand = Loss::default();
        for period in 0..day.periods.len() {
            demand.add(carried.loss(day, period, pair));
        }
        let flights: Vec<&TraceRow> =
            rows.iter().filter(|row| (row.from, row.to) == pair).collect();
        PairLoss {
            from: id(pair.0),
            to: id(pair.1),
            demand,
            can_be_flown: flyable.has(pair),
            flights: count(&flights),
            repositioning_flights: empty(&flights),
            // From 0, because the sum of no numbers is -0.
            profit_usd: flights.iter().fold(0.0, |sum, row| sum + row.profit_usd()),
        }
    };
    let mut losses: Vec<PairLoss> = pairs(day.vertiports.len()).map(of_pair).collect();
    losses.sort_by(|one, other| {
        order((one.can_be_flown, &one.demand), (other.can_be_flown, &other.demand))
    });
    losses
}

fn count(rows: &[&TraceRow]) -> u32 {
    u32::try_from(rows.len()).expect("a day has a bounded number of decisions")
}

/// Number of flights without passengers.
fn empty(flights: &[&TraceRow]) -> u32 {
    count(&flights.iter().copied().filter(|row| row.passengers == 0).collect::<Vec<_>>())
}
