//! Fares, costs and energy prices from the network file's tariffs.

use std::collections::HashSet;

use serde::Deserialize;

use crate::demand_model::DemandModel;
use crate::raw::{Positions, RawRoute, each};
use crate::{Fares, FormatError, Matrix, VertiportIx, limits};

/// `[tariffs]` of the network file.
#[derive(Clone, Deserialize)]
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
    #[serde(default)]
    stand_cost_usd_per_day: f64,
    #[serde(default)]
    charger_cost_usd_per_day: f64,
    #[serde(default = "one")]
    fare_level: f64,
    energy_price_usd_per_kwh: RawPrice,
    #[serde(default)]
    pairs: Vec<RawPairTariff>,
}

/// The amounts of a single pair, in place of those of the formulas.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a pair's tariff")]
pub(crate) struct RawPairTariff {
    from: String,
    to: String,
    fare_usd: Option<f64>,
    passenger_cost_usd: Option<f64>,
}

/// The checked tariffs of a network.
#[derive(Clone)]
pub(crate) struct Tariffs {
    rules: RawTariffs,
    /// A fare in place of the one by distance and demand, dollars a passenger.
    fares_usd: Vec<((VertiportIx, VertiportIx), f64)>,
    /// R_ij in place of the one by distance, dollars a passenger.
    passenger_costs_usd: Vec<((VertiportIx, VertiportIx), f64)>,
}

/// The cost of a stand and of a charger, whether or not they are used; dollars a day.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SiteCosts {
    pub(crate) stand_usd: f64,
    pub(crate) charger_usd: f64,
}

/// A price for all day, or one for each demand period.
#[derive(Clone, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a number, or a list of numbers, one for each demand period"
)]
enum RawPrice {
    AllDay(f64),
    ByPeriod(Vec<f64>),
}

fn one() -> f64 {
    1.0
}

impl RawTariffs {
    /// The daily cost of a stand and of a charger at vertiports that do not state it, dollars.
    pub(crate) fn site_costs_usd(&self) -> SiteCosts {
        let Self { stand_cost_usd_per_day, charger_cost_usd_per_day, .. } = *self;
        SiteCosts { stand_usd: stand_cost_usd_per_day, charger_usd: charger_cost_usd_per_day }
    }

    pub(crate) fn check(
        mut self,
        periods: usize,
        places: &Positions,
    ) -> Result<Tariffs, FormatError> {
        self.check_numbers("tariffs", periods)?;
        let pairs = std::mem::take(&mut self.pairs);
        let mut tariffs =
            Tariffs { rules: self, fares_usd: Vec::new(), passenger_costs_usd: Vec::new() };
        tariffs.take_pairs("tariffs", pairs, places)?;
        Ok(tariffs)
    }

    /// Checks the numbers; `section` is their section of the file.
    fn check_numbers(&self, section: &str, periods: usize) -> Result<(), FormatError> {
        for (member, value, limits) in [
            ("passenger_cost_usd_per_mi", self.passenger_cost_usd_per_mi, &limits::TARIFF),
            ("fare_usd_per_mi", self.fare_usd_per_mi, &limits::TARIFF),
            ("fare_base", self.fare_base, &limits::TARIFF),
            ("fare_demand_weight", self.fare_demand_weight, &limits::TARIFF),
            ("boarding_fee_usd", self.boarding_fee_usd, &limits::MONEY_USD),
            ("flight_cost_usd", self.flight_cost_usd, &limits::MONEY_USD),
            ("flight_cost_usd_per_mi", self.flight_cost_usd_per_mi, &limits::TARIFF),
            ("aircraft_cost_usd_per_day", self.aircraft_cost_usd_per_day, &limits::MONEY_USD),
            ("stand_cost_usd_per_day", self.stand_cost_usd_per_day, &limits::MONEY_USD),
            ("charger_cost_usd_per_day", self.charger_cost_usd_per_day, &limits::MONEY_USD),
            ("fare_level", self.fare_level, &limits::FARE_FACTOR),
        ] {
            limits.check(value, || format!("{section}: {member}"))?;
        }
        if let Some(factors) = &self.fare_factors {
            let member = format!("{section}: fare_factors");
            by_period(factors, &limits::FARE_FACTOR, periods, &member)?;
        }
        let member = format!("{section}: energy_price_usd_per_kwh");
        let limits = &limits::ENERGY_PRICE_USD;
        match &self.energy_price_usd_per_kwh {
            RawPrice::AllDay(price) => limits.check(*price, || member),
            RawPrice::ByPeriod(prices) => by_period(prices, limits, periods, &member),
        }
    }
}

impl Tariffs {
    /// Takes the amounts of single pairs, in place of those of the formulas; `section` is their
    /// section of the file.
    fn take_pairs(
        &mut self,
        section: &str,
        pairs: Vec<RawPairTariff>,
        places: &Positions,
    ) -> Result<(), FormatError> {
        let mut seen = HashSet::new();
        each(pairs, |pair, at| {
            let RawPairTariff { from, to, fare_usd, passenger_cost_usd } = pair;
            let member = format!("{section}: pairs[{at}]");
            let what = format!("the tariff from {from:?} to {to:?}");
            if from == to {
                return Err(FormatError::RouteToItself { member, vertiport: from });
            }
            let route = RawRoute { from, to, both_ways: false };
            let route = route.check(places, &member)?;
            let ends = (route.from, route.to);
            if !seen.insert(ends) {
                return Err(FormatError::GivenTwice { member, what });
            }
            if fare_usd.is_none() && passenger_cost_usd.is_none() {
                return Err(FormatError::NotOneOf {
                    member,
                    choices: "at least one of fare_usd and passenger_cost_usd",
                    found: 0,
                });
            }
            for (name, value, list) in [
                ("fare_usd", fare_usd, &mut self.fares_usd),
                ("passenger_cost_usd", passenger_cost_usd, &mut self.passenger_costs_usd),
            ] {
                let Some(value) = value else { continue };
                limits::MONEY_USD.check(value, || format!("{member}: {name}"))?;
                list.push((ends, value));
            }
            Ok(())
        })?;
        Ok(())
    }

    /// The tariffs at the time when the demand was measured.
    pub(crate) fn at_reference(
        &self,
        reference: RawReference,
        periods: usize,
        places: &Positions,
    ) -> Result<Self, FormatError> {
        let mut then = self.clone();
        if let Some(pairs) = reference.pairs {
            (then.fares_usd, then.passenger_costs_usd) = (Vec::new(), Vec::new());
            then.take_pairs("market: reference", pairs, places)?;
        }
        let rules = &mut then.rules;
        for (now, then) in [
            (&mut rules.passenger_cost_usd_per_mi, reference.passenger_cost_usd_per_mi),
            (&mut rules.fare_usd_per_mi, reference.fare_usd_per_mi),
            (&mut rules.fare_base, reference.fare_base),
            (&mut rules.fare_demand_weight, reference.fare_demand_weight),
            (&mut rules.boarding_fee_usd, reference.boarding_fee_usd),
            (&mut rules.fare_level, Some(reference.fare_level.unwrap_or(1.0))),
        ] {
            *now = then.unwrap_or(*now);
        }
        if reference.fare_factors.is_some() {
            rules.fare_factors = reference.fare_factors;
        }
        rules.check_numbers("market: reference", periods)?;
        Ok(then)
    }

    /// E by period, dollars per kWh.
    pub(crate) fn energy_prices_usd(&self, periods: usize) -> Vec<f64> {
        match &self.rules.energy_price_usd_per_kwh {
            RawPrice::AllDay(price) => vec![*price; periods],
            RawPrice::ByPeriod(prices) => prices.clone(),
        }
    }

    /// R_ij, dollars a passenger.
    pub(crate) fn passenger_costs_usd(&self, distance_mi: &Matrix<f64>) -> Matrix<f64> {
        let mut costs_usd = Matrix::from_fn(distance_mi.size(), |from, to| {
            self.rules.passenger_cost_usd_per_mi * distance_mi[(from, to)]
        });
        for &(ends, cost_usd) in &self.passenger_costs_usd {
            costs_usd[ends] = cost_usd;
        }
        costs_usd
    }

    /// Cost of a flight with or without passengers, dollars: an amount for each flight and an
    /// amount for each mile.
    pub(crate) fn flight_costs_usd(&self, distance_mi: &Matrix<f64>) -> Matrix<f64> {
        Matrix::from_fn(distance_mi.size(), |from, to| {
            if from == to {
                return 0.0;
            }
            self.rules.flight_cost_usd + self.rules.flight_cost_usd_per_mi * distance_mi[(from, to)]
        })
    }

    /// Cost of each aircraft, whether or not it flies, dollars a day.
    pub(crate) fn aircraft_cost_usd(&self) -> f64 {
        self.rules.aircraft_cost_usd_per_day
    }

    /// P_ij, dollars a passenger: the fare in `pairs`, or else R_ij (base + weight Qbar_ij / max
    /// Qbar) + fare per mile x d_ij; times the period's factor, plus the boarding fee; times the
    /// level of all fares. The demand is the one at the reference fares.
    pub(crate) fn fares_usd(&self, distance_mi: &Matrix<f64>, demand: &DemandModel) -> Fares {
        let passenger_cost_usd = self.passenger_costs_usd(distance_mi);
        let mean = demand.reference_day_means(distance_mi.size());
        let most = mean.cells().iter().copied().fold(0.0, f64::max);
        let rules = &self.rules;
        let mut all_day = Matrix::from_fn(mean.size(), |from, to| {
            let share = if most > 0.0 { mean[(from, to)] / most } else { 0.0 };
            let on_cost = passenger_cost_usd[(from, to)]
                * (rules.fare_base + rules.fare_demand_weight * share);
            on_cost + rules.fare_usd_per_mi * distance_mi[(from, to)]
        });
        for &(ends, fare_usd) in &self.fares_usd {
            all_day[ends] = fare_usd;
        }
        let of_period = |factor: &f64| {
            Matrix::from_fn(all_day.size(), |from, to| {
                let fee_usd = if from == to { 0.0 } else { rules.boarding_fee_usd };
                (all_day[(from, to)] * factor + fee_usd) * rules.fare_level
            })
        };
        let Some(factors) = &rules.fare_factors else { return of_period(&1.0).into() };
        Fares::by_period(factors.iter().map(of_period).collect())
    }
}

/// Checks a list of numbers, one for each demand period.
fn by_period(
    list: &[f64],
    limits: &limits::Limits,
    periods: usize,
    member: &str,
) -> Result<(), FormatError> {
    if list.len() != periods {
        return Err(FormatError::WrongShape {
            member: member.to_owned(),
            expected: format!("an entry for each of {periods} periods"),
            found: list.len(),
        });
    }
    for (at, &value) in list.iter().enumerate() {
        limits.check(value, || format!("{member}[{at}]"))?;
    }
    Ok(())
}

/// The members of `[tariffs]` that were different when the demand was measured. All others are as
/// they are now, but `fare_level` was 1.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, expecting = "the members of reference")]
pub(crate) struct RawReference {
    pub(crate) passenger_cost_usd_per_mi: Option<f64>,
    pub(crate) fare_usd_per_mi: Option<f64>,
    pub(crate) fare_base: Option<f64>,
    pub(crate) fare_demand_weight: Option<f64>,
    pub(crate) fare_factors: Option<Vec<f64>>,
    pub(crate) boarding_fee_usd: Option<f64>,
    pub(crate) fare_level: Option<f64>,
    pub(crate) pairs: Option<Vec<RawPairTariff>>,
}
