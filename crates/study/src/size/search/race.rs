//! Races: designs meet few days first, and the better half goes on to more.
//!
//! The first race is between designs that the ceiling's prices are best for if a policy earns only
//! a share of what the best schedule earns, and needs more free stands than it. Later races are
//! between steps from the best design so far, up and down in every dimension, from large steps to
//! single ones. Steps that seem to gain are also tried together.

use super::{Design, Search, Solver, rounded, steps_from};
use crate::error::Error;

/// Shares of the bound's worth that a policy may have.
const SHARES: [f64; 4] = [1.0, 0.85, 0.7, 0.5];
/// Shares of the stands that aircraft may fill.
const FILLED: [f64; 3] = [1.0, 0.8, 0.6];

impl<S: Solver> Search<'_, S> {
    /// Races until no step from the best design wins, or no days are left.
    pub(super) fn race_to_the_best(&mut self, first: &Design) -> Result<(), Error> {
        let left = self.days_left();
        self.race(self.by_prices(first), left)?;
        let widest = self.space.dimensions.iter().map(|one| one.steps).max().unwrap_or(0);
        let mut reach = (widest / 4).max(1);
        while self.days_left() > 0 {
            let best = self.best().clone();
            self.race_around(reach, self.days_left())?;
            if *self.best() == best {
                if reach == 1 {
                    break;
                }
                reach /= 2;
            }
        }
        Ok(())
    }

    /// The best designs by the ceiling's prices, if a policy has a share of their worth.
    fn by_prices(&self, first: &Design) -> Vec<Design> {
        let center = self.space.above(first);
        let mut found = Vec::new();
        for filled in FILLED {
            for share in SHARES {
                let ceiling =
                    self.ceiling.discounted(share, &self.prices(), self.space.room(filled));
                if let Some(above) = ceiling.highest(&center) {
                    found.push(self.nearest(&rounded(&above)));
                }
            }
        }
        found
    }

    /// Cost of one more thing by dimension; 0 if the value does not count costs.
    fn prices(&self) -> Vec<f64> {
        let counts = self.aim.goal == crate::size::Goal::MostProfit;
        self.aim.costs.iter().map(|cost| if counts { *cost } else { 0.0 }).collect()
    }

    /// Lets the steps from the best design race, and with them several steps together; simulates at
    /// most this many days.
    pub(super) fn race_around(&mut self, reach: u32, most_days: usize) -> Result<(), Error> {
        let best = self.best().clone();
        let ends_at = self.simulated_days.saturating_add(most_days);
        let mut steps = self.steps(&best, reach);
        // The most promising by the ceiling, if not all can be tried.
        steps.sort_by(|one, other| {
            self.predicted(&best, other).total_cmp(&self.predicted(&best, one))
        });
        steps.truncate(most_days);
        self.play_first_days(&steps, 1)?;
        let together = self.together(&best, &steps);
        self.race([steps, together].concat(), ends_at.saturating_sub(self.simulated_days))
    }

    /// The designs a step away in one dimension, or with as many aircraft of another type instead.
    fn steps(&self, design: &Design, reach: u32) -> Vec<Design> {
        let mut steps = steps_from(self.space, design, reach);
        let dimensions = &self.space.dimensions;
        let fleets = (0..dimensions.len()).filter(|&at| dimensions[at].is_aircraft());
        for less in fleets.clone() {
            for more in fleets.clone().filter(|&more| more != less) {
                let mut swapped = design.clone();
                let moved = reach.min(design[less]).min(dimensions[more].steps - design[more]);
                swapped[less] -= moved;
                swapped[more] += moved;
                if moved > 0 && self.space.is_possible(&swapped) {
                    steps.push(swapped);
                }
            }
        }
        steps
    }

    /// The steps that gained on the first day, taken together: the best two, four, and so on.
    fn together(&self, best: &Design, steps: &[Design]) -> Vec<Design> {
        let gain = |one: &Design| self.values[one][0] - self.values[best][0];
        let mut gaining: Vec<&Design> = steps.iter().filter(|one| gain(one) > 0.0).collect();
        gaining.sort_by(|one, other| gain(other).total_cmp(&gain(one)));
        let (mut joined, mut found, mut joins) = (best.clone(), Vec::new(), 0_usize);
        for step in gaining {
            // A dimension goes the way that gained more.
            let is_moved = |at: usize| step[at] != best[at];
            if (0..best.len()).any(|at| is_moved(at) && joined[at] != best[at]) {
                continue;
            }
            for at in (0..best.len()).filter(|&at| is_moved(at)) {
                joined[at] = step[at];
            }
            joins += 1;
            if joins > 1 && joins.is_power_of_two() && self.space.is_possible(&joined) {
                found.push(joined.clone());
            }
        }
        if joins > 2 && !joins.is_power_of_two() && self.space.is_possible(&joined) {
            found.push(joined);
        }
        found
    }

    /// Plays designs on the first day, and the better half of them on twice as many, until some
    /// have met all days. A design that is not better than the best on the days so far is out.
    /// Simulates at most this many days.
    fn race(&mut self, mut entrants: Vec<Design>, most_days: usize) -> Result<(), Error> {
        let (all, ends_at) = (self.solver.days(), self.simulated_days.saturating_add(most_days));
        let mut days = 1;
        loop {
            let mut left = ends_at.saturating_sub(self.simulated_days);
            entrants.retain(|one| {
                let more = days - self.known_days(one).min(days);
                let can_play = more <= left;
                left -= if can_play { more } else { 0 };
                can_play
            });
            if entrants.is_empty() {
                return Ok(());
            }
            self.play_first_days(&entrants, days)?;
            if days == all {
                return Ok(());
            }
            let sum = |one: &Design| self.values[one][..days].iter().sum::<f64>();
            entrants.sort_by(|one, other| sum(other).total_cmp(&sum(one)).then(one.cmp(other)));
            entrants.dedup();
            entrants.truncate(entrants.len().div_ceil(2));
            let best = self.best();
            entrants.retain(|one| sum(one) > sum(best));
            days = if entrants.len() == 1 { all } else { (2 * days).min(all) };
        }
    }
}
