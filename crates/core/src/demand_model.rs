//! The models of how many passengers want to fly from i to j in a period. A network file chooses
//! one of them.
//!
//! They are Eq. 1 (`demand_model/equation_1.rs`), a day's total spread over the periods
//! (`demand_model/daily.rs`), means of each pair and period (`demand_model/hourly.rs`), and uniform
//! draws (`demand_model/uniform.rs`). Eq. 1 rounds its draws, as the paper does, which moves the
//! mean where demand is thin. The draws of the other models keep the mean that the file asks for.

mod daily;
mod distribution;
mod draws;
mod equation_1;
mod hourly;
mod uniform;

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::limits::entries;
use crate::random::to_whole;
use crate::{FormatError, Matrix, Time, VertiportIx, check};

pub(crate) use daily::RawDailyDemand;
pub(crate) use equation_1::RawEquation1;
pub(crate) use hourly::RawHourlyDemand;
pub(crate) use uniform::RawUniformDemand;

/// The normal distribution N(mean, sd) of passengers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Level {
    pub(crate) mean: f64,
    pub(crate) sd: f64,
}

/// The model that the passengers of a network's days are drawn from.
#[derive(Debug, Clone)]
pub(crate) struct DemandModel {
    /// Start of each period.
    pub(crate) periods: Vec<Time>,
    kind: Kind,
    /// The response of the market: a factor for each pair in each period. `None` where all are 1.
    pub(crate) factors: Option<Vec<Matrix<f64>>>,
}

#[derive(Debug, Clone)]
enum Kind {
    Equation1(equation_1::Equation1),
    Daily(daily::DailyDemand),
    Hourly(hourly::HourlyDemand),
    Uniform(uniform::UniformDemand),
}

impl DemandModel {
    fn new(periods: Vec<Time>, kind: Kind) -> Self {
        Self { periods, kind, factors: None }
    }

    /// Mean passengers of a pair in a period; 0 from a vertiport to itself.
    pub(crate) fn mean(&self, period: usize, from: VertiportIx, to: VertiportIx) -> f64 {
        let factor = self.factors.as_ref().map_or(1.0, |factors| factors[period][(from, to)]);
        factor * self.reference_mean(period, from, to)
    }

    /// The mean at the reference fares.
    fn reference_mean(&self, period: usize, from: VertiportIx, to: VertiportIx) -> f64 {
        if from == to {
            return 0.0;
        }
        match &self.kind {
            Kind::Equation1(model) => model.level(period, from, to).mean,
            Kind::Daily(model) => model.mean(period, from, to),
            Kind::Hourly(model) => model.mean(period, from, to),
            Kind::Uniform(model) => model.mean(),
        }
    }

    /// Mean passengers of every pair in one period.
    pub(crate) fn means(&self, period: usize, vertiports: usize) -> Matrix<f64> {
        Matrix::from_fn(vertiports, |from, to| self.mean(period, from, to))
    }

    /// Mean passengers of every pair in each period.
    pub(crate) fn all_means(&self, vertiports: usize) -> Vec<Matrix<f64>> {
        (0..self.periods.len()).map(|period| self.means(period, vertiports)).collect()
    }

    /// Mean passengers of every pair in a period at the reference fares, averaged over the day's
    /// periods.
    pub(crate) fn reference_day_means(&self, vertiports: usize) -> Matrix<f64> {
        let periods = self.periods.len();
        Matrix::from_fn(vertiports, |from, to| {
            (0..periods).map(|period| self.reference_mean(period, from, to)).sum::<f64>()
                / periods as f64
        })
    }

    /// Draws the passengers of a pair of different vertiports in a period, at the reference fares.
    pub(crate) fn draw(
        &self,
        period: usize,
        from: VertiportIx,
        to: VertiportIx,
        random: &mut ChaCha8Rng,
    ) -> u32 {
        match &self.kind {
            Kind::Equation1(model) => model.level(period, from, to).draw(random),
            Kind::Daily(model) => model.distribution().draw(model.mean(period, from, to), random),
            Kind::Hourly(model) => model.distribution().draw(model.mean(period, from, to), random),
            Kind::Uniform(model) => model.draw(random),
        }
    }
}

impl Level {
    fn draw(self, random: &mut ChaCha8Rng) -> u32 {
        let deviation: f64 = StandardNormal.sample(random);
        to_whole(self.mean + self.sd * deviation)
    }
}

/// Refuses an empty list of periods, too many periods, and too many cells of demand. The order of
/// the periods is checked with each day.
fn check_periods(periods: &[Time], member: &str, vertiports: usize) -> Result<(), FormatError> {
    check::entry_count(&format!("{member}: periods"), periods.len(), entries::PERIODS)?;
    check::demand_cells(vertiports, periods.len())
}
