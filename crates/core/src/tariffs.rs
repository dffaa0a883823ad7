//! Fares, costs and energy prices from the network file's tariffs.

use serde::Deserialize;

use crate::demand_model::DemandModel;
use crate::{Error, Fares, Matrix, limits};

/// `[tariffs]` of the network file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of tariffs")]
pub(crate) struct RawTariffs {
    passenger_cost_usd_per_mi: f64,
    #[serde(default)]
    fare_usd_per_mi: f64,
    fare_base: f64,
    fare_demand_weight: f64,
    fare_factors: Option<Vec<f64>>,
    #[serde(default)]
    boarding_fee_usd: f64,
    #[serde(default)]
    flight_cost_usd: f64,
    #[serde(default)]
    flight_cost_usd_per_mi: f64,
    #[serde(default)]
    aircraft_cost_usd_per_day: f64,
    energy_price_usd_per_kwh: RawPrice,
}

/// A price for all day, or one for each demand period.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "expected a number, or a list of numbers, one for each demand period"
)]
enum RawPrice {
    AllDay(f64),
    ByPeriod(Vec<f64>),
}

impl RawTariffs {
    pub(crate) fn check(&self, periods: usize, origin: &str) -> Result<(), Error> {
        for (member, value, limits) in [
            ("passenger_cost_usd_per_mi", self.passenger_cost_usd_per_mi, &limits::TARIFF),
            ("fare_usd_per_mi", self.fare_usd_per_mi, &limits::TARIFF),
            ("fare_base", self.fare_base, &limits::TARIFF),
            ("fare_demand_weight", self.fare_demand_weight, &limits::TARIFF),
            ("boarding_fee_usd", self.boarding_fee_usd, &limits::MONEY_USD),
            ("flight_cost_usd", self.flight_cost_usd, &limits::MONEY_USD),
            ("flight_cost_usd_per_mi", self.flight_cost_usd_per_mi, &limits::TARIFF),
            ("aircraft_cost_usd_per_day", self.aircraft_cost_usd_per_day, &limits::MONEY_USD),
        ] {
            limits.check(value, origin, || format!("tariffs: {member}"))?;
        }
        if let Some(factors) = &self.fare_factors {
            by_period(factors, &limits::FARE_FACTOR, periods, "fare_factors", origin)?;
        }
        let (member, limits) = ("energy_price_usd_per_kwh", &limits::ENERGY_PRICE_USD);
        match &self.energy_price_usd_per_kwh {
            RawPrice::AllDay(price) => {
                limits.check(*price, origin, || format!("tariffs: {member}"))
            }
            RawPrice::ByPeriod(prices) => by_period(prices, limits, periods, member, origin),
        }
    }

    /// E by period, dollars per kWh.
    pub(crate) fn energy_prices_usd(&self, periods: usize) -> Vec<f64> {
        match &self.energy_price_usd_per_kwh {
            RawPrice::AllDay(price) => vec![*price; periods],
            RawPrice::ByPeriod(prices) => prices.clone(),
        }
    }

    /// R_ij, dollars a passenger.
    pub(crate) fn passenger_costs_usd(&self, distance_mi: &Matrix<f64>) -> Matrix<f64> {
        Matrix::from_fn(distance_mi.size(), |from, to| {
            self.passenger_cost_usd_per_mi * distance_mi[(from, to)]
        })
    }

    /// Cost of a flight with or without passengers, dollars: an amount for each flight and an amount for each mile.
    pub(crate) fn flight_costs_usd(&self, distance_mi: &Matrix<f64>) -> Matrix<f64> {
        Matrix::from_fn(distance_mi.size(), |from, to| {
            if from == to {
                return 0.0;
            }
            self.flight_cost_usd + self.flight_cost_usd_per_mi * distance_mi[(from, to)]
        })
    }

    /// Cost of each aircraft, whether or not it flies, dollars a day.
    pub(crate) fn aircraft_cost_usd(&self) -> f64 {
        self.aircraft_cost_usd_per_day
    }

    /// P_ij = (R_ij (base + weight Qbar_ij / max Qbar) + fare per mile x d_ij) x the period's factor + boarding fee;
    /// dollars a passenger.
    pub(crate) fn fares_usd(
        &self,
        distance_mi: &Matrix<f64>,
        passenger_cost_usd: &Matrix<f64>,
        demand: &DemandModel,
    ) -> Fares {
        let mean = demand.day_means(distance_mi.size());
        let most = mean.cells().iter().copied().fold(0.0, f64::max);
        let all_day = Matrix::from_fn(mean.size(), |from, to| {
            let share = if most > 0.0 { mean[(from, to)] / most } else { 0.0 };
            let on_cost =
                passenger_cost_usd[(from, to)] * (self.fare_base + self.fare_demand_weight * share);
            on_cost + self.fare_usd_per_mi * distance_mi[(from, to)]
        });
        let of_period = |factor: &f64| {
            Matrix::from_fn(all_day.size(), |from, to| {
                let fee_usd = if from == to { 0.0 } else { self.boarding_fee_usd };
                all_day[(from, to)] * factor + fee_usd
            })
        };
        let Some(factors) = &self.fare_factors else { return of_period(&1.0).into() };
        Fares::by_period(factors.iter().map(of_period).collect())
    }
}

/// Checks a list of numbers, one for each demand period.
fn by_period(
    list: &[f64],
    limits: &limits::Limits,
    periods: usize,
    member: &str,
    origin: &str,
) -> Result<(), Error> {
    if list.len() != periods {
        return Err(Error::WrongShape {
            origin: origin.to_owned(),
            member: format!("tariffs: {member}"),
            expected: format!("an entry for each of {periods} periods"),
            found: list.len(),
        });
    }
    for (at, &value) in list.iter().enumerate() {
        limits.check(value, origin, || format!("tariffs: {member}[{at}]"))?;
    }
    Ok(())
}
