//! Uniform demand: for every pair and period, each whole number of passengers from a least to a
//! most is equally likely.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::Deserialize;

use super::{DemandModel, Kind, check_periods};
use crate::{FormatError, Time, limits};

/// The least and the most passengers of a pair in a period.
#[derive(Debug, Clone)]
pub(super) struct UniformDemand {
    least: u32,
    most: u32,
}

impl UniformDemand {
    pub(super) fn mean(&self) -> f64 {
        f64::midpoint(f64::from(self.least), f64::from(self.most))
    }

    pub(super) fn draw(&self, random: &mut ChaCha8Rng) -> u32 {
        random.random_range(self.least..=self.most)
    }
}

/// `[uniform_demand]` of the network file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of uniform_demand")]
pub(crate) struct RawUniformDemand {
    periods: Vec<Time>,
    least: f64,
    most: f64,
}

impl RawUniformDemand {
    pub(crate) fn check(self, vertiports: usize) -> Result<DemandModel, FormatError> {
        check_periods(&self.periods, "uniform_demand", vertiports)?;
        let number = |value, member: &str| {
            limits::UNIFORM_DEMAND.whole_number(value, || format!("uniform_demand: {member}"))
        };
        let (least, most): (u32, u32) = (number(self.least, "least")?, number(self.most, "most")?);
        if least > most {
            return Err(FormatError::OutOfRange {
                member: "uniform_demand: least".to_owned(),
                rule: format!("at most {most}, which is most"),
                found: least.to_string(),
                hint: None,
            });
        }
        let kind = Kind::Uniform(UniformDemand { least, most });
        Ok(DemandModel::new(self.periods, kind))
    }
}
