//! Intervals of a method over its training runs and over days, by the bootstrap.
//!
//! All runs of a method play the same days, so a sample draws whole runs and whole days, both with
//! replacement: the days within each stratum, and the same days for all runs drawn. This is the
//! two-level interval. rliable's own interval fixes the tasks and draws the runs of each task
//! separately, which suits tasks that are trained separately. Here one set of weights plays all
//! days, and what a seed gains or loses on all of them would average out; so that interval is given
//! only for comparison.
//!
//! Every draw is a function of the sample's number and of nothing else: the same files give the
//! same interval on any number of threads, and a method's interval does not depend on other
//! methods.

use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use serde::Serialize;
use vertifleet_policy::draw;

use crate::statistics::{mean, quantile};

/// Number of samples of an interval.
pub const SAMPLES: u32 = 10_000;
/// Number of samples of the intervals of a performance profile, as in rliable.
pub const PROFILE_SAMPLES: u32 = 2_000;

/// The seeds of the draws of runs, of days, and of a run for each day.
const RUNS: u64 = 1;
const DAYS: u64 = 2;
const RUNS_BY_DAY: u64 = 3;

/// A number and its 95 % interval, the percentiles of the bootstrap.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Interval {
    /// The number itself.
    pub estimate: f64,
    /// The lower and the upper end.
    pub interval_95: (f64, f64),
}

/// The share of the bound of each run on each day.
pub(super) struct Shares {
    /// A row for each run.
    pub(super) runs: Vec<Vec<f64>>,
    /// The number of days of each stratum.
    pub(super) strata: Vec<usize>,
}

/// The statistics of a method.
pub(super) struct Statistics {
    pub(super) mean: Interval,
    pub(super) interquartile_mean: Interval,
    pub(super) interquartile_mean_by_day_95: Option<(f64, f64)>,
    pub(super) lowest: f64,
    pub(super) profile: Vec<Interval>,
}

impl Shares {
    /// Computes all statistics, and the profile at these thresholds.
    pub(super) fn statistics(&self, thresholds: &[f64]) -> Statistics {
        let mut all: Vec<f64> = self.runs.iter().flatten().copied().collect();
        all.sort_by(f64::total_cmp);
        // Only the profiles of the first samples are needed.
        let of_sample = |sample: u32| {
            let thresholds = if sample < PROFILE_SAMPLES { thresholds } else { &[] };
            Measures::of(&self.sample(sample.into()), thresholds)
        };
        let samples: Vec<Measures> = (0..SAMPLES).into_par_iter().map(of_sample).collect();
        let found = Measures::of(&all, thresholds);
        let interval = |estimate, measure: fn(&Measures) -> f64| Interval {
            estimate,
            interval_95: percentiles(samples.iter().map(measure).collect()),
        };
        let point = |(at, &estimate): (usize, &f64)| {
            let of_samples = samples.iter().filter_map(|sample| sample.profile.get(at));
            Interval { estimate, interval_95: percentiles(of_samples.copied().collect()) }
        };
        Statistics {
            mean: interval(found.mean, |sample| sample.mean),
            interquartile_mean: interval(found.interquartile_mean, |sample| {
                sample.interquartile_mean
            }),
            interquartile_mean_by_day_95: (self.runs.len() > 1).then(|| self.by_day_95()),
            lowest: all[0],
            profile: found.profile.iter().enumerate().map(point).collect(),
        }
    }

    /// The shares of a sample, in ascending order: runs with replacement, and for all of them the
    /// same days, drawn with replacement within each stratum.
    fn sample(&self, sample: u64) -> Vec<f64> {
        let mut days = Vec::with_capacity(self.days());
        let mut first = 0;
        for &count in &self.strata {
            for _ in 0..count {
                days.push(first + below(draw(DAYS, sample, number(days.len())), count));
            }
            first += count;
        }
        let runs = (0..self.runs.len())
            .map(|at| &self.runs[below(draw(RUNS, sample, number(at)), self.runs.len())]);
        let mut shares: Vec<f64> =
            runs.flat_map(|run| days.iter().map(move |&day| run[day])).collect();
        shares.sort_unstable_by(f64::total_cmp);
        shares
    }

    /// The interval of the interquartile mean that rliable computes by default.
    fn by_day_95(&self) -> (f64, f64) {
        let of_sample = |sample: u32| {
            let mut shares = Vec::with_capacity(self.days() * self.runs.len());
            for day in 0..self.days() {
                for _ in 0..self.runs.len() {
                    let bits = draw(RUNS_BY_DAY, sample.into(), number(shares.len()));
                    shares.push(self.runs[below(bits, self.runs.len())][day]);
                }
            }
            shares.sort_unstable_by(f64::total_cmp);
            interquartile_mean(&shares)
        };
        percentiles((0..SAMPLES).into_par_iter().map(of_sample).collect())
    }

    fn days(&self) -> usize {
        self.strata.iter().sum()
    }
}

/// What is measured of the shares themselves and of each sample of them.
struct Measures {
    mean: f64,
    interquartile_mean: f64,
    profile: Vec<f64>,
}

impl Measures {
    fn of(sorted: &[f64], thresholds: &[f64]) -> Self {
        Self {
            mean: mean(sorted),
            interquartile_mean: interquartile_mean(sorted),
            profile: thresholds.iter().map(|&threshold| share_above(sorted, threshold)).collect(),
        }
    }
}

/// The mean of sorted values without the lowest and the highest quarter, rounded down to whole
/// values.
fn interquartile_mean(sorted: &[f64]) -> f64 {
    let cut = sorted.len() / 4;
    mean(&sorted[cut..sorted.len() - cut])
}

/// The share of sorted values that are above a threshold.
fn share_above(sorted: &[f64], threshold: f64) -> f64 {
    let below = sorted.partition_point(|&value| value <= threshold);
    (sorted.len() - below) as f64 / sorted.len() as f64
}

/// The percentiles 2.5 and 97.5.
fn percentiles(mut values: Vec<f64>) -> (f64, f64) {
    values.sort_unstable_by(f64::total_cmp);
    let at = |probability| quantile(&values, probability).expect("there are samples");
    (at(0.025), at(0.975))
}

/// A whole number below `count` from 64 random bits.
fn below(bits: u64, count: usize) -> usize {
    let scaled = (u128::from(bits) * count as u128) >> 64;
    usize::try_from(scaled).expect("it is below the count")
}

fn number(at: usize) -> u32 {
    u32::try_from(at).expect("runs and days have fewer than 2^32 shares")
}

#[cfg(test)]
mod tests {
    use super::{Shares, below, interquartile_mean, share_above};

    /// Runs that differ by a whole point on every day, and days that do not differ.
    fn runs_that_differ() -> Shares {
        Shares { runs: vec![vec![0.90; 40], vec![0.91; 40], vec![0.92; 40]], strata: vec![40] }
    }

    #[test]
    fn the_interquartile_mean_leaves_whole_quarters_out() {
        assert_eq!(interquartile_mean(&[1.0, 2.0, 3.0, 4.0, 5.0, 60.0]), 3.5);
        assert_eq!(interquartile_mean(&[1.0, 2.0, 9.0]), 4.0);
    }

    #[test]
    fn a_threshold_is_not_above_itself() {
        assert_eq!(share_above(&[0.5, 0.6, 0.6, 0.7], 0.6), 0.25);
        assert_eq!(share_above(&[0.5, 0.6], 0.4), 1.0);
    }

    #[test]
    fn draws_reach_every_number_and_no_other() {
        assert_eq!((below(0, 3), below(u64::MAX, 3)), (0, 2));
    }

    #[test]
    fn a_difference_between_runs_does_not_average_out_over_days() {
        let statistics = runs_that_differ().statistics(&[0.905]);
        // Each of three draws is the worst run with a chance of 1 in 27, which is more than 2.5 %.
        let (low, high) = statistics.mean.interval_95;
        assert!((low - 0.90).abs() < 1e-9 && (high - 0.92).abs() < 1e-9, "{low} to {high}");
        let by_day = statistics.interquartile_mean_by_day_95.expect("three runs");
        assert!(by_day.0 > 0.905 && by_day.1 < 0.915, "{by_day:?}");
        assert!((statistics.profile[0].estimate - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(statistics.profile[0].interval_95, (0.0, 1.0));
    }

    #[test]
    fn days_are_drawn_within_their_stratum() {
        let days: Vec<f64> = [vec![0.5; 20], vec![0.9; 20]].concat();
        let apart = Shares { runs: vec![days.clone()], strata: vec![20, 20] };
        let together = Shares { runs: vec![days], strata: vec![40] };
        let width = |shares: Shares| {
            let (low, high) = shares.statistics(&[]).mean.interval_95;
            high - low
        };
        assert!(width(apart) < 1e-12);
        assert!(width(together) > 0.1);
    }
}
