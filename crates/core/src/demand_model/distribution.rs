//! How a pair's passengers of a period scatter around their mean, as a network file chooses. The
//! draws are whole passengers, and their mean is exactly the given one.

use rand_chacha::ChaCha8Rng;
use serde::Deserialize;

use super::draws;
use crate::limits;
use crate::random::rounded_by_chance;
use crate::{FormatError, limits::Limits};

/// A distribution of whole passengers around any mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Distribution {
    /// Each passenger comes independently of the others, so the variance is the mean.
    Poisson,
    /// Some days are busy and others quiet: a Poisson draw whose mean is a gamma draw. The variance
    /// is mean + dispersion mean^2.
    NegativeBinomial { dispersion: f64 },
    /// A normal draw, raised to 0 where it is negative, then rounded up or down by chance so that
    /// the mean stays.
    Normal {
        /// Standard deviation as a share of the mean.
        noise: f64,
        /// Centre of the normal draw, as a share of the mean. It is below 1 by just as much as
        /// raising negative draws to 0 raises the mean.
        centre: f64,
    },
}

impl Distribution {
    fn normal(noise: f64) -> Self {
        Self::Normal { noise, centre: centre(noise) }
    }

    pub(super) fn draw(self, mean: f64, random: &mut ChaCha8Rng) -> u32 {
        match self {
            Self::Poisson => draws::poisson(mean, random),
            Self::NegativeBinomial { dispersion } => {
                let factor = dispersion * draws::gamma(1.0 / dispersion, random);
                // `poisson` returns at most `MOST_PASSENGERS`, so this limit on its mean changes no
                // draw.
                draws::poisson((mean * factor).min(10.0 * limits::MOST_PASSENGERS), random)
            }
            Self::Normal { noise, centre } => {
                let drawn = mean * (centre + noise * draws::normal(random));
                rounded_by_chance(drawn, random)
            }
        }
    }
}

/// The c that solves E[max(0, N(c, noise))] = c Φ(c / noise) + noise φ(c / noise) = 1.
fn centre(noise: f64) -> f64 {
    let mean = |c: f64| {
        let z = c / noise;
        let below = libm::erfc(z / std::f64::consts::SQRT_2) / 2.0;
        let density = libm::exp(-z * z / 2.0) / std::f64::consts::TAU.sqrt();
        c * (1.0 - below) + noise * density
    };
    if noise == 0.0 || mean(1.0) <= 1.0 {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    // After 60 halvings there is no number between `low` and `high`.
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if mean(middle) < 1.0 { low = middle } else { high = middle }
    }
    high
}

/// The name of a distribution in a network file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Name {
    Poisson,
    NegativeBinomial,
    Normal,
}

impl Name {
    fn text(self) -> &'static str {
        match self {
            Self::Poisson => "poisson",
            Self::NegativeBinomial => "negative-binomial",
            Self::Normal => "normal",
        }
    }
}

/// The members of a demand model that choose its distribution.
pub(super) struct RawDistribution {
    pub(super) name: Option<Name>,
    pub(super) noise: Option<f64>,
    pub(super) dispersion: Option<f64>,
}

impl RawDistribution {
    /// Checks the members of `model` and returns the distribution that they choose. If none is
    /// named, `noise` means the normal one, as it did before distributions had names, and no
    /// `noise` means the Poisson one.
    pub(super) fn check(self, model: &str) -> Result<Distribution, FormatError> {
        let unnamed = if self.noise.is_some() { Name::Normal } else { Name::Poisson };
        let name = self.name.unwrap_or(unnamed);
        let unfit = |member: &str, rule: &'static str| FormatError::UnfitSetting {
            member: format!("{model}: {member}"),
            rule,
            distribution: name.text(),
        };
        let number = |value: f64, limits: &Limits, member: &str| {
            limits.check(value, || format!("{model}: {member}"))
        };
        match (name, self.noise, self.dispersion) {
            (Name::Poisson, None, None) => Ok(Distribution::Poisson),
            (Name::NegativeBinomial, None, Some(dispersion)) => {
                number(dispersion, &limits::DISPERSION, "dispersion")?;
                Ok(Distribution::NegativeBinomial { dispersion })
            }
            (Name::Normal, Some(noise), None) => {
                number(noise, &limits::NOISE, "noise")?;
                Ok(Distribution::normal(noise))
            }
            (Name::Normal, None, _) => Err(unfit("noise", "must be given")),
            (Name::NegativeBinomial, _, None) => Err(unfit("dispersion", "must be given")),
            (Name::Normal | Name::Poisson, _, Some(_)) => {
                Err(unfit("dispersion", "must not be given"))
            }
            (Name::NegativeBinomial | Name::Poisson, Some(_), _) => {
                Err(unfit("noise", "must not be given"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::centre;

    /// Integrates by the trapezium rule, which is independent of the closed form that `centre`
    /// solves.
    #[test]
    fn what_is_cut_off_at_zero_does_not_raise_the_mean() {
        for noise in [0.01, 0.1, 0.2, 0.3, 0.35, 0.4] {
            let centre = centre(noise);
            let steps = 400_000;
            let width = 20.0 / f64::from(steps);
            let mean: f64 = (0..=steps)
                .map(|step| {
                    let z = -10.0 + width * f64::from(step);
                    let density = (-z * z / 2.0).exp() / std::f64::consts::TAU.sqrt();
                    (centre + noise * z).max(0.0) * density * width
                })
                .sum();
            assert!((mean - 1.0).abs() < 1e-9, "noise {noise}: centre {centre}, mean {mean}");
            assert!(centre <= 1.0 && centre > 0.99);
        }
        assert_eq!(centre(0.0), 1.0);
    }
}
