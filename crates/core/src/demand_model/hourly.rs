//! Mean passengers of each pair and period, as a planner's own study or counts give them. They are
//! rows in the network file, or a separate table (`network_file/demand_table.rs`).

use std::collections::HashSet;

use serde::Deserialize;

use super::distribution::{Distribution, Name, RawDistribution};
use super::{DemandModel, Kind, check_periods};
use crate::raw::{Positions, each};
use crate::{FormatError, Matrix, Time, VertiportIx, limits};

/// Mean passengers by period and pair.
#[derive(Debug, Clone)]
pub(super) struct HourlyDemand {
    passengers: Vec<Matrix<f64>>,
    distribution: Distribution,
}

impl HourlyDemand {
    pub(super) fn mean(&self, period: usize, from: VertiportIx, to: VertiportIx) -> f64 {
        self.passengers[period][(from, to)]
    }

    pub(super) fn distribution(&self) -> Distribution {
        self.distribution
    }
}

/// `[hourly_demand]` of the network file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of hourly_demand")]
pub(crate) struct RawHourlyDemand {
    pub(crate) periods: Vec<Time>,
    distribution: Option<Name>,
    noise: Option<f64>,
    dispersion: Option<f64>,
    pub(crate) pairs: Option<Vec<RawPair>>,
    /// Path of a CSV file, relative to the folder of the network file.
    pub(crate) table: Option<String>,
}

/// A pair with its mean passengers of each period.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a pair")]
pub(crate) struct RawPair {
    from: String,
    to: String,
    passengers: Vec<f64>,
}

impl RawHourlyDemand {
    pub(crate) fn check(
        self,
        places: &Positions,
        vertiports: usize,
    ) -> Result<DemandModel, FormatError> {
        check_periods(&self.periods, "hourly_demand", vertiports)?;
        let distribution = RawDistribution {
            name: self.distribution,
            noise: self.noise,
            dispersion: self.dispersion,
        };
        let distribution = distribution.check("hourly_demand")?;
        let pairs = match (self.pairs, self.table) {
            (Some(pairs), None) => pairs,
            (None, Some(table)) => {
                return Err(FormatError::TableWithoutFolder { table });
            }
            (pairs, table) => {
                return Err(FormatError::NotOneOf {
                    member: "hourly_demand".to_owned(),
                    choices: "exactly one of pairs and table",
                    found: usize::from(pairs.is_some()) + usize::from(table.is_some()),
                });
            }
        };
        let mut passengers = vec![Matrix::from_fn(vertiports, |_, _| 0.0); self.periods.len()];
        let mut seen = HashSet::new();
        each(pairs, |pair, at| {
            let member = format!("hourly_demand: pairs[{at}]");
            let ends = pair.check(self.periods.len(), places, &member)?;
            if !seen.insert(ends) {
                let what = format!("the demand from {:?} to {:?}", pair.from, pair.to);
                return Err(FormatError::GivenTwice { member, what });
            }
            for (table, mean) in passengers.iter_mut().zip(pair.passengers) {
                table[ends] = mean;
            }
            Ok(())
        })?;
        let kind = Kind::Hourly(HourlyDemand { passengers, distribution });
        Ok(DemandModel::new(self.periods, kind))
    }
}

impl RawPair {
    /// Checks that the numbers are within bounds, and returns the pair's vertiports.
    fn check(
        &self,
        periods: usize,
        places: &Positions,
        member: &str,
    ) -> Result<(VertiportIx, VertiportIx), FormatError> {
        let end = |id: &str, end: &str| {
            places.position(id, || format!("{member}: {end}")).map(VertiportIx::new)
        };
        let (from, to) = (end(&self.from, "from")?, end(&self.to, "to")?);
        if from == to {
            return Err(FormatError::RouteToItself {
                member: member.to_owned(),
                vertiport: self.from.clone(),
            });
        }
        if self.passengers.len() != periods {
            return Err(FormatError::WrongShape {
                member: format!("{member}: passengers"),
                expected: format!("an entry for each of {periods} periods"),
                found: self.passengers.len(),
            });
        }
        for (at, &mean) in self.passengers.iter().enumerate() {
            let member = || format!("{member}: passengers[{at}]");
            limits::DEMAND_MEAN.check(mean, member)?;
        }
        Ok((from, to))
    }
}
