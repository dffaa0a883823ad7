//! Eq. 1 (§III.C): how many passengers want to fly from i to j in a period, as a normal distribution.

use serde::Deserialize;

use crate::limits;
use crate::{Error, Matrix, Time, VertiportIx, check};

/// N(mean, sd) passengers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Level {
    pub(crate) mean: f64,
    pub(crate) sd: f64,
}

/// Eq. 1 with its numbers.
#[derive(Debug, Clone)]
pub(crate) struct DemandModel {
    /// Start of each period.
    pub(crate) periods: Vec<Time>,
    /// T_peak1: towards and among busy vertiports.
    morning_peak: usize,
    /// T_peak2: from and among busy vertiports.
    evening_peak: usize,
    peak: Level,
    busy_pairs: Level,
    otherwise: Level,
    /// V_B, by vertiport.
    busy: Vec<bool>,
}

impl DemandModel {
    /// The row of Eq. 1 that holds, the first that does; `None` from a vertiport to itself.
    pub(crate) fn level(&self, period: usize, from: VertiportIx, to: VertiportIx) -> Option<Level> {
        if from == to {
            return None;
        }
        let morning = period == self.morning_peak;
        let evening = period == self.evening_peak;
        Some(match (self.busy[from.at()], self.busy[to.at()]) {
            (true, true) if morning || evening => self.peak,
            (false, true) if morning => self.peak,
            (true, false) if evening => self.peak,
            (true, true) => self.busy_pairs,
            _ => self.otherwise,
        })
    }

    /// The means of Eq. 1 in one period, passengers; 0 on the diagonal.
    pub(crate) fn means(&self, period: usize) -> Matrix<f64> {
        Matrix::from_fn(self.busy.len(), |from, to| {
            self.level(period, from, to).map_or(0.0, |level| level.mean)
        })
    }

    /// The mean over the day's periods of the means of Eq. 1.
    pub(crate) fn day_means(&self) -> Matrix<f64> {
        let periods = self.periods.len();
        Matrix::from_fn(self.busy.len(), |from, to| {
            let mean = |period| self.level(period, from, to).map_or(0.0, |level| level.mean);
            (0..periods).map(mean).sum::<f64>() / periods as f64
        })
    }
}

/// `[demand]` of the network file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of demand")]
pub(crate) struct RawDemandModel {
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

impl RawDemandModel {
    /// Checks all but the order of the periods, which [`Day::check`](crate::Day::check) does for every day.
    pub(crate) fn check(self, busy: Vec<bool>, origin: &str) -> Result<DemandModel, Error> {
        check::entry_count(
            origin,
            "demand: periods",
            self.periods.len(),
            limits::entries::PERIODS,
        )?;
        check::demand_cells(origin, busy.len(), self.periods.len())?;
        let peak = |time: Time, member: &str| {
            self.periods.iter().position(|&start| start == time).ok_or_else(|| Error::UnknownId {
                origin: origin.to_owned(),
                member: format!("demand: {member}"),
                found: time.to_string(),
                list: "starts of demand periods",
            })
        };
        Ok(DemandModel {
            morning_peak: peak(self.morning_peak, "morning_peak")?,
            evening_peak: peak(self.evening_peak, "evening_peak")?,
            peak: self.peak.check("peak", origin)?,
            busy_pairs: self.busy_pairs.check("busy_pairs", origin)?,
            otherwise: self.otherwise.check("otherwise", origin)?,
            busy,
            periods: self.periods,
        })
    }
}

impl RawLevel {
    fn check(&self, member: &str, origin: &str) -> Result<Level, Error> {
        let Self { mean, sd } = *self;
        limits::DEMAND_MEAN.check(mean, origin, || format!("demand: {member}: mean"))?;
        limits::DEMAND_SD.check(sd, origin, || format!("demand: {member}: sd"))?;
        Ok(Level { mean, sd })
    }
}
