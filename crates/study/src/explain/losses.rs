//! Who was carried and who was not, by period and by pair.

use serde::Serialize;
use vertifleet_core::{Scenario, VertiportIx};
use vertifleet_sim::TraceRow;

/// Demand served and spilled in a period.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PeriodLoss {
    /// The start of the period.
    pub period: String,
    /// Passengers who wanted to fly.
    pub wanted: u64,
    /// Passengers carried.
    pub carried: u64,
    /// Passengers who were not.
    pub spilled: u64,
    /// What those would have paid less what carrying them costs, dollars.
    pub spilled_margin_usd: f64,
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
    /// Passengers who wanted to fly.
    pub wanted: u64,
    /// Passengers carried.
    pub carried: u64,
    /// Passengers who were not.
    pub spilled: u64,
    /// What those would have paid less what carrying them costs, dollars.
    pub spilled_margin_usd: f64,
    /// Flights.
    pub flights: u32,
    /// Flights without passengers.
    pub repositioning_flights: u32,
    /// Profit of the flights, dollars.
    pub profit_usd: f64,
}

/// Passengers carried by period, from and to.
struct Carried {
    size: usize,
    passengers: Vec<u64>,
}

impl Carried {
    fn of(day: &Scenario, rows: &[TraceRow]) -> Self {
        let size = day.vertiports.len();
        let mut carried = Self { size, passengers: vec![0; day.periods.len() * size * size] };
        for row in rows {
            let at = carried.position(day.period_at(row.time), row.from, row.to);
            carried.passengers[at] += u64::from(row.passengers);
        }
        carried
    }

    fn position(&self, period: usize, from: VertiportIx, to: VertiportIx) -> usize {
        (period * self.size + from.at()) * self.size + to.at()
    }

    /// Passengers who wanted to fly, who were carried, and the margin of those who were not.
    fn loss(
        &self,
        day: &Scenario,
        period: usize,
        from: VertiportIx,
        to: VertiportIx,
    ) -> (u64, u64, f64) {
        let wanted = u64::from(day.demand[period][(from, to)]);
        let carried = self.passengers[self.position(period, from, to)];
        let margin_usd =
            day.fare_usd.in_period(period)[(from, to)] - day.passenger_cost_usd[(from, to)];
        (wanted, carried, wanted.saturating_sub(carried) as f64 * margin_usd.max(0.0))
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
    let of_period = |(period, start): (usize, &vertifleet_core::Time)| {
        let mut loss = PeriodLoss {
            period: start.to_string(),
            wanted: 0,
            carried: 0,
            spilled: 0,
            spilled_margin_usd: 0.0,
            flights: 0,
            repositioning_flights: 0,
            holds: 0,
        };
        for (from, to) in pairs(day.vertiports.len()) {
            let (wanted, carried, margin_usd) = carried.loss(day, period, from, to);
            loss.wanted += wanted;
            loss.carried += carried;
            loss.spilled += wanted.saturating_sub(carried);
            loss.spilled_margin_usd += margin_usd;
        }
        for row in rows.iter().filter(|row| day.period_at(row.time) == period) {
            let flies = row.from != row.to;
            loss.flights += u32::from(flies);
            loss.repositioning_flights += u32::from(flies && row.passengers == 0);
            loss.holds += u32::from(!flies);
        }
        loss
    };
    day.periods.iter().enumerate().map(of_period).collect()
}

/// The losses by pair, the most money first.
pub(super) fn by_pair(day: &Scenario, rows: &[TraceRow]) -> Vec<PairLoss> {
    let carried = Carried::of(day, rows);
    let id = |at: VertiportIx| day.vertiports[at.at()].id.clone();
    let of_pair = |(from, to): (VertiportIx, VertiportIx)| {
        let mut loss = PairLoss {
            from: id(from),
            to: id(to),
            wanted: 0,
            carried: 0,
            spilled: 0,
            spilled_margin_usd: 0.0,
            flights: 0,
            repositioning_flights: 0,
            profit_usd: 0.0,
        };
        for period in 0..day.periods.len() {
            let (wanted, carried, margin_usd) = carried.loss(day, period, from, to);
            loss.wanted += wanted;
            loss.carried += carried;
            loss.spilled += wanted.saturating_sub(carried);
            loss.spilled_margin_usd += margin_usd;
        }
        for row in rows.iter().filter(|row| (row.from, row.to) == (from, to)) {
            loss.flights += 1;
            loss.repositioning_flights += u32::from(row.passengers == 0);
            loss.profit_usd += row.profit_usd();
        }
        loss
    };
    let mut losses: Vec<PairLoss> = pairs(day.vertiports.len()).map(of_pair).collect();
    losses.sort_by(|one, other| other.spilled_margin_usd.total_cmp(&one.spilled_margin_usd));
    losses
}
