//! The account of a day, flight by flight.

use std::sync::Arc;

use axum::extract::State;
use axum::response::Response;
use serde::Serialize;
use utoipa::ToSchema;
use vertifleet_core::VertiportIx;
use vertifleet_sim::DayTotals;

use super::answer::Written;
use super::extract::{Named, Validated};
use crate::dispatch_day::DispatchDay;
use crate::error::Error;
use crate::moment::Moment;
use crate::outlook::Totals;
use crate::service::Service;

/// The earnings and costs of a day so far.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct Ledger {
    /// The number of the latest event.
    seq: u64,
    /// An entry for each flight, in the order in which they were decided.
    flights: Vec<Entry>,
    /// The sums, including the fixed costs of aircraft.
    #[schema(value_type = Totals)]
    totals: DayTotals,
}

/// A flight in the account.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct Entry {
    /// When the decision was taken.
    time: Moment,
    /// The aircraft.
    aircraft: String,
    /// The vertiport of departure.
    from: String,
    /// The vertiport of destination.
    to: String,
    /// Whether it has landed. Until then the amounts are expected ones.
    has_landed: bool,
    /// Passengers on board.
    passengers: u16,
    /// Fares, dollars.
    revenue_usd: f64,
    /// Cost of carrying the passengers, dollars.
    passenger_cost_usd: f64,
    /// Energy, kWh.
    energy_kwh: f64,
    /// Cost of charging it again, dollars.
    energy_cost_usd: f64,
    /// Cost of the flight without its energy, with or without passengers; dollars.
    flight_cost_usd: f64,
    /// Fares less all costs of the flight, dollars.
    profit_usd: f64,
}

/// The account of a day so far, flight by flight.
#[utoipa::path(operation_id = "day_ledger", get, path = "/v1/days/{day}/ledger", tag = "days", params(("day" = String, Path), Written), responses((status = 200, body = Ledger)))]
pub(super) async fn ledger(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    Validated(Written { times }): Validated<Written>,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let ledger = Ledger::of(&mut day.state());
    times.answer(&day, ledger.seq, &ledger).await
}

impl Ledger {
    fn of(day: &mut DispatchDay) -> Self {
        let (seq, totals) = (day.seq(), day.live_mut().totals());
        let live = day.live();
        let scenario = live.scenario();
        let id = |vertiport: VertiportIx| scenario.vertiports[vertiport.at()].id.clone();
        let trace = live.trace();
        let flights = trace.rows.iter().filter(|row| row.from != row.to).map(|row| Entry {
            time: row.time.into(),
            aircraft: scenario.aircraft[row.aircraft.at()].id.clone(),
            from: id(row.from),
            to: id(row.to),
            has_landed: live.flight(row.aircraft).is_none_or(|flight| flight.time != row.time),
            passengers: row.passengers,
            revenue_usd: row.revenue_usd,
            passenger_cost_usd: row.passenger_cost_usd,
            energy_kwh: row.energy_kwh,
            energy_cost_usd: row.energy_cost_usd,
            flight_cost_usd: row.flight_cost_usd,
            profit_usd: row.profit_usd(),
        });
        Self { seq, flights: flights.collect(), totals }
    }
}
