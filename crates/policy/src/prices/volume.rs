//! The search for good prices, step by step: the volume algorithm.
//!
//! F. Barahona and R. Anbil, *The volume algorithm: producing primal solutions with a subgradient
//! method*, Mathematical Programming 87, 2000. A price rises where more is asked for than is
//! available, and falls elsewhere. All aircraft of a vertiport ask for the same, so a single pass
//! exaggerates the excess; its running mean over the passes is used instead.

use super::relaxation::Relaxation;

/// Weight of the latest pass in the running mean.
const MEAN_WEIGHT: f64 = 0.1;
/// Distance of the aim of the prices below the lowest value so far, as a share of it.
const AIM: f64 = 0.05;
/// Number of passes without a lower value after which steps get shorter, and the factor by which
/// they do.
const STALLED_PASSES: u32 = 20;
const SHORTER: f64 = 0.7;
/// The least number of passes, in which prices settle on large days too.
const LEAST_PASSES: usize = 10;

/// The effort of a search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    /// Number of passes, unless the day is so large that they would look at more than `hops` hops.
    pub(super) passes: usize,
    /// Number of hops that all passes together may look at.
    pub(super) hops: usize,
    /// Length of the first step; 1 would reach the aim if the excess stayed the same.
    pub(super) step: f64,
}

impl Effort {
    fn passes_over(self, relaxation: &Relaxation) -> usize {
        let affordable = self.hops / relaxation.hops_a_pass().max(1);
        self.passes.min(affordable.max(LEAST_PASSES))
    }
}

/// The memory of the search: the best prices so far, and the running mean of the excess.
#[derive(Debug, Clone)]
pub(super) struct Volume {
    stand_usd: Vec<f64>,
    passenger_usd: Vec<f64>,
    stand_mean: Vec<f64>,
    passenger_mean: Vec<f64>,
}

impl Volume {
    pub(super) fn new(relaxation: &Relaxation) -> Self {
        Self {
            stand_usd: relaxation.stand_usd.clone(),
            passenger_usd: relaxation.passenger_usd.clone(),
            stand_mean: vec![0.0; relaxation.stand_usd.len()],
            passenger_mean: vec![0.0; relaxation.passenger_usd.len()],
        }
    }

    /// Searches from the prices of the relaxation, and leaves it at the best prices found. Returns
    /// their value, dollars.
    pub(super) fn search(&mut self, relaxation: &mut Relaxation, effort: Effort) -> f64 {
        let mut lowest_usd = f64::INFINITY;
        let (mut step, mut failures) = (effort.step, 0);
        for pass in 0..effort.passes_over(relaxation) {
            let usd = relaxation.evaluate();
            if usd < lowest_usd {
                lowest_usd = usd;
                failures = 0;
                self.keep(relaxation);
            } else {
                failures += 1;
                if failures == STALLED_PASSES {
                    failures = 0;
                    step *= SHORTER;
                }
            }
            let weight = if pass == 0 { 1.0 } else { MEAN_WEIGHT };
            let square = self.average(relaxation, weight);
            if square == 0.0 {
                break;
            }
            if pass == 0 {
                self.forget_what_rests(relaxation);
            }
            let length = step * (usd - (1.0 - AIM) * lowest_usd).max(0.0) / square;
            self.step(relaxation, length);
        }
        self.restore(relaxation);
        lowest_usd
    }

    /// Keeps the prices of the relaxation, and the values at them.
    fn keep(&mut self, relaxation: &mut Relaxation) {
        let (stand, _) = relaxation.begins();
        self.stand_usd[stand..].copy_from_slice(&relaxation.stand_usd[stand..]);
        for cell in relaxation.wanted.all() {
            self.passenger_usd[cell] = relaxation.passenger_usd[cell];
        }
        relaxation.keep();
    }

    /// Sets the prices of the relaxation to the best ones.
    fn restore(&self, relaxation: &mut Relaxation) {
        let (stand, _) = relaxation.begins();
        relaxation.stand_usd[stand..].copy_from_slice(&self.stand_usd[stand..]);
        for cell in relaxation.wanted.all() {
            relaxation.passenger_usd[cell] = self.passenger_usd[cell];
        }
        relaxation.charge();
    }

    /// Moves the mean of the excess towards that of this pass. Returns the sum of its squares,
    /// without the resources that are free and left over.
    fn average(&mut self, relaxation: &Relaxation, weight: f64) -> f64 {
        let (stand, _) = relaxation.begins();
        let means = self.stand_mean[stand..].iter_mut();
        let excess = relaxation.stand_excess[stand..].iter();
        let stands = means.zip(excess).zip(&self.stand_usd[stand..]);
        let stands_square = stands.fold(0.0, |sum, ((mean, &excess), &price_usd)| {
            sum + average(mean, excess, price_usd, weight)
        });
        for cell in relaxation.wanted.fresh() {
            self.passenger_mean[cell] = -relaxation.seats[cell].of_full_flights;
        }
        let passengers_square = relaxation.wanted.all().fold(0.0, |sum, cell| {
            let excess = relaxation.passenger_excess[cell];
            let mean = &mut self.passenger_mean[cell];
            sum + average(mean, excess, self.passenger_usd[cell], weight)
        });
        stands_square + passengers_square
    }

    /// Takes the passengers off the list whose price is zero and the mean of whose excess is minus
    /// the seats of their full flights. As long as no aircraft asks for them, further passes would
    /// not change either.
    fn forget_what_rests(&self, relaxation: &mut Relaxation) {
        let (seats, price_usd) = (&relaxation.seats, &relaxation.passenger_usd);
        relaxation.wanted.retain(|cell| {
            let rests = self.passenger_mean[cell] == -seats[cell].of_full_flights
                && self.passenger_usd[cell] == 0.0
                && price_usd[cell] == 0.0;
            !rests
        });
    }

    /// Sets the prices of the relaxation to a step from the best ones.
    fn step(&self, relaxation: &mut Relaxation, length: f64) {
        let (stand, _) = relaxation.begins();
        let stands = relaxation.stand_usd[stand..].iter_mut();
        let kept = self.stand_usd[stand..].iter().zip(&self.stand_mean[stand..]);
        for (price_usd, (&from_usd, &mean)) in stands.zip(kept) {
            *price_usd = step(from_usd, mean, length);
        }
        for cell in relaxation.wanted.all() {
            relaxation.passenger_usd[cell] =
                step(self.passenger_usd[cell], self.passenger_mean[cell], length);
        }
    }
}

/// Moves the mean of a resource's excess towards that of a pass. Returns its square, or zero if the
/// resource is free and left over.
#[inline]
fn average(mean: &mut f64, excess: f64, price_usd: f64, weight: f64) -> f64 {
    *mean += weight * (excess - *mean);
    if *mean > 0.0 || price_usd > 0.0 { *mean * *mean } else { 0.0 }
}

/// The price of a resource after a step.
#[inline]
fn step(from_usd: f64, mean: f64, length: f64) -> f64 {
    (from_usd + length * mean).max(0.0)
}
