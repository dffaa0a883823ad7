//! How passengers respond to fares, and how large the whole market is: `[market]` of the network
//! file.
//!
//! The demand model gives the passengers who want to fly at the *reference fares*. At another fare
//! P in place of the reference fare P0 a pair has
//!
//! ```text
//! Q = Q0 x demand_factor x exp(elasticity x (1 - P / P0))
//! ```
//!
//! passengers. So `elasticity` is the price elasticity at the reference fare: one percent more fare
//! costs `elasticity` percent of the passengers. Further up passengers react more strongly, as they
//! do in models of discrete choice, so that for every elasticity above 0 there is a fare beyond
//! which revenue falls: a monopolist without other limits would ask for the passenger's cost plus
//! P0 / elasticity.

use std::collections::HashSet;

use serde::Deserialize;

use super::tariffs::RawReference;
use crate::raw::{Positions, RawRoute, each};
use crate::{Fares, FormatError, Matrix, VertiportIx, limits};

/// `[market]` of the network file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of market")]
pub(crate) struct RawMarket {
    #[serde(default = "one")]
    demand_factor: f64,
    #[serde(default)]
    elasticity: f64,
    #[serde(default)]
    elasticities: Vec<RawElasticity>,
    #[serde(default)]
    pub(crate) reference: RawReference,
}

/// The elasticity of a single pair.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a pair's elasticity")]
struct RawElasticity {
    from: String,
    to: String,
    elasticity: f64,
}

/// A checked market.
pub(crate) struct Market {
    demand_factor: f64,
    elasticity: Matrix<f64>,
}

fn one() -> f64 {
    1.0
}

impl Default for RawMarket {
    /// A market whose passengers do not respond.
    fn default() -> Self {
        let (elasticities, reference) = (Vec::new(), RawReference::default());
        Self { demand_factor: one(), elasticity: 0.0, elasticities, reference }
    }
}

impl RawMarket {
    /// Checks all members but the reference, which is checked with the tariffs.
    pub(crate) fn check(
        self,
        places: &Positions,
        vertiports: usize,
    ) -> Result<Market, FormatError> {
        limits::DEMAND_FACTOR.check(self.demand_factor, || "market: demand_factor".to_owned())?;
        limits::ELASTICITY.check(self.elasticity, || "market: elasticity".to_owned())?;
        let mut elasticity = Matrix::from_fn(vertiports, |_, _| self.elasticity);
        let mut seen = HashSet::new();
        each(self.elasticities, |raw, at| {
            let member = format!("market: elasticities[{at}]");
            limits::ELASTICITY.check(raw.elasticity, || format!("{member}: elasticity"))?;
            let what = format!("the elasticity from {:?} to {:?}", raw.from, raw.to);
            let route = RawRoute { from: raw.from, to: raw.to, both_ways: false };
            let route = route.check(places, &member)?;
            if !seen.insert((route.from, route.to)) {
                return Err(FormatError::GivenTwice { member, what });
            }
            elasticity[(route.from, route.to)] = raw.elasticity;
            Ok(())
        })?;
        Ok(Market { demand_factor: self.demand_factor, elasticity })
    }
}

impl Market {
    /// The factor on the demand of every pair in each period, if any is not 1.
    pub(crate) fn factors(
        &self,
        fares: &Fares,
        reference: &Fares,
        periods: usize,
    ) -> Option<Vec<Matrix<f64>>> {
        let of_period = |period| {
            let (fares, reference) = (fares.in_period(period), reference.in_period(period));
            Matrix::from_fn(fares.size(), |from, to| {
                self.factor((from, to), fares[(from, to)], reference[(from, to)])
            })
        };
        let factors: Vec<Matrix<f64>> = (0..periods).map(of_period).collect();
        let responds = factors.iter().any(|table| table.cells().iter().any(|&one| one != 1.0));
        responds.then_some(factors)
    }

    /// Where the reference fare is 0, no passenger flies at any other fare.
    fn factor(&self, pair: (VertiportIx, VertiportIx), fare_usd: f64, reference_usd: f64) -> f64 {
        let elasticity = self.elasticity[pair];
        if elasticity == 0.0 || fare_usd == reference_usd {
            return self.demand_factor;
        }
        self.demand_factor * libm::exp(elasticity * (1.0 - fare_usd / reference_usd))
    }
}

#[cfg(test)]
mod tests {
    use super::Market;
    use crate::{Fares, Matrix, VertiportIx};

    fn factor(elasticity: f64, fare_usd: f64, reference_usd: f64) -> f64 {
        let market =
            Market { demand_factor: 1.0, elasticity: Matrix::from_fn(2, |_, _| elasticity) };
        market.factor((VertiportIx(0), VertiportIx(1)), fare_usd, reference_usd)
    }

    #[test]
    fn elasticity_is_the_share_lost_for_a_small_rise() {
        for elasticity in [0.3, 1.0, 2.5] {
            let lost = 1.0 - factor(elasticity, 100.1, 100.0);
            assert!((lost / 0.001 - elasticity).abs() < 0.01 * elasticity, "{elasticity}: {lost}");
            assert_eq!(factor(elasticity, 100.0, 100.0), 1.0);
        }
        assert_eq!(factor(0.0, 500.0, 100.0), 1.0);
        assert_eq!((factor(1.0, 0.0, 0.0), factor(1.0, 5.0, 0.0)), (1.0, 0.0));
    }

    /// The fare with the highest margin, searched for on a fine grid, is the passenger's cost plus
    /// P0 / elasticity.
    #[test]
    fn revenue_has_its_maximum_at_the_fare_of_the_formula() {
        let (cost_usd, reference_usd) = (12.0, 90.0);
        for elasticity in [0.5, 1.0, 2.0] {
            let margin =
                |fare_usd: f64| (fare_usd - cost_usd) * factor(elasticity, fare_usd, reference_usd);
            let best = (0..40_000).map(|step| f64::from(step) / 100.0);
            let best = best.max_by(|&one, &other| margin(one).total_cmp(&margin(other)));
            let expected = cost_usd + reference_usd / elasticity;
            assert!((best.expect("a fare") - expected).abs() < 0.011, "{elasticity}: {best:?}");
        }
    }

    #[test]
    fn a_market_without_response_has_no_factors() {
        let market = Market { demand_factor: 1.0, elasticity: Matrix::from_fn(2, |_, _| 1.5) };
        let fares = |usd: f64| Fares::from(Matrix::from_fn(2, |_, _| usd));
        assert!(market.factors(&fares(40.0), &fares(40.0), 3).is_none());
        let factors = market.factors(&fares(50.0), &fares(40.0), 3).expect("a response");
        assert_eq!(factors.len(), 3);
        assert!(factors.iter().all(|table| table.cells().iter().all(|&one| one < 1.0)));
    }
}
