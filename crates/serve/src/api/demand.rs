//! Passengers who wait, and those who are expected.

use std::sync::Arc;

use axum::extract::State;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use vertifleet_core::VertiportIx;

use super::answer::Times;
use super::extract::{Named, Validated};
use crate::dispatch_day::DispatchDay;
use crate::error::Error;
use crate::event::PairDemand;
use crate::moment::{Moment, by_calendar};
use crate::service::Service;

/// The query of demand.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(crate) struct InPeriod {
    /// The beginning of a demand period; without it, the current one.
    #[param(value_type = Option<Moment>, inline)]
    period: Option<String>,
    /// How times are written in the answer.
    #[serde(default)]
    times: Times,
}

/// The passengers of a demand period who still want to fly: waiting ones if the period has begun,
/// and expected ones if it has not.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct PeriodDemand {
    /// The number of the latest event.
    seq: u64,
    /// The beginning of the period.
    period: Moment,
    /// Whether the period has begun.
    has_begun: bool,
    /// The pairs with such passengers, in the order of the day's vertiports.
    pairs: Vec<PairDemand>,
}

/// The passengers of a demand period who still want to fly.
#[utoipa::path(operation_id = "day_demand", get, path = "/v1/days/{day}/demand", tag = "days", params(("day" = String, Path), InPeriod), responses((status = 200, body = PeriodDemand)))]
pub(super) async fn demand(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    Validated(asked): Validated<InPeriod>,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let parse = |text: String| by_calendar(day.calendar(), || Moment::parse(&text));
    let period = asked.period.map(parse).transpose().map_err(|rule| Error::BadRequest { rule })?;
    let demand = PeriodDemand::of(&mut day.state(), period)?;
    asked.times.answer(&day, demand.seq, &demand).await
}

impl PeriodDemand {
    fn of(day: &mut DispatchDay, period: Option<Moment>) -> Result<Self, Error> {
        let asked = period.map(|time| day.ids().period(time.time())).transpose()?;
        let (seq, live) = (day.seq(), day.live_mut());
        let scenario = Arc::clone(live.scenario());
        let view = live.view();
        let period = asked.unwrap_or(view.period());
        let id = |vertiport: VertiportIx| scenario.vertiports[vertiport.at()].id.clone();
        let vertiports = || VertiportIx::all(scenario.vertiports.len());
        let pair = |(from, to)| PairDemand {
            from: id(from),
            to: id(to),
            passengers: view.demand_left(period, from, to),
        };
        let pairs = vertiports().flat_map(|from| vertiports().map(move |to| (from, to)));
        Ok(Self {
            seq,
            period: scenario.periods[period].into(),
            has_begun: period <= view.period(),
            pairs: pairs.map(pair).filter(|pair| pair.passengers > 0).collect(),
        })
    }
}
