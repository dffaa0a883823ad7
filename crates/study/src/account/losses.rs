//! Who was carried and who was not, by period and by pair.

use serde::Serialize;
use vertifleet_core::{Scenario, Time, VertiportIx};
use vertifleet_sim::{Boarded, TraceRow};

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
    /// Flights.
    pub flights: u32,
    /// Flights without passengers.
    pub repositioning_flights: u32,
    /// Profit of the flights, dollars.
    pub profit_usd: f64,
}

impl Loss {
    fn add(&mut self, other: Self) {
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

/// The losses by pair, the most money first.
pub(super) fn by_pair(day: &Scenario, rows: &[TraceRow]) -> Vec<PairLoss> {
    let carried = Carried::of(day, rows);
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
            flights: count(&flights),
            repositioning_flights: empty(&flights),
            // From 0, because the sum of no numbers is -0.
            profit_usd: flights.iter().fold(0.0, |sum, row| sum + row.profit_usd()),
        }
    };
    let mut losses: Vec<PairLoss> = pairs(day.vertiports.len()).map(of_pair).collect();
    losses.sort_by(|one, other| {
        other.demand.spilled_margin_usd.total_cmp(&one.demand.spilled_margin_usd)
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
