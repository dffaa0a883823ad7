//! Descriptive statistics and the paired t-test (§V.B), on plain slices.
//!
//! For finite values, no result is NaN or infinite: an undefined result (a standard deviation of
//! one value, the t statistic of differences that do not vary) is `None`.

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// The probability that a confidence interval contains the true mean.
const CONFIDENCE: f64 = 0.95;

/// A difference with a p-value below this is significant (§V.B).
const SIGNIFICANCE: f64 = 0.05;

/// A mean with its standard deviation and confidence interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Estimate {
    /// Arithmetic mean; 0 if there are no values.
    pub mean: f64,
    /// Sample standard deviation (n - 1 in the denominator); `None` with fewer than two values.
    #[serde(deserialize_with = "Option::deserialize")]
    pub standard_deviation: Option<f64>,
    /// Half the width of the 95 % confidence interval of the mean (Student's t); `None` with fewer
    /// than two values.
    #[serde(deserialize_with = "Option::deserialize")]
    pub half_width_95: Option<f64>,
}

impl Estimate {
    /// Mean, standard deviation and 95 % interval of these values.
    pub fn of(values: &[f64]) -> Self {
        let mean = mean(values);
        let standard_deviation = standard_deviation(values);
        let half_width_95 = standard_deviation.map(|deviation| {
            let count = values.len() as f64;
            t_quantile(0.5 + CONFIDENCE / 2.0, count - 1.0) * deviation / count.sqrt()
        });
        Self { mean, standard_deviation, half_width_95 }
    }

    /// The lower and upper end of the 95 % interval, if there is one.
    pub fn interval_95(&self) -> Option<(f64, f64)> {
        self.half_width_95.map(|half| (self.mean - half, self.mean + half))
    }

    /// The mean and the half width of its interval as text, such as `36,597 ± 244`.
    pub fn written(&self, number: impl Fn(f64) -> String) -> String {
        let half = self.half_width_95.map(|half| format!(" ± {}", number(half)));
        number(self.mean) + &half.unwrap_or_default()
    }
}

/// The arithmetic mean; 0 if there are no values.
pub fn mean(values: &[f64]) -> f64 {
    if values.is_empty() { 0.0 } else { values.iter().sum::<f64>() / values.len() as f64 }
}

/// Sample standard deviation, n - 1 in the denominator; `None` with fewer than two values.
pub fn standard_deviation(values: &[f64]) -> Option<f64> {
    let (first, rest) = values.split_first()?;
    if rest.is_empty() {
        return None;
    }
    // The mean of equal values may differ from them by rounding, so a deviation of zero is returned
    // explicitly.
    if rest.iter().all(|value| value.total_cmp(first).is_eq()) {
        return Some(0.0);
    }
    let mean = mean(values);
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    Some((squares / (values.len() as f64 - 1.0)).sqrt())
}

/// What a box plot shows: quartiles, whiskers at most 1.5 interquartile ranges long, and the values
/// beyond them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BoxSummary {
    /// Smallest value that is no outlier.
    pub low_whisker: f64,
    /// First quartile.
    pub first_quartile: f64,
    /// Median.
    pub median: f64,
    /// Third quartile.
    pub third_quartile: f64,
    /// Largest value that is no outlier.
    pub high_whisker: f64,
    /// Values further than 1.5 interquartile ranges from the box, in ascending order.
    pub outliers: Vec<f64>,
}

impl BoxSummary {
    /// The box plot of these values; `None` if there are none.
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let first_quartile = quantile(&sorted, 0.25)?;
        let median = quantile(&sorted, 0.5)?;
        let third_quartile = quantile(&sorted, 0.75)?;
        let reach = 1.5 * (third_quartile - first_quartile);
        let inside =
            |value: f64| value >= first_quartile - reach && value <= third_quartile + reach;
        // With few values, a quartile can lie beyond the last value within reach; a whisker must
        // not end inside the box.
        let low_whisker = sorted.iter().copied().find(|&value| inside(value))?.min(first_quartile);
        let high_whisker =
            sorted.iter().copied().rfind(|&value| inside(value))?.max(third_quartile);
        let outliers = sorted.into_iter().filter(|&value| !inside(value)).collect();
        Some(Self { low_whisker, first_quartile, median, third_quartile, high_whisker, outliers })
    }
}

/// Quantile by linear interpolation between order statistics (type 7 of Hyndman and Fan, as in
/// `NumPy` and R).
pub(crate) fn quantile(sorted: &[f64], probability: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let position = probability * last as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 <= position <= last"
    )]
    let below = position.floor() as usize;
    let above = (below + 1).min(last);
    Some(sorted[below] + (position - position.floor()) * (sorted[above] - sorted[below]))
}

/// Corrects the p-values of several tests so that the chance of any false finding among them stays
/// what it is for one (S. Holm, *A Simple Sequentially Rejective Multiple Test Procedure*,
/// Scandinavian Journal of Statistics 6, 1979). Tests without a p-value do not count.
pub fn holm(p_values: &[Option<f64>]) -> Vec<Option<f64>> {
    let mut ranked: Vec<(usize, f64)> =
        p_values.iter().enumerate().filter_map(|(at, p)| Some((at, (*p)?))).collect();
    ranked.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (tests, mut highest) = (ranked.len(), 0.0_f64);
    let mut corrected = vec![None; p_values.len()];
    for (rank, (at, p)) in ranked.into_iter().enumerate() {
        // A corrected value is never below that of a smaller p-value.
        highest = highest.max((p * (tests - rank) as f64).min(1.0));
        corrected[at] = Some(highest);
    }
    corrected
}

/// Student's t-test on the differences of paired values: is their mean zero?
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PairedTest {
    /// Mean of the differences first - second, with its spread and interval.
    pub difference: Estimate,
    /// Pairs in which the first is strictly larger.
    pub first_larger: usize,
    /// Pairs in which the second is strictly larger.
    pub second_larger: usize,
    /// The t statistic; `None` if the differences do not vary or there are fewer than two.
    pub t: Option<f64>,
    /// Degrees of freedom, n - 1.
    pub degrees_of_freedom: usize,
    /// Two-sided p-value; `None` with fewer than two pairs. If the differences do not vary it is
    /// the limit: 1 if all are zero, else 0.
    pub p_value: Option<f64>,
}

impl PairedTest {
    /// Tests first against second, pair by pair.
    ///
    /// # Panics
    /// Panics if the two slices differ in length, because then the values are not paired.
    pub fn of(first: &[f64], second: &[f64]) -> Self {
        assert_eq!(first.len(), second.len(), "paired values come in pairs");
        let differences: Vec<f64> = first.iter().zip(second).map(|(a, b)| a - b).collect();
        let difference = Estimate::of(&differences);
        let degrees_of_freedom = differences.len().saturating_sub(1);
        let (t, p_value) = match difference.standard_deviation {
            None => (None, None),
            Some(0.0) if difference.mean == 0.0 => (None, Some(1.0)),
            Some(0.0) => (None, Some(0.0)),
            Some(deviation) => {
                let t = difference.mean / (deviation / (differences.len() as f64).sqrt());
                (Some(t), Some(two_sided_p(t, degrees_of_freedom as f64)))
            }
        };
        Self {
            difference,
            first_larger: differences.iter().filter(|&&d| d > 0.0).count(),
            second_larger: differences.iter().filter(|&&d| d < 0.0).count(),
            t,
            degrees_of_freedom,
            p_value,
        }
    }

    /// Whether the null hypothesis, that the mean difference is zero, is rejected at the 5 % level.
    pub fn is_significant(&self) -> bool {
        self.p_value.is_some_and(|p| p < SIGNIFICANCE)
    }
}

fn two_sided_p(t: f64, degrees_of_freedom: f64) -> f64 {
    // This takes the upper tail itself, not one minus the lower part, so that small p-values keep
    // their digits.
    (2.0 * students_t(degrees_of_freedom).sf(t.abs())).min(1.0)
}

fn t_quantile(probability: f64, degrees_of_freedom: f64) -> f64 {
    students_t(degrees_of_freedom).inverse_cdf(probability)
}

fn students_t(degrees_of_freedom: f64) -> StudentsT {
    StudentsT::new(0.0, 1.0, degrees_of_freedom)
        .expect("at least two values, so at least one degree of freedom")
}

#[cfg(test)]
#[path = "statistics_tests.rs"]
mod tests;
