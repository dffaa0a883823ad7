//! `days.csv`: every policy's every day, one row each, for other computations.

use serde::Serialize;

use crate::record::{ComparisonRecords, DayRecord};

#[derive(Serialize)]
struct Row<'a> {
    policy: &'a str,
    day: &'a str,
    seed: u64,
    profit_usd: f64,
    revenue_usd: f64,
    passenger_cost_usd: f64,
    energy_cost_usd: f64,
    flight_cost_usd: f64,
    aircraft_cost_usd: f64,
    energy_kwh: f64,
    potential_usd: f64,
    reward: f64,
    flights: u32,
    repositioning_flights: u32,
    holds: u32,
    decisions: u32,
    passengers: u64,
    spilled_passengers: u64,
    load_factor: f64,
    upper_bound_usd: Option<f64>,
    bound_share: Option<f64>,
}

impl<'a> Row<'a> {
    fn of(policy: &'a str, day: &'a DayRecord) -> Self {
        Self {
            policy,
            day: &day.day,
            seed: day.seed,
            profit_usd: day.profit_usd,
            revenue_usd: day.revenue_usd,
            passenger_cost_usd: day.passenger_cost_usd,
            energy_cost_usd: day.energy_cost_usd,
            flight_cost_usd: day.flight_cost_usd,
            aircraft_cost_usd: day.aircraft_cost_usd,
            energy_kwh: day.energy_kwh,
            potential_usd: day.potential_usd,
            reward: day.reward,
            flights: day.flights,
            repositioning_flights: day.repositioning_flights,
            holds: day.holds,
            decisions: day.decisions,
            passengers: day.passengers,
            spilled_passengers: day.spilled_passengers,
            load_factor: day.load_factor,
            upper_bound_usd: day.upper_bound_usd,
            bound_share: day.bound_share(),
        }
    }
}

/// The study's days as CSV with a header row; policies in the order in which they were named.
///
/// # Panics
/// Never: writing rows of numbers and text to memory cannot fail.
pub(crate) fn text(study: &ComparisonRecords) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for policy in &study.policies {
        for day in &policy.days {
            writer.serialize(Row::of(&policy.name, day)).expect("flat rows written to memory");
        }
    }
    let bytes = writer.into_inner().expect("memory takes every byte");
    String::from_utf8(bytes).expect("text and numbers are UTF-8")
}
