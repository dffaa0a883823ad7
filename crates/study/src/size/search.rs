//! The search for the best design.
//!
//! *Bounds first.* Bounds of a few designs make a ceiling (`ceiling.rs`) over all of them. It is
//! made tighter where it is highest, by a level method (C. Lemaréchal, A. Nemirovskii, Y. Nesterov,
//! *New variants of bundle methods*, Mathematical Programming 69, 1995), and says where good
//! designs are.
//!
//! *Then days.* A policy plays the days of single designs. All designs meet the same days, so that
//! few days tell good designs from poor ones: designs *race* in rounds, and the better half of each
//! round goes on to twice as many days (successive halving: Z. Karnin, T. Koren, O. Somekh, *Almost
//! optimal exploration in multi-armed bandits*, ICML 2013). What races depends on the goal:
//! `most.rs` looks for the highest value, `enough.rs` for the least cost of enough.
//!
//! *Then the neighbours.* At last every design one step away from the best in one dimension is
//! played on all days, unless a bound proves that it is not better. If one is better, the search
//! goes on there. So the answer is never below a neighbour on the days of the search.

mod enough;
mod most;
mod race;

use std::collections::BTreeMap;

use super::ceiling::{Ceiling, Cut};
use super::goal::Goal;
use super::space::{Design, DimensionKind, Space};
use crate::error::Error;
use crate::statistics::mean;

/// The most bounds that the ceiling is made of before days are played.
const MOST_BOUNDS: usize = 14;
/// A step in one dimension is worth playing if it is predicted to be worse than the best by no more
/// than this share, because what is predicted of a policy may be wrong by as much. Steps in two
/// dimensions have to be predicted to be better.
const WORTH_PLAYING: f64 = 0.05;
/// Number of designs in a row that may be played in vain before the steps become smaller. With
/// single steps, each dimension may be tried both ways.
const IN_VAIN: usize = 6;
/// How much of what it was wrong by a design that was played corrects.
const CORRECTED: f64 = 0.7;

/// What the search asks about designs.
pub(super) trait Solver {
    /// Bounds what is wanted of all designs, near the truth with this many things above the lowest
    /// numbers.
    fn bound(&mut self, above: &Design) -> Result<Cut, Error>;
    /// The number of days that all designs meet.
    fn days(&self) -> usize;
    /// Plays this many of the first days of some designs. Returns the numbers of each day, design
    /// by design.
    fn play(&mut self, designs: &[Design], days: usize) -> Result<Vec<Vec<DayNumbers>>, Error>;
}

/// The numbers of a day of a design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DayNumbers {
    pub(super) profit_usd: f64,
    /// Passengers carried.
    pub(super) carried: f64,
}

/// What is wanted.
#[derive(Debug, Clone)]
pub(super) struct Aim {
    pub(super) goal: Goal,
    /// Passengers a day who must be carried, for [`Goal::Served`].
    pub(super) need: f64,
    /// What one more thing costs by dimension.
    pub(super) costs: Vec<f64>,
}

impl Aim {
    /// What is bounded and wanted high: profit, or the number of passengers carried.
    fn value(&self, played: DayNumbers) -> f64 {
        if self.goal == Goal::MostProfit { played.profit_usd } else { played.carried }
    }

    /// The cost of this many things above the lowest numbers.
    fn cost(&self, above: &[u32]) -> f64 {
        self.costs.iter().zip(above).map(|(cost, &above)| cost * f64::from(above)).sum()
    }

    pub(super) fn reaches(&self, value: f64) -> bool {
        !matches!(self.goal, Goal::Served(_)) || value >= self.need
    }
}

/// What the search found.
pub(super) struct Found {
    pub(super) best: Design,
    /// Whether the best design reaches what must be carried. If not, it is the one that carries
    /// most.
    pub(super) reaches: bool,
    pub(super) ceiling: Ceiling,
    /// The designs that were played on all days, in this order.
    pub(super) order: Vec<Design>,
    /// Number of designs one step from the best in one dimension; none of them is better.
    pub(super) neighbours: usize,
    /// Number of days that were simulated before the neighbours of the best were compared.
    pub(super) searched_days: usize,
    /// Number of all days that were simulated.
    pub(super) simulated_days: usize,
}

/// Searches for the best design. Before it compares the neighbours of its answer, it simulates at
/// most as many days as `budget` designs have.
///
/// # Errors
/// Returns the errors of the solver.
pub(super) fn search(
    space: &Space,
    aim: &Aim,
    budget: usize,
    solver: &mut impl Solver,
) -> Result<Found, Error> {
    let mut search = Search::new(space, aim, budget, solver);
    let first = match aim.goal {
        Goal::Served(_) => search.bound_the_cheapest()?,
        Goal::MostProfit | Goal::LeastSpill => search.bound_the_highest()?,
    };
    search.play(&search.possible(space, space.start()))?;
    match aim.goal {
        Goal::Served(_) => search.play_until_enough(first.clone())?,
        Goal::MostProfit | Goal::LeastSpill => search.play(&first)?,
    }
    if search.is_enough(search.best()) {
        search.play_along_the_edge()?;
    } else {
        search.race_to_the_best(&first)?;
    }
    let searched_days = search.simulated_days;
    search.compare_neighbours()?;
    let best = search.best().clone();
    search.bound(&space.above(&best))?;
    let reaches = aim.reaches(search.played[&best]);
    let neighbours = steps_from(space, &best, 1).len();
    let Search { ceiling, order, simulated_days, .. } = search;
    Ok(Found { best, reaches, ceiling, order, neighbours, searched_days, simulated_days })
}

struct Search<'a, S> {
    space: &'a Space,
    /// The same designs with all numbers in between, which are bounded but not played.
    all_numbers: Space,
    aim: &'a Aim,
    budget: usize,
    solver: &'a mut S,
    ceiling: Ceiling,
    /// The values of designs on the first days.
    values: BTreeMap<Design, Vec<f64>>,
    simulated_days: usize,
    /// The mean values of the designs that were played on all days.
    played: BTreeMap<Design, f64>,
    order: Vec<Design>,
    /// By how much more a step raises what is played than the ceiling, by dimension.
    corrections: Vec<f64>,
}

impl<'a, S: Solver> Search<'a, S> {
    fn new(space: &'a Space, aim: &'a Aim, budget: usize, solver: &'a mut S) -> Self {
        let all_numbers = space.with_all_numbers();
        let ceiling = Ceiling::new(all_numbers.largest(), space.room(1.0));
        let corrections = vec![0.0; space.dimensions.len()];
        Self {
            space,
            all_numbers,
            aim,
            budget,
            solver,
            ceiling,
            values: BTreeMap::new(),
            simulated_days: 0,
            played: BTreeMap::new(),
            order: Vec::new(),
            corrections,
        }
    }

    /// Adds the bound of a design to the ceiling, and returns its value.
    fn bound(&mut self, above: &Design) -> Result<f64, Error> {
        let cut = self.solver.bound(above)?;
        let value = cut.at(above);
        self.ceiling.add(cut);
        Ok(value)
    }

    /// Corrects the slopes of what two designs that were played differ in.
    fn correct(&mut self, from: &Design, to: &Design) {
        let changes = changes(from, to);
        let wrong = self.played[to] - self.predicted(from, to);
        let size: f64 = changes.iter().map(|change| change * change).sum();
        for (correction, change) in self.corrections.iter_mut().zip(changes) {
            *correction += CORRECTED * wrong * change / size;
        }
    }

    /// The value that a design will be found to have, predicted from one that was played.
    fn predicted(&self, from: &Design, to: &Design) -> f64 {
        let corrections = self.corrections.iter().zip(changes(from, to));
        let corrected: f64 = corrections.map(|(correction, change)| correction * change).sum();
        self.played[from] + self.ceiling_at(to) - self.ceiling_at(from) + corrected
    }

    /// The values that designs will be found to have, predicted from one that was played, as a
    /// ceiling with other slopes.
    fn expected(&self, from: &Design) -> Ceiling {
        let steps = self.space.dimensions.iter().map(|one| f64::from(one.step));
        let corrections = self.corrections.iter().zip(steps);
        let more: Vec<f64> = corrections.map(|(correction, step)| correction / step).collect();
        let here = self.space.above(from);
        let corrected = more.iter().zip(&here).map(|(more, &above)| more * f64::from(above));
        let constant = self.played[from] - self.ceiling.at(&here) - corrected.sum::<f64>();
        self.ceiling.corrected(&more, constant)
    }

    /// The designs around one that may be played and were not, as [`around`] gives them.
    fn untried(
        &self,
        design: &Design,
        reach: u32,
        is_pair: impl Fn(bool, bool) -> bool,
    ) -> impl Iterator<Item = Design> {
        let all = around(self.space, design, reach, is_pair).into_iter();
        all.filter(|one| self.space.is_possible(one) && !self.played.contains_key(one))
    }

    fn ceiling_at(&self, design: &Design) -> f64 {
        self.ceiling.at(&self.space.above(design))
    }

    fn play(&mut self, design: &Design) -> Result<(), Error> {
        self.play_first_days(std::slice::from_ref(design), self.solver.days())
    }

    /// Plays this many of the first days of some designs.
    fn play_first_days(&mut self, designs: &[Design], days: usize) -> Result<(), Error> {
        let is_new = |one: &&Design| self.known_days(one) < days;
        let mut new: Vec<Design> = Vec::new();
        for one in designs.iter().filter(is_new) {
            if !new.contains(one) {
                new.push(one.clone());
            }
        }
        let played = self.solver.play(&new, days)?;
        for (design, played) in new.into_iter().zip(played) {
            self.simulated_days += days - self.known_days(&design);
            let values: Vec<f64> = played.into_iter().map(|day| self.aim.value(day)).collect();
            if days == self.solver.days() {
                self.played.insert(design.clone(), mean(&values));
                self.order.push(design.clone());
            }
            self.values.insert(design, values);
        }
        Ok(())
    }

    fn known_days(&self, design: &Design) -> usize {
        self.values.get(design).map_or(0, Vec::len)
    }

    /// Days that may still be simulated before the neighbours of the best are compared.
    fn days_left(&self) -> usize {
        (self.budget * self.solver.days()).saturating_sub(self.simulated_days)
    }

    /// Plays every neighbour of the best that may be better, and goes on to the best of them, until
    /// none is.
    fn compare_neighbours(&mut self) -> Result<(), Error> {
        loop {
            let best = self.best().clone();
            let all = steps_from(self.space, &best, 1).into_iter();
            let may_be_better: Vec<Design> =
                all.filter(|one| self.may_be_better(one, &best)).collect();
            self.play_first_days(&may_be_better, self.solver.days())?;
            if *self.best() == best {
                return Ok(());
            }
            if !self.is_enough(self.best()) {
                self.race_around(1, usize::MAX)?;
            }
        }
    }

    /// Whether no bound proves that a design is not better than another that was played.
    fn may_be_better(&self, one: &Design, than: &Design) -> bool {
        if self.is_enough(than) {
            return self.cost(one) < self.cost(than) && self.ceiling_at(one) >= self.aim.need;
        }
        self.ceiling_at(one) >= self.played[than] - 1e-9 * self.played[than].abs()
    }

    /// The best design that was played; among equals the cheapest.
    fn best(&self) -> &Design {
        let better = |one: &&Design, other: &&Design| self.rank(one).total_cmp(&self.rank(other));
        let best = self.order.iter().max_by(|one, other| {
            let cost = self.cost(other).total_cmp(&self.cost(one));
            better(one, other).then(cost)
        });
        best.expect("a design was played")
    }

    fn cost(&self, design: &Design) -> f64 {
        self.aim.cost(&self.space.above(design))
    }

    /// How good a design is that was played: its value, or, for [`Goal::Served`], less cost once it
    /// carries enough.
    fn rank(&self, design: &Design) -> f64 {
        if self.is_enough(design) { 1e15 - self.cost(design) } else { self.played[design] }
    }

    /// Whether the goal is a number of passengers and a design carries as many, so that only its
    /// cost matters.
    fn is_enough(&self, design: &Design) -> bool {
        matches!(self.aim.goal, Goal::Served(_)) && self.aim.reaches(self.played[design])
    }

    /// The design that may be played and is nearest to a bounded one.
    fn nearest(&self, above: &Design) -> Design {
        let numbers = above.iter().zip(&self.space.dimensions);
        let nearest = numbers.map(|(&above, one)| one.nearest(one.low + above)).collect();
        self.possible(self.space, nearest)
    }

    /// The design, with stands for its aircraft and with one aircraft at least.
    fn possible(&self, space: &Space, mut design: Design) -> Design {
        let is_aircraft = |at: usize| space.dimensions[at].is_aircraft();
        while !space.is_possible(&design) {
            let none = space.counts(&design).aircraft.iter().sum::<u32>() == 0;
            let fewer = (0..design.len()).filter(|&at| !none && is_aircraft(at) && design[at] > 0);
            let slope = |at: usize| self.ceiling.slope(&space.above(&design), at);
            let least_lost = fewer.min_by(|&one, &other| slope(one).total_cmp(&slope(other)));
            let more = (0..design.len())
                .filter(|&at| none == is_aircraft(at) && design[at] < space.dimensions[at].steps);
            // An aircraft that is on the ground when the day begins needs a stand, whatever
            // chargers there are.
            let more = more
                .min_by_key(|&at| matches!(space.dimensions[at].what, DimensionKind::Chargers(_)));
            match (least_lost, more) {
                (Some(at), _) => design[at] -= 1,
                (None, Some(at)) => design[at] += 1,
                (None, None) => unreachable!("a space has a possible design"),
            }
        }
        design
    }
}

/// By what share the design after a step may be predicted to be worse, and be worth playing.
fn prediction_margin(from: &Design, to: &Design) -> f64 {
    let moved = from.iter().zip(to).filter(|(from, to)| from != to).count();
    if moved == 1 { WORTH_PLAYING } else { 0.0 }
}

/// By how many steps two designs differ, by dimension.
fn changes(from: &Design, to: &Design) -> Vec<f64> {
    from.iter().zip(to).map(|(&from, &to)| f64::from(to) - f64::from(from)).collect()
}

/// The possible designs that differ by `reach` steps in one dimension, or by fewer at its ends.
fn steps_from(space: &Space, design: &Design, reach: u32) -> Vec<Design> {
    let steps = around(space, design, reach, |_, _| false).into_iter();
    steps.filter(|one| space.is_possible(one)).collect()
}

/// Designs that differ by `reach` steps in one dimension, or in two for which `is_pair` says so,
/// from whether both count aircraft or both places, and whether both go the same way.
fn around(
    space: &Space,
    design: &Design,
    reach: u32,
    is_pair: impl Fn(bool, bool) -> bool,
) -> Vec<Design> {
    let moved = |design: &Design, at: usize, up: bool| {
        let mut moved = design.clone();
        let most = space.dimensions[at].steps;
        moved[at] =
            if up { (design[at] + reach).min(most) } else { design[at].saturating_sub(reach) };
        (moved[at] != design[at]).then_some(moved)
    };
    let is_aircraft = |at: usize| space.dimensions[at].is_aircraft();
    let ways = |at: usize| [(at, true), (at, false)];
    let mut found = Vec::new();
    for (at, up) in (0..design.len()).flat_map(ways) {
        let Some(one) = moved(design, at, up) else { continue };
        let others = (0..at).flat_map(ways);
        let pairs = others
            .filter(|&(other, way)| is_pair(is_aircraft(at) == is_aircraft(other), up == way));
        found.extend(pairs.filter_map(|(other, way)| moved(&one, other, way)));
        found.push(one);
    }
    // Among equals the order decides which is played.
    found.sort_unstable();
    found
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "numbers of a box")]
fn rounded(steps: &[f64]) -> Design {
    steps.iter().map(|steps| steps.round().max(0.0) as u32).collect()
}

#[cfg(test)]
#[path = "search_tests.rs"]
mod tests;
