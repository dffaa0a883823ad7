//! A day's passengers of each pair, spread over the periods by shares, as a market study or a
//! survey gives them.

use serde::Deserialize;

use super::distribution::{Distribution, Name, RawDistribution};
use super::{DemandModel, Kind, check_periods};
use crate::{Error, Matrix, Time, VertiportIx, limits};

/// Mean passengers a day, and how they spread over the day.
#[derive(Debug, Clone)]
pub(super) struct DailyDemand {
    /// Mean passengers a day, `[from][to]`.
    passengers: Matrix<f64>,
    /// The share of the day's passengers in each period.
    shares: Vec<f64>,
    distribution: Distribution,
}

impl DailyDemand {
    pub(super) fn mean(&self, period: usize, from: VertiportIx, to: VertiportIx) -> f64 {
        self.passengers[(from, to)] * self.shares[period]
    }

    pub(super) fn distribution(&self) -> Distribution {
        self.distribution
    }
}

/// `[daily_demand]` of the network file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of daily_demand")]
pub(crate) struct RawDailyDemand {
    periods: Vec<Time>,
    shares_percent: Vec<f64>,
    distribution: Option<Name>,
    noise: Option<f64>,
    dispersion: Option<f64>,
    passengers: Option<Vec<Vec<f64>>>,
    gravity: Option<RawGravity>,
}

/// Passengers of each pair in proportion to the product of its vertiports' weights.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of gravity")]
struct RawGravity {
    passengers: f64,
    weights: Vec<f64>,
}

impl RawDailyDemand {
    pub(crate) fn check(self, vertiports: usize, origin: &str) -> Result<DemandModel, Error> {
        check_periods(&self.periods, "daily_demand", vertiports, origin)?;
        let shares = &self.shares_percent;
        let member = |member: &str| format!("daily_demand: {member}");
        length(shares, self.periods.len(), "period", member("shares_percent"), origin)?;
        for (at, &share) in shares.iter().enumerate() {
            let member = || member(&format!("shares_percent[{at}]"));
            limits::SHARE_PERCENT.check(share, origin, member)?;
        }
        let distribution = RawDistribution {
            name: self.distribution,
            noise: self.noise,
            dispersion: self.dispersion,
        };
        let distribution = distribution.check("daily_demand", origin)?;
        let passengers = match (self.passengers, self.gravity) {
            (Some(rows), None) => table(rows, vertiports, origin)?,
            (None, Some(gravity)) => gravity.passengers(vertiports, origin)?,
            (rows, gravity) => {
                return Err(Error::NotOneOf {
                    origin: origin.to_owned(),
                    member: "daily_demand".to_owned(),
                    choices: "exactly one of passengers and gravity",
                    found: usize::from(rows.is_some()) + usize::from(gravity.is_some()),
                });
            }
        };
        let shares = self.shares_percent.iter().map(|percent| percent / 100.0).collect();
        let kind = Kind::Daily(DailyDemand { passengers, shares, distribution });
        Ok(DemandModel::new(self.periods, kind))
    }
}

impl RawGravity {
    /// Distributes the total over all pairs of different vertiports.
    fn passengers(&self, vertiports: usize, origin: &str) -> Result<Matrix<f64>, Error> {
        let member = |member: &str| format!("daily_demand: gravity: {member}");
        limits::DAILY_DEMAND.check(self.passengers, origin, || member("passengers"))?;
        length(&self.weights, vertiports, "vertiport", member("weights"), origin)?;
        for (at, &weight) in self.weights.iter().enumerate() {
            limits::WEIGHT.check(weight, origin, || member(&format!("weights[{at}]")))?;
        }
        let pull = Matrix::from_fn(vertiports, |from, to| {
            if from == to { 0.0 } else { self.weights[from.at()] * self.weights[to.at()] }
        });
        let all: f64 = pull.cells().iter().sum();
        let scale = if all > 0.0 { self.passengers / all } else { 0.0 };
        Ok(Matrix::from_fn(vertiports, |from, to| pull[(from, to)] * scale))
    }
}

fn table(rows: Vec<Vec<f64>>, vertiports: usize, origin: &str) -> Result<Matrix<f64>, Error> {
    let member = |at: usize| format!("daily_demand: passengers[{at}]");
    if rows.len() != vertiports {
        return Err(wrong_length(
            "daily_demand: passengers".to_owned(),
            vertiports,
            "vertiport",
            rows.len(),
            origin,
        ));
    }
    for (at, row) in rows.iter().enumerate() {
        length(row, vertiports, "vertiport", member(at), origin)?;
        for (to, &passengers) in row.iter().enumerate() {
            let member = || format!("{}[{to}]", member(at));
            limits::DAILY_DEMAND.check(passengers, origin, member)?;
        }
    }
    Ok(Matrix::from_rows(vertiports, rows).expect("a square, just checked"))
}

fn length(
    list: &[f64],
    due: usize,
    entry: &str,
    member: String,
    origin: &str,
) -> Result<(), Error> {
    if list.len() == due {
        return Ok(());
    }
    Err(wrong_length(member, due, entry, list.len(), origin))
}

fn wrong_length(member: String, due: usize, entry: &str, found: usize, origin: &str) -> Error {
    let expected = format!("an entry for each of {due} {entry}s");
    Error::WrongShape { origin: origin.to_owned(), member, expected, found }
}
