//! The search for the cheapest design that carries enough passengers.
//!
//! Of the designs that were played, one that carries too few and one that carries enough are the
//! ends of an *edge*: what enough costs between the two is least. The edge's slope is what one more
//! passenger costs here, at which all designs can be compared, those that carry too few too.
//! Designs on the edge and around its ends are played.

use super::{Design, IN_VAIN, MOST_BOUNDS, Search, Solver, Space, prediction_margin, rounded};
use crate::error::Error;
use crate::size::ceiling::Ceiling;

/// A policy falls far short of the ceiling if it lacks this share of the passengers who must be
/// carried.
const FAR_SHORT: f64 = 0.1;
/// A design on an edge is worth playing if it is cheaper than the best by this share.
const WORTH_CLOSING_IN: f64 = 0.01;

/// Two designs between which enough is carried at the least cost, if the number of passengers rises
/// evenly in between.
struct Edge {
    /// The design that carries too few.
    lacking: Design,
    /// The design that carries enough.
    enough: Design,
    /// What enough costs.
    cost: f64,
    /// How far from the first to the second that is.
    share: f64,
    /// What one more passenger costs.
    cost_of_one: f64,
}

impl<S: Solver> Search<'_, S> {
    /// Plays the cheapest designs by the ceiling, each time aiming higher by what the last one
    /// lacked. Where a policy falls far short of the ceiling, that leads to odd designs. Then the
    /// largest is played, or the smallest if all carry enough.
    pub(super) fn play_until_enough(&mut self, first: Design) -> Result<(), Error> {
        let (mut design, mut wanted) = (first, self.aim.need);
        while self.order.len() < self.budget {
            self.play(&design)?;
            let lacks = self.aim.need - self.played[&design];
            if lacks <= 0.0 || lacks > FAR_SHORT * self.aim.need {
                break;
            }
            wanted += lacks.max(1e-3 * self.aim.need);
            let next = self.cheapest(&self.ceiling, self.space, wanted);
            if self.played.contains_key(&next) || self.ceiling_at(&next) < wanted {
                break;
            }
            self.bound(&self.space.above(&next))?;
            design = next;
        }
        let is_enough = |one| self.is_enough(one);
        let end = if !self.order.iter().any(is_enough) {
            self.space.largest()
        } else if self.order.iter().all(is_enough) {
            vec![0; self.space.dimensions.len()]
        } else {
            return Ok(());
        };
        if self.order.len() < self.budget {
            self.play(&self.possible(self.space, end))?;
        }
        Ok(())
    }

    /// Plays designs on the edge and around its ends, from large steps to single ones.
    pub(super) fn play_along_the_edge(&mut self) -> Result<(), Error> {
        let both_ways = 2 * self.space.dimensions.len();
        let widest = self.space.dimensions.iter().map(|one| one.steps).max().unwrap_or(0);
        let mut reach = (widest / 8).max(1);
        while reach > 0 {
            let most_in_vain = if reach == 1 { 2 * both_ways } else { IN_VAIN / 2 };
            let (mut in_vain, mut may_leap) = (0, true);
            while in_vain < most_in_vain && self.order.len() < self.budget {
                let Some(edge) = self.edge() else { return Ok(()) };
                let leap = self.leap_down().filter(|_| may_leap);
                may_leap = leap.is_some();
                let far = self.on(&edge).or(leap).map(|one| (self.best().clone(), one));
                let next = far.or_else(|| self.cheaper(&edge, reach));
                let Some((from, next)) = next else { break };
                self.play(&next)?;
                self.correct(&from, &next);
                let is_better = self.edge().is_none_or(|new| new.cost < edge.cost);
                in_vain = if is_better { 0 } else { in_vain + 1 };
                may_leap &= is_better;
            }
            reach /= 2;
        }
        Ok(())
    }

    /// The edge on which enough costs least, if designs on both sides of enough were played.
    fn edge(&self) -> Option<Edge> {
        let (enough, lacking): (Vec<&Design>, Vec<&Design>) =
            self.order.iter().partition(|one| self.is_enough(one));
        let between = |lacking: &Design, enough: &Design| {
            let passengers = self.played[enough] - self.played[lacking];
            let share = (self.aim.need - self.played[lacking]) / passengers;
            let cost_of_one = (self.cost(enough) - self.cost(lacking)) / passengers;
            let cost = self.cost(lacking) + share * (self.cost(enough) - self.cost(lacking));
            Edge { lacking: lacking.clone(), enough: enough.clone(), cost, share, cost_of_one }
        };
        let edges = lacking.iter().flat_map(|from| enough.iter().map(move |to| between(from, to)));
        edges
            .filter(|edge| edge.cost_of_one > 0.0)
            .min_by(|one, other| one.cost.total_cmp(&other.cost))
    }

    /// The design on an edge that carries enough, if it is new and much cheaper than the best.
    fn on(&self, edge: &Edge) -> Option<Design> {
        let numbers = edge.lacking.iter().zip(&edge.enough).map(|(&from, &to)| {
            let (from, to) = (f64::from(from), f64::from(to));
            from + edge.share * (to - from)
        });
        let found = self.possible(self.space, rounded(&numbers.collect::<Vec<f64>>()));
        let is_cheaper = self.cost(&found) < (1.0 - WORTH_CLOSING_IN) * self.cost(self.best());
        (is_cheaper && !self.played.contains_key(&found)).then_some(found)
    }

    /// The cheapest design of all that is predicted to carry enough, if it is new and cheaper than
    /// the best.
    fn leap_down(&self) -> Option<Design> {
        let found = self.cheapest(&self.expected(self.best()), self.space, self.aim.need);
        let is_cheaper = self.cost(&found) < self.cost(self.best());
        (is_cheaper && !self.played.contains_key(&found)).then_some(found)
    }

    /// The design around the ends of an edge that is predicted to be best, if one is worth playing,
    /// with that end.
    fn cheaper(&self, edge: &Edge, reach: u32) -> Option<(Design, Design)> {
        let saved = |from: &Design, to: &Design| {
            let more = self.predicted(from, to) - self.aim.need;
            edge.cost + edge.cost_of_one * more - self.cost(to)
        };
        let around = |end: &Design| {
            let untried = self.untried(end, reach, |_, _| true);
            untried.map(|one| (saved(end, &one), end.clone(), one)).collect::<Vec<_>>()
        };
        let is_near = self.aim.need - self.played[&edge.lacking] <= FAR_SHORT * self.aim.need;
        let ends = [Some(&edge.enough), Some(&edge.lacking).filter(|_| is_near)];
        ends.into_iter()
            .flatten()
            .flat_map(around)
            .filter(|(saved, from, to)| *saved > -prediction_margin(from, to) * edge.cost)
            .max_by(|one, other| one.0.total_cmp(&other.0))
            .map(|(_, from, to)| (from, to))
    }

    /// Bounds designs until the cheapest one that might carry enough can do so by its own bound,
    /// and returns the cheapest that may be played.
    pub(super) fn bound_the_cheapest(&mut self) -> Result<Design, Error> {
        let mut trial = self.possible(&self.all_numbers, self.space.above(&self.space.start()));
        let mut bounded = Vec::new();
        while bounded.len() < MOST_BOUNDS && !bounded.contains(&trial) {
            self.bound(&trial)?;
            bounded.push(trial);
            trial = self.cheapest(&self.ceiling, &self.all_numbers, self.aim.need);
        }
        Ok(self.cheapest(&self.ceiling, self.space, self.aim.need))
    }

    /// The cheapest possible design of a space at which a ceiling reaches `need`, or the largest
    /// design if none does.
    fn cheapest(&self, ceiling: &Ceiling, space: &Space, need: f64) -> Design {
        let steps = |above: Vec<f64>| -> Vec<f64> {
            above
                .iter()
                .zip(&space.dimensions)
                .map(|(above, one)| above / f64::from(one.step))
                .collect()
        };
        let found = ceiling.cheapest(&self.aim.costs, need);
        let found = found.map_or_else(|| space.largest(), |above| rounded(&steps(above)));
        let mut design = self.possible(space, found);
        // Rounding may have lost some passengers.
        let value = |design: &Design| ceiling.at(&space.above(design));
        while value(&design) < need {
            let gain = |at: usize| {
                let mut more = design.clone();
                more[at] += 1;
                let cost = self.aim.costs[at] * f64::from(space.dimensions[at].step);
                (value(&more) - value(&design)) / cost.max(1e-9)
            };
            let room = (0..design.len()).filter(|&at| design[at] < space.dimensions[at].steps);
            let best = room.max_by(|&one, &other| gain(one).total_cmp(&gain(other)));
            let Some(best) = best else { break };
            design[best] += 1;
        }
        self.possible(space, design)
    }
}
