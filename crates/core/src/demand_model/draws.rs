//! Draws of whole passengers whose mean is exactly the given one, even where demand is thin.
//!
//! They are written out with the functions of `libm`. Apart from the standard normal, the
//! distributions of `rand_distr` take logarithms from the system's library as soon as any crate of
//! a build asks for that, and these logarithms differ between machines.

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::limits::MOST_PASSENGERS;
use crate::random::uniform;

/// From this mean on, Poisson draws are made by rejection; below it, by counting.
const MANY: f64 = 10.0;

/// A standard normal draw.
pub(super) fn normal(random: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(random)
}

/// Draws from the Poisson distribution; at most `MOST_PASSENGERS`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative, and bounded"
)]
pub(super) fn poisson(mean: f64, random: &mut ChaCha8Rng) -> u32 {
    // A mean that is not a number draws 0: the rejection would never end.
    let drawn = if mean >= MANY { by_rejection(mean, random) } else { counted(mean, random) };
    drawn.min(MOST_PASSENGERS) as u32
}

/// Counts arrivals until their exponential times pass the mean (Knuth), as a product of uniform
/// draws.
fn counted(mean: f64, random: &mut ChaCha8Rng) -> f64 {
    let enough = libm::exp(-mean);
    let mut product = uniform(random);
    let mut arrivals = 0.0;
    while product > enough {
        product *= uniform(random);
        arrivals += 1.0;
    }
    arrivals
}

/// Transformed rejection for means of 10 and more. Constants and names are those of Hörmann, "The
/// transformed rejection method for generating Poisson random variables", 1993, algorithm PTRS.
#[expect(clippy::many_single_char_names, reason = "the names of the paper")]
fn by_rejection(mean: f64, random: &mut ChaCha8Rng) -> f64 {
    let b = 0.931 + 2.53 * mean.sqrt();
    let a = -0.059 + 0.024_83 * b;
    let inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
    let squeeze = 0.9277 - 3.6224 / (b - 2.0);
    loop {
        let u = uniform(random) - 0.5;
        let v = uniform(random);
        let us = 0.5 - u.abs();
        let k = ((2.0 * a / us + b) * u + mean + 0.43).floor();
        if us >= 0.07 && v <= squeeze {
            return k;
        }
        if k < 0.0 || (us < 0.013 && v > us) {
            continue;
        }
        let height = libm::log(v * inverse_alpha / (a / (us * us) + b));
        if height <= k * libm::log(mean) - mean - libm::lgamma(k + 1.0) {
            return k;
        }
    }
}

/// Draws from the gamma distribution of this shape and scale 1 (Marsaglia and Tsang, "A simple
/// method for generating gamma variables", 2000; shapes below 1 by their boost).
#[expect(clippy::many_single_char_names, reason = "the names of the paper")]
pub(super) fn gamma(shape: f64, random: &mut ChaCha8Rng) -> f64 {
    if shape < 1.0 {
        // The chance must not be 0, whose logarithm is infinite.
        let chance = 1.0 - uniform(random);
        return gamma(shape + 1.0, random) * libm::exp(libm::log(chance) / shape);
    }
    let d = shape - 1.0 / 3.0;
    let c = 1.0 / (9.0 * d).sqrt();
    loop {
        let x = normal(random);
        let v = 1.0 + c * x;
        if v <= 0.0 {
            continue;
        }
        let v = v * v * v;
        let u = 1.0 - uniform(random);
        if libm::log(u) < 0.5 * x * x + d * (1.0 - v + libm::log(v)) {
            return d * v;
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::{gamma, poisson};
    use crate::random::rounded_by_chance;

    const DRAWS: u32 = 200_000;

    /// Mean and variance of many draws.
    fn moments(mut draw: impl FnMut(&mut ChaCha8Rng) -> f64) -> (f64, f64) {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let drawn: Vec<f64> = (0..DRAWS).map(|_| draw(&mut random)).collect();
        let mean = drawn.iter().sum::<f64>() / f64::from(DRAWS);
        let spread = drawn.iter().map(|one| (one - mean).powi(2)).sum::<f64>();
        (mean, spread / f64::from(DRAWS - 1))
    }

    /// Four standard errors of a mean over `DRAWS` draws.
    fn allowed(variance: f64) -> f64 {
        4.0 * (variance / f64::from(DRAWS)).sqrt()
    }

    #[test]
    fn a_mean_that_is_not_a_number_draws_nothing() {
        assert_eq!(poisson(f64::NAN, &mut ChaCha8Rng::seed_from_u64(1)), 0);
    }

    #[test]
    fn poisson_draws_have_mean_and_variance_of_their_mean() {
        for asked in [1e-300, 0.05, 0.3, 1.0, 7.0, 9.99, 10.0, 25.0, 400.0, 1e5] {
            let (mean, variance) = moments(|random| f64::from(poisson(asked, random)));
            assert!((mean - asked).abs() <= allowed(asked), "{asked}: mean {mean}");
            // The variance of a sample's variance: (fourth central moment - variance^2) / draws =
            // (asked + 2 asked^2) / draws.
            let error = 4.0 * ((asked + 2.0 * asked * asked) / f64::from(DRAWS)).sqrt();
            assert!((variance - asked).abs() <= error, "{asked}: variance {variance}");
        }
        let (mean, _) = moments(|random| f64::from(poisson(0.0, random)));
        assert_eq!(mean, 0.0);
    }

    /// Checks the chance of each count, and not only mean and variance, on both sides of the change
    /// of method.
    #[test]
    fn poisson_counts_come_as_often_as_they_should() {
        for asked in [3.0, 12.0_f64] {
            let mut random = ChaCha8Rng::seed_from_u64(2);
            let mut times = [0.0; 40];
            for _ in 0..DRAWS {
                times[poisson(asked, &mut random) as usize] += 1.0;
            }
            let mut share = (-asked).exp();
            for (count, &times) in times.iter().enumerate() {
                let expected = share * f64::from(DRAWS);
                assert!(
                    (times - expected).abs() <= 5.0 * expected.sqrt() + 1.0,
                    "{asked}: {count} came {times} times, not {expected}"
                );
                share *= asked / (count + 1) as f64;
            }
        }
    }

    #[test]
    fn gamma_draws_have_mean_and_variance_of_their_shape() {
        for shape in [0.1, 0.5, 1.0, 2.5, 40.0, 1e6] {
            let (mean, variance) = moments(|random| gamma(shape, random));
            assert!((mean - shape).abs() <= allowed(shape), "{shape}: mean {mean}");
            // The fourth central moment is 3 shape^2 + 6 shape.
            let error = 4.0 * ((2.0 * shape * shape + 6.0 * shape) / f64::from(DRAWS)).sqrt();
            assert!((variance - shape).abs() <= error, "{shape}: variance {variance}");
        }
    }

    #[test]
    fn rounding_by_chance_keeps_the_mean_and_goes_no_further_than_a_neighbour() {
        for asked in [0.0, 0.05, 0.5, 3.0, 7.9] {
            let mut low = u32::MAX;
            let mut high = 0;
            let (mean, _) = moments(|random| {
                let drawn = rounded_by_chance(asked, random);
                (low, high) = (low.min(drawn), high.max(drawn));
                f64::from(drawn)
            });
            assert!((mean - asked).abs() <= allowed(0.25), "{asked}: mean {mean}");
            assert!(f64::from(low) >= asked.floor() && f64::from(high) <= asked.ceil());
        }
    }
}
