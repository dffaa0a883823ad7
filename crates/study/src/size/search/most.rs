//! The search for the design of the highest value: of the highest profit, or of the most
//! passengers.

use std::collections::BTreeMap;

use super::{Design, IN_VAIN, MOST_BOUNDS, Search, Solver, prediction_margin, rounded};
use crate::error::Error;

/// The ceiling is tight enough if it is higher than a bound by this share.
const TIGHT: f64 = 0.005;

impl<S: Solver> Search<'_, S> {
    /// Bounds designs until the ceiling is hardly higher than the highest bound, and returns the
    /// design nearest to that.
    pub(super) fn bound_the_highest(&mut self) -> Result<Design, Error> {
        let mut bounded: BTreeMap<Design, f64> = BTreeMap::new();
        let mut trial = self.possible(&self.all_numbers, self.space.above(&self.space.start()));
        let mut center = trial.clone();
        while bounded.len() < MOST_BOUNDS {
            let value = self.bound(&trial)?;
            bounded.insert(trial.clone(), value);
            if value >= bounded[&center] {
                center = trial;
            }
            let (least, most) = (bounded[&center], self.ceiling.most());
            if most - least <= TIGHT * most.abs() {
                break;
            }
            // Half of the way up is a design that is not too far away; if it is known, look farther
            // up.
            let levels = [0.5, 0.8, 0.95].map(|share| least + share * (most - least));
            let trials = levels.iter().filter_map(|&level| self.ceiling.toward(&center, level));
            let trials = trials.map(|trial| self.possible(&self.all_numbers, rounded(&trial)));
            let Some(next) = trials.into_iter().find(|one| !bounded.contains_key(one)) else {
                break;
            };
            trial = next;
        }
        Ok(self.nearest(&center))
    }

    /// Plays designs around the best so far, from large steps to single ones.
    pub(super) fn play_around(&mut self) -> Result<(), Error> {
        let widest = self.space.dimensions.iter().map(|one| one.steps).max().unwrap_or(0);
        let mut reach = (widest / 4).max(1);
        while reach > 0 {
            let both_ways = 2 * self.space.dimensions.len();
            let most_in_vain = if reach == 1 { both_ways.max(IN_VAIN) } else { IN_VAIN };
            let mut in_vain = 0;
            while in_vain < most_in_vain && self.order.len() < self.budget {
                let best = self.best().clone();
                let next = self.leap(&best).or_else(|| self.most_promising(&best, reach));
                let Some(next) = next else { break };
                self.play(&next)?;
                self.correct(&best, &next);
                in_vain = if *self.best() == best { in_vain + 1 } else { 0 };
            }
            reach /= 2;
        }
        Ok(())
    }

    /// The design that is predicted to be best of all, if it is new and predicted to be better than
    /// the best so far.
    fn leap(&self, best: &Design) -> Option<Design> {
        let here = self.space.above(best);
        let expected = self.expected(best);
        let found = self.nearest(&rounded(&expected.highest(&here)?));
        let is_higher = expected.at(&self.space.above(&found)) > self.played[best];
        (is_higher && !self.played.contains_key(&found)).then_some(found)
    }

    /// The design around another that is predicted to be best, if one is worth playing.
    fn most_promising(&self, best: &Design, reach: u32) -> Option<Design> {
        let value = self.played[best];
        // One gives what the other takes, or an aircraft comes or leaves with its place.
        let untried = self.untried(best, reach, |alike, same_way| alike != same_way);
        let predicted = untried.map(|one| (self.predicted(best, &one), one));
        predicted
            .filter(|(predicted, one)| {
                *predicted > value - prediction_margin(best, one) * value.abs()
            })
            .max_by(|one, other| one.0.total_cmp(&other.0))
            .map(|(_, one)| one)
    }
}
