//! A day's passengers of each pair, spread over the periods by shares, as a market study or a
//! survey gives them.

use serde::Deserialize;

use super::distribution::{Distribution, Name, RawDistribution};
use super::{DemandModel, Kind, check_periods};
use crate::{FormatError, Matrix, Time, VertiportIx, limits};

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
    pub(crate) fn check(self, vertiports: usize) -> Result<DemandModel, FormatError> {
        check_periods(&self.periods, "daily_demand", vertiports)?;
        let shares = &self.shares_percent;
        let member = |member: &str| format!("daily_demand: {member}");
        length(shares, self.periods.len(), "period", member("shares_percent"))?;
        for (at, &share) in shares.iter().enumerate() {
            let member = || member(&format!("shares_percent[{at}]"));
            limits::SHARE_PERCENT.check(share, member)?;
        }
        let distribution = RawDistribution {
            name: self.distribution,
            noise: self.noise,
            dispersion: self.dispersion,
        };
        let distribution = distribution.check("daily_demand")?;
        let passengers = match (self.passengers, self.gravity) {
            (Some(rows), None) => table(rows, vertiports)?,
            (None, Some(gravity)) => gravity.passengers(vertiports)?,
            (rows, gravity) => {
                return Err(FormatError::NotOneOf {
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
    fn passengers(&self, vertiports: usize) -> Result<Matrix<f64>, FormatError> {
        let member = |member: &str| format!("daily_demand: gravity: {member}");
        limits::DAILY_DEMAND.check(self.passengers, || member("passengers"))?;
        length(&self.weights, vertiports, "vertiport", member("weights"))?;
        for (at, &weight) in self.weights.iter().enumerate() {
            limits::WEIGHT.check(weight, || member(&format!("weights[{at}]")))?;
        }
        // A product of tiny weights could be 0 or lose digits. A power of two changes no digit.
        let (_, exponent) = libm::frexp(self.weights.iter().copied().fold(0.0, f64::max));
        let weight = |at: VertiportIx| libm::ldexp(self.weights[at.at()], -exponent);
        let pull =
            Matrix::from_fn(
                vertiports,
                |from, to| {
                    if from == to { 0.0 } else { weight(from) * weight(to) }
                },
            );
        let all: f64 = pull.cells().iter().sum();
        let scale = if all > 0.0 { self.passengers / all } else { 0.0 };
        Ok(Matrix::from_fn(vertiports, |from, to| pull[(from, to)] * scale))
    }
}

fn table(rows: Vec<Vec<f64>>, vertiports: usize) -> Result<Matrix<f64>, FormatError> {
    let member = |at: usize| format!("daily_demand: passengers[{at}]");
    if rows.len() != vertiports {
        return Err(wrong_length(
            "daily_demand: passengers".to_owned(),
            vertiports,
            "vertiport",
            rows.len(),
        ));
    }
    for (at, row) in rows.iter().enumerate() {
        length(row, vertiports, "vertiport", member(at))?;
        for (to, &passengers) in row.iter().enumerate() {
            let member = || format!("{}[{to}]", member(at));
            limits::DAILY_DEMAND.check(passengers, member)?;
        }
    }
    Ok(Matrix::from_rows(vertiports, rows).expect("a square, just checked"))
}

fn length(list: &[f64], due: usize, entry: &str, member: String) -> Result<(), FormatError> {
    if list.len() == due {
        return Ok(());
    }
    Err(wrong_length(member, due, entry, list.len()))
}

fn wrong_length(member: String, due: usize, entry: &str, found: usize) -> FormatError {
    let expected = format!("an entry for each of {due} {entry}s");
    FormatError::WrongShape { member, expected, found }
}
