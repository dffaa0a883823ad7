//! The search on a world that is known by a formula, against all of its designs.

use std::collections::BTreeSet;

use vertifleet_core::Network;

use super::super::ceiling::Cut;
use super::super::space::{Design, Space};
use super::{Aim, DesignMeans, Solver, search};
use crate::Error;
use crate::size::Goal;
use crate::sweep::Factor;

/// A world in which a fleet and two vertiports' stands bring less and less, and the policy has a
/// share of what the bound allows that falls with the fleet.
struct Concave {
    costs: Vec<f64>,
    played: BTreeSet<Design>,
    bounded: usize,
}

/// What each dimension brings at most, and the number at which it has brought two thirds of it.
const BRINGS: [(f64, f64); 3] = [(30_000.0, 9.0), (4_000.0, 3.0), (1_500.0, 2.0)];

impl Concave {
    fn new(costs: [f64; 3]) -> Self {
        Self { costs: costs.to_vec(), played: BTreeSet::new(), bounded: 0 }
    }

    fn most(steps: &[u32]) -> f64 {
        let each = BRINGS.iter().zip(steps);
        each.map(|((most, third), &steps)| most * (1.0 - (-f64::from(steps) / third).exp())).sum()
    }

    fn carried(steps: &[u32]) -> f64 {
        let share = 0.97 - 0.002 * f64::from(steps[0]) + 0.001 * f64::from(steps[1] % 3);
        share * Self::most(steps) / 40.0
    }

    fn cost(&self, steps: &[u32]) -> f64 {
        self.costs.iter().zip(steps).map(|(cost, &steps)| cost * f64::from(steps)).sum()
    }

    fn profit_usd(&self, steps: &[u32]) -> f64 {
        40.0 * Self::carried(steps) - self.cost(steps)
    }
}

/// The same world, whose bounds are of profits or of passengers.
struct World<'a>(&'a mut Concave, Goal);

impl Solver for World<'_> {
    fn bound(&mut self, design: &Design) -> Result<Cut, Error> {
        self.0.bounded += 1;
        let per = if self.1 == Goal::MostProfit { 1.0 } else { 1.0 / 40.0 };
        let slopes: Vec<f64> = BRINGS
            .iter()
            .zip(design)
            .zip(&self.0.costs)
            .map(|(((most, third), &steps), cost)| {
                let slope = per * most / third * (-f64::from(steps) / third).exp();
                if self.1 == Goal::MostProfit { slope - cost } else { slope }
            })
            .collect();
        let cost = if self.1 == Goal::MostProfit { self.0.cost(design) } else { 0.0 };
        let value = per * Concave::most(design) - cost;
        let rise: f64 =
            slopes.iter().zip(design).map(|(slope, &steps)| slope * f64::from(steps)).sum();
        Ok(Cut { constant: value - rise, slopes })
    }

    fn play(&mut self, design: &Design) -> Result<DesignMeans, Error> {
        assert!(self.0.played.insert(design.clone()), "no design is played twice");
        Ok(DesignMeans { profit_usd: self.0.profit_usd(design), carried: Concave::carried(design) })
    }
}

fn space() -> Space {
    let paper = Network::shipped("paper").expect("shipped");
    let factors =
        ["fleet.0.count=1..41", "vertiports.V1.stands=6..16", "vertiports.V2.stands=6..16"];
    let factors = factors.map(|text| Factor::parse(text).expect("a factor"));
    Space::new(&paper, &factors, Goal::MostProfit).expect("a space")
}

fn all_designs(space: &Space) -> Vec<Design> {
    let mut all = vec![Vec::new()];
    for one in &space.dimensions {
        all = all
            .into_iter()
            .flat_map(|design: Design| {
                (0..=one.steps).map(move |steps| [design.clone(), vec![steps]].concat())
            })
            .collect();
    }
    all
}

#[test]
fn the_best_design_is_found_with_a_fraction_of_all_and_none_passes_the_ceiling() {
    let space = space();
    for costs in [[500.0, 200.0, 150.0], [1_500.0, 50.0, 700.0], [0.0, 0.0, 0.0]] {
        let mut world = Concave::new(costs);
        let aim = Aim { goal: Goal::MostProfit, need: 0.0, costs: costs.to_vec() };
        let found =
            search(&space, &aim, 60, &mut World(&mut world, Goal::MostProfit)).expect("a search");
        let all = all_designs(&space);
        let best = all.iter().map(|one| world.profit_usd(one)).fold(f64::NEG_INFINITY, f64::max);
        let reached = world.profit_usd(&found.best);
        assert!(reached > best - 0.001 * best.abs(), "{costs:?}: {reached} of {best}");
        let highest = all.iter().map(|one| Concave::most(one) - world.cost(one));
        let highest = highest.fold(f64::NEG_INFINITY, f64::max);
        let most = found.ceiling.most();
        assert!(most >= highest && most < 1.01 * highest, "{most}, {highest}");
        assert!(world.played.len() <= 60 && world.bounded <= 15);
    }
}

#[test]
fn the_cheapest_design_that_carries_enough_is_found() {
    let space = space();
    for (share, budget, most) in
        [(0.5, 60, 1.0), (0.8, 60, 1.0), (0.95, 60, 1.0), (0.8, 10, 1.03), (0.95, 10, 1.03)]
    {
        let costs = [500.0, 200.0, 150.0];
        let mut world = Concave::new(costs);
        let all = all_designs(&space);
        let need = share * all.iter().map(|one| Concave::carried(one)).fold(0.0, f64::max);
        let goal = Goal::Served(share);
        let aim = Aim { goal, need, costs: costs.to_vec() };
        let found = search(&space, &aim, budget, &mut World(&mut world, goal)).expect("a search");
        assert!(found.reaches && Concave::carried(&found.best) >= need);
        assert!(world.played.len() <= budget);
        let enough = all.iter().filter(|one| Concave::carried(one) >= need);
        let cheapest = enough.map(|one| world.cost(one)).fold(f64::INFINITY, f64::min);
        let cost = world.cost(&found.best);
        assert!(cost <= most * cheapest, "{share}: {cost}, the cheapest costs {cheapest}");
        let least = found.ceiling.least_cost(&costs, need);
        assert!(least <= cheapest, "{least}, {cheapest}");
    }
}

#[test]
fn what_cannot_be_reached_is_said_to_be_out_of_reach() {
    let costs = [500.0, 200.0, 150.0];
    let (space, goal) = (space(), Goal::Served(1.0));
    let aim = Aim { goal, need: 1e6, costs: costs.to_vec() };
    let mut world = Concave::new(costs);
    let found = search(&space, &aim, 30, &mut World(&mut world, goal)).expect("a search");
    assert!(!found.reaches && found.ceiling.most() < 1e6);
    assert!(found.ceiling.least_cost(&costs, 1e6).is_infinite());
}

#[test]
fn no_more_designs_are_played_than_may_be() {
    let costs = [500.0, 200.0, 150.0];
    for budget in 2..8 {
        for goal in [Goal::Served(0.9), Goal::MostProfit, Goal::LeastSpill] {
            let mut world = Concave::new(costs);
            let aim = Aim { goal, need: 700.0, costs: costs.to_vec() };
            search(&space(), &aim, budget, &mut World(&mut world, goal)).expect("a search");
            assert!(world.played.len() <= budget, "{budget}, {goal:?}: {:?}", world.played);
        }
    }
}
