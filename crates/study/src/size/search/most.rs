//! The search for the design of the highest value: of the highest profit, or of the most
//! passengers.

use std::collections::BTreeMap;

use super::{Design, MOST_BOUNDS, Search, Solver, rounded};
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
}
