//! Eq. 1 (§III.C): how many passengers want to fly from i to j in a period, as a normal
//! distribution.

use serde::Deserialize;

use super::{DemandModel, Kind, Level};
use crate::limits;
use crate::{FormatError, Time, VertiportIx};

/// Eq. 1 with the numbers of a network file.
#[derive(Debug, Clone)]
pub(super) struct Equation1 {
    /// T_peak1, the period with peak demand towards and among busy vertiports.
    morning_peak: usize,
    /// T_peak2, the period with peak demand from and among busy vertiports.
    evening_peak: usize,
    peak: Level,
    busy_pairs: Level,
    otherwise: Level,
    /// V_B: whether each vertiport is busy.
    busy: Vec<bool>,
}

impl Equation1 {
    /// The first row of Eq. 1 that holds for a pair of vertiports.
    pub(super) fn level(&self, period: usize, from: VertiportIx, to: VertiportIx) -> Level {
        let morning = period == self.morning_peak;
        let evening = period == self.evening_peak;
        match (self.busy[from.at()], self.busy[to.at()]) {
            (true, true) if morning || evening => self.peak,
            (false, true) if morning => self.peak,
            (true, false) if evening => self.peak,
            (true, true) => self.busy_pairs,
            _ => self.otherwise,
        }
    }
}

/// `[demand]` of the network file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of demand")]
pub(crate) struct RawEquation1 {
    periods: Vec<Time>,
    morning_peak: Time,
    evening_peak: Time,
    peak: RawLevel,
    busy_pairs: RawLevel,
    otherwise: RawLevel,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a mean and an sd")]
struct RawLevel {
    mean: f64,
    sd: f64,
}

impl RawEquation1 {
    /// Checks everything but the order of the periods, which is checked with each day.
    pub(crate) fn check(self, busy: Vec<bool>) -> Result<DemandModel, FormatError> {
        super::check_periods(&self.periods, "demand", busy.len())?;
        let peak = |time: Time, member: &str| {
            self.periods.iter().position(|&start| start == time).ok_or_else(|| {
                FormatError::UnknownId {
                    member: format!("demand: {member}"),
                    found: time.to_string(),
                    list: "starts of demand periods",
                }
            })
        };
        let kind = Kind::Equation1(Equation1 {
            morning_peak: peak(self.morning_peak, "morning_peak")?,
            evening_peak: peak(self.evening_peak, "evening_peak")?,
            peak: self.peak.check("peak")?,
            busy_pairs: self.busy_pairs.check("busy_pairs")?,
            otherwise: self.otherwise.check("otherwise")?,
            busy,
        });
        Ok(DemandModel::new(self.periods, kind))
    }
}

impl RawLevel {
    fn check(&self, member: &str) -> Result<Level, FormatError> {
        let Self { mean, sd } = *self;
        limits::DEMAND_MEAN.check(mean, || format!("demand: {member}: mean"))?;
        limits::DEMAND_SD.check(sd, || format!("demand: {member}: sd"))?;
        Ok(Level { mean, sd })
    }
}
