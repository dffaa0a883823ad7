//! Scales, which map values to pixels and have round values as ticks.

/// A range of values laid over a range of pixels.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
    step: f64,
}

impl Scale {
    /// A scale on which all `values` fit with a margin, with about `ticks` round values. `low` lies
    /// at pixel `from`.
    ///
    /// If all values are equal, there is room on either side of them; without values the scale goes
    /// from 0 to 1.
    pub fn around(values: impl Iterator<Item = f64>, from: f64, to: f64, ticks: usize) -> Self {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let (low, high) = if low > high { (0.0, 1.0) } else { (low, high) };
        let span = high - low;
        let margin = if span > 0.0 { 0.04 * span } else { low.abs().max(1.0) * 0.05 };
        let (low, high) = (low - margin, high + margin);
        Self { low, high, from, to, step: round_step((high - low) / ticks as f64) }
    }

    /// A scale from 0 at pixel `from` to a little above the largest of `values`, with about `ticks`
    /// round values.
    pub fn from_zero(values: impl Iterator<Item = f64>, from: f64, to: f64, ticks: usize) -> Self {
        let high = 1.04 * values.fold(0.0, f64::max).max(1e-9);
        Self { low: 0.0, high, from, to, step: round_step(high / ticks as f64) }
    }

    /// The lowest value on the scale.
    pub fn lowest(&self) -> f64 {
        self.low
    }

    /// The highest value on the scale.
    pub fn highest(&self) -> f64 {
        self.high
    }

    /// The pixel at which a value lies.
    pub fn pixel(&self, value: f64) -> f64 {
        self.from + (value - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// The round values on the scale, ascending.
    pub fn ticks(&self) -> Vec<f64> {
        let first = (self.low / self.step).ceil();
        let count = ((self.high / self.step).floor() - first).clamp(0.0, 50.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 <= count <= 50"
        )]
        let count = count as u32;
        (0..=count).map(|tick| (first + f64::from(tick)) * self.step).collect()
    }

    /// The number of decimals that distinguishes the ticks when they are written in a unit of this
    /// size.
    pub fn decimals(&self, unit: f64) -> usize {
        let step = self.step / unit;
        (0..9_i32)
            .find(|&decimals| {
                let scaled = step * 10_f64.powi(decimals);
                (scaled - scaled.round()).abs() < 1e-6 * scaled
            })
            .and_then(|decimals| usize::try_from(decimals).ok())
            .unwrap_or(9)
    }
}

/// The next larger 1, 2, 2.5 or 5 times a power of ten.
fn round_step(rough: f64) -> f64 {
    let power = 10_f64.powf(rough.log10().floor());
    let factor = [1.0, 2.0, 2.5, 5.0].into_iter().find(|factor| factor * power >= rough);
    factor.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::Scale;

    #[test]
    fn ticks_are_round_and_inside() {
        let scale = Scale::around([0.0, 97.0].into_iter(), 0.0, 100.0, 5);
        assert_eq!(scale.ticks(), [0.0, 25.0, 50.0, 75.0, 100.0]);
        assert_eq!(scale.decimals(1.0), 0);
        assert_eq!(scale.decimals(1000.0), 3);
    }

    #[test]
    fn values_that_do_not_differ_stand_in_the_middle() {
        for value in [0.0, -3.0, 40_000.0] {
            let scale = Scale::around([value, value].into_iter(), 10.0, 20.0, 5);
            assert!((scale.pixel(value) - 15.0).abs() < 1e-9);
            assert!(!scale.ticks().is_empty());
        }
    }

    #[test]
    fn a_scale_of_no_values_is_still_a_scale() {
        let scale = Scale::around([].into_iter(), 0.0, 100.0, 5);
        assert!(scale.ticks().iter().all(|tick| tick.is_finite()));
    }
}
