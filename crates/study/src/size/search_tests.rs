//! The search on a world that is known by a formula, against all of its designs.

use std::collections::BTreeMap;

use proptest::prelude::{Strategy, any, prop_assert, proptest};
use vertifleet_core::Network;

use super::super::ceiling::Cut;
use super::super::space::{Design, Space};
use super::{Aim, DayNumbers, Found, Solver, search, steps_from};
use crate::Error;
use crate::size::Goal;
use crate::sweep::Factor;

/// Days that all designs meet.
const DAYS: usize = 4;

/// A world in which a fleet and two vertiports' stands bring less and less, and the policy has a
/// share of what the bound allows that falls with the fleet.
struct Concave {
    costs: Vec<f64>,
    /// By how much the policy's share falls with each aircraft.
    crowding: f64,
    /// The largest share by which chance changes a day of a design.
    noise: f64,
    seed: u64,
    days: BTreeMap<Design, usize>,
    bounded: usize,
}

/// What each dimension brings at most, and the number at which it has brought two thirds of it.
const BRINGS: [(f64, f64); 3] = [(30_000.0, 9.0), (4_000.0, 3.0), (1_500.0, 2.0)];

impl Concave {
    fn new(costs: [f64; 3]) -> Self {
        let (days, bounded) = (BTreeMap::new(), 0);
        Self { costs: costs.to_vec(), crowding: 0.002, noise: 0.0, seed: 0, days, bounded }
    }

    fn most(steps: &[u32]) -> f64 {
        let each = BRINGS.iter().zip(steps);
        each.map(|((most, third), &steps)| most * (1.0 - (-f64::from(steps) / third).exp())).sum()
    }

    /// Passengers on a day.
    fn carried_on(&self, steps: &[u32], day: usize) -> f64 {
        let share = 0.97 - self.crowding * f64::from(steps[0]) + 0.001 * f64::from(steps[1] % 3);
        let mixed = steps.iter().fold(self.seed + day as u64, |mixed, &steps| {
            (mixed ^ u64::from(steps)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23)
        });
        let chance = 1.0 - self.noise * (mixed >> 11) as f64 / (1_u64 << 53) as f64;
        share.max(0.0) * chance * Self::most(steps) / 40.0
    }

    fn mean(number: impl Fn(usize) -> f64) -> f64 {
        (0..DAYS).map(number).sum::<f64>() / DAYS as f64
    }

    fn carried(&self, steps: &[u32]) -> f64 {
        Self::mean(|day| self.carried_on(steps, day))
    }

    fn cost(&self, steps: &[u32]) -> f64 {
        self.costs.iter().zip(steps).map(|(cost, &steps)| cost * f64::from(steps)).sum()
    }

    fn profit_on(&self, steps: &[u32], day: usize) -> f64 {
        40.0 * self.carried_on(steps, day) - self.cost(steps)
    }

    fn profit_usd(&self, steps: &[u32]) -> f64 {
        Self::mean(|day| self.profit_on(steps, day))
    }

    fn simulated_days(&self) -> usize {
        self.days.values().sum()
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

    fn days(&self) -> usize {
        DAYS
    }

    fn play(&mut self, designs: &[Design], days: usize) -> Result<Vec<Vec<DayNumbers>>, Error> {
        for design in designs {
            let known = self.0.days.insert(design.clone(), days).unwrap_or(0);
            assert!(known < days, "no day of a design is played twice");
        }
        let played = designs.iter().map(|design| {
            let numbers = |day| DayNumbers {
                profit_usd: self.0.profit_on(design, day),
                carried: self.0.carried_on(design, day),
            };
            (0..days).map(numbers).collect()
        });
        Ok(played.collect())
    }
}

/// Searches the world, and checks that the answer is not below a neighbour.
fn searched(world: &mut Concave, aim: &Aim, budget: usize) -> Found {
    let space = space();
    let found = search(&space, aim, budget, &mut World(world, aim.goal)).expect("a search");
    assert!(found.searched_days <= budget * DAYS, "{} days", found.searched_days);
    assert_eq!(found.simulated_days, world.simulated_days());
    let rank = |design: &Design| match aim.goal {
        Goal::MostProfit => world.profit_usd(design),
        Goal::Served(_) if world.carried(design) >= aim.need => 1e9 - world.cost(design),
        Goal::Served(_) | Goal::LeastSpill => world.carried(design),
    };
    let neighbours = steps_from(&space, &found.best, 1);
    assert_eq!(neighbours.len(), found.neighbours);
    for one in neighbours {
        let (neighbour, best) = (rank(&one), rank(&found.best));
        assert!(neighbour <= best, "{:?} has {best}, {one:?} {neighbour}", found.best);
    }
    found
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
        let found = searched(&mut world, &aim, 40);
        let all = all_designs(&space);
        let best = all.iter().map(|one| world.profit_usd(one)).fold(f64::NEG_INFINITY, f64::max);
        let reached = world.profit_usd(&found.best);
        assert!(reached > best - 0.001 * best.abs(), "{costs:?}: {reached} of {best}");
        let highest = all.iter().map(|one| Concave::most(one) - world.cost(one));
        let highest = highest.fold(f64::NEG_INFINITY, f64::max);
        let most = found.ceiling.most();
        assert!(most >= highest && most < 1.01 * highest, "{most}, {highest}");
        assert!(world.simulated_days() <= 60 * DAYS && world.bounded <= 15);
    }
}

#[test]
fn a_policy_that_makes_far_less_of_a_fleet_than_the_bound_is_sized_by_what_it_makes() {
    let space = space();
    for crowding in [0.008, 0.012, 0.016] {
        for budget in [8, 16, 40] {
            let costs = [100.0, 50.0, 50.0];
            let mut world = Concave { crowding, ..Concave::new(costs) };
            let aim = Aim { goal: Goal::MostProfit, need: 0.0, costs: costs.to_vec() };
            let found = searched(&mut world, &aim, budget);
            let all = all_designs(&space);
            let best = all.iter().map(|one| world.profit_usd(one)).fold(0.0, f64::max);
            let reached = world.profit_usd(&found.best);
            assert!(reached >= 0.99 * best, "{crowding}, {budget}: {reached} of {best}");
            let limit = (budget + 60) * DAYS;
            assert!(world.simulated_days() <= limit, "{} days", world.simulated_days());
        }
    }
}

fn any_goal() -> impl Strategy<Value = Goal> {
    (0..3, 0.3..1.2_f64).prop_map(|(which, share)| match which {
        0 => Goal::MostProfit,
        1 => Goal::LeastSpill,
        _ => Goal::Served(share),
    })
}

proptest! {
    /// Chance makes local optima of many designs.
    #[test]
    fn the_answer_is_never_below_a_neighbour_and_the_search_keeps_to_its_budget(
        goal in any_goal(), seed in any::<u32>(), noise in 0.0..0.2_f64, crowding in 0.0..0.02_f64,
        costs in proptest::array::uniform3(0.0..900.0_f64), budget in 2_usize..40
    ) {
        let mut world = Concave { noise, crowding, seed: seed.into(), ..Concave::new(costs) };
        let need = match goal {
            Goal::Served(share) => share * Concave::most(&[20, 5, 5]) / 40.0,
            Goal::MostProfit | Goal::LeastSpill => 0.0,
        };
        let aim = Aim { goal, need, costs: costs.to_vec() };
        let found = searched(&mut world, &aim, budget);
        prop_assert!(found.order.contains(&found.best));
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
        let need = share * all.iter().map(|one| world.carried(one)).fold(0.0, f64::max);
        let aim = Aim { goal: Goal::Served(share), need, costs: costs.to_vec() };
        let found = searched(&mut world, &aim, budget);
        assert!(found.reaches && world.carried(&found.best) >= need);
        let enough = all.iter().filter(|one| world.carried(one) >= need);
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
    let aim = Aim { goal: Goal::Served(1.0), need: 1e6, costs: costs.to_vec() };
    let found = searched(&mut Concave::new(costs), &aim, 30);
    assert!(!found.reaches && found.ceiling.most() < 1e6);
    assert!(found.ceiling.least_cost(&costs, 1e6).is_infinite());
}
