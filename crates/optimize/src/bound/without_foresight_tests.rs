//! Checks the bound without foresight on worlds so small that the best policy is found by
//! enumeration: over all delays that may be drawn, and over all decisions of a policy that learns
//! the delays of a slot when the slot begins.

use std::sync::Arc;

use rayon::prelude::*;
use vertifleet_core::{
    Aircraft, AircraftType, Charging, Day, DaySeed, Disturbances, Matrix, Network, Operations,
    Scenario, Stop, TakeoffDelays, Time, TypeIx, Vertiport, VertiportIx,
};
use vertifleet_sim::Simulation;
use vertifleet_testkit::{Size, any_extended_day};

use super::without_foresight::{bound_with_penalty, bound_without_foresight};
use super::{Step, upper_bound};

/// Seconds by which a flight is late, if it is.
const LATE_S: u32 = 1_500;

/// A world in which every slot's flights from each vertiport are on time or late.
struct World {
    day: Scenario,
    slot_s: u32,
    slots: usize,
    /// By vertiport, how likely its flights are late.
    late: Vec<f64>,
}

impl World {
    /// A tiny day with one to three slots.
    fn of(number: u32) -> Self {
        let day = any_extended_day(number.into(), Size { vertiports: 3, fleet: 2, hours: 2 });
        let mut day = Scenario::clone(&day).into_day();
        day.disturbances.takeoff_delays = None;
        let (start, end) = (day.operations.start, day.operations.end);
        let slot_s = end.since(start) / (1 + number % 3) + 1;
        let count = TakeoffDelays::slots(slot_s, start, end);
        let late = (0..day.vertiports.len()).map(|at| [0.5, 0.2, 0.0][at]).collect();
        let day = day.check("a tiny day").expect("a day with fewer disturbances keeps the rules");
        Self { day, slot_s, slots: count, late }
    }

    /// The day if its first slots have these delays, by slot, then vertiport, and the others none.
    fn with(&self, delays_s: &[Vec<u32>]) -> Arc<Scenario> {
        let mut by_slot = delays_s.to_vec();
        by_slot.resize(self.slots, vec![0; self.late.len()]);
        let mut day = self.day.clone().into_day();
        day.disturbances.takeoff_delays =
            Some(TakeoffDelays { slot_s: self.slot_s, delay_s: by_slot });
        Arc::new(day.check("a tiny day").expect("it was checked before"))
    }

    /// All delays of one slot, by vertiport, each with its probability.
    fn outcomes(&self) -> Vec<(Vec<u32>, f64)> {
        let mut outcomes = vec![(Vec::new(), 1.0)];
        for &late in &self.late {
            let before = std::mem::take(&mut outcomes);
            for (delay_s, probability) in [(0, 1.0 - late), (LATE_S, late)] {
                if probability > 0.0 {
                    outcomes.extend(before.iter().map(|(delays_s, share)| {
                        ([&delays_s[..], &[delay_s]].concat(), share * probability)
                    }));
                }
            }
        }
        outcomes
    }

    /// The mean over all delays of what a day gives with them.
    fn mean(&self, of: &dyn Fn(&Arc<Scenario>) -> f64) -> f64 {
        self.mean_from(&mut Vec::new(), of)
    }

    fn mean_from(&self, drawn: &mut Vec<Vec<u32>>, of: &dyn Fn(&Arc<Scenario>) -> f64) -> f64 {
        if drawn.len() == self.slots {
            return of(&self.with(drawn));
        }
        self.over_next_slot(drawn, &mut |drawn| self.mean_from(drawn, of))
    }

    /// The mean over the delays of the slot after those that are drawn.
    fn over_next_slot(
        &self,
        drawn: &mut Vec<Vec<u32>>,
        of: &mut dyn FnMut(&mut Vec<Vec<u32>>) -> f64,
    ) -> f64 {
        let outcomes = self.outcomes().into_iter();
        outcomes
            .map(|(delays_s, probability)| {
                drawn.push(delays_s);
                let mean = probability * of(drawn);
                drawn.pop();
                mean
            })
            .sum()
    }

    /// The most that a policy earns on the mean from here on, if it knows the delays that are
    /// drawn, and all else of the day; dollars. It is infinite if that takes more looks than are
    /// left.
    fn best_usd(
        &self,
        drawn: &mut Vec<Vec<u32>>,
        decided: &mut Vec<VertiportIx>,
        looks: &mut u32,
    ) -> f64 {
        if *looks == 0 {
            return f64::INFINITY;
        }
        *looks -= 1;
        let mut simulation = Simulation::new(self.with(drawn));
        for &to in decided.iter() {
            simulation.next_decision().expect("it was asked before");
            simulation.apply(to).expect("it was feasible before");
        }
        let Some(decision) = simulation.next_decision() else {
            return simulation.ledger().profit_usd();
        };
        let slot = decision.time.since(self.day.operations.start) / self.slot_s;
        if slot as usize >= drawn.len() {
            return self.over_next_slot(drawn, &mut |drawn| self.best_usd(drawn, decided, looks));
        }
        let feasible: Vec<VertiportIx> = simulation.view().feasible(&decision).iter().collect();
        let worths = feasible.into_iter().map(|to| {
            decided.push(to);
            let usd = self.best_usd(drawn, decided, looks);
            decided.pop();
            usd
        });
        worths.fold(f64::NEG_INFINITY, f64::max)
    }

    /// For each vertiport the probability of each delay.
    fn probabilities(&self) -> Vec<Vec<f64>> {
        let of = |&late: &f64| {
            let mut shares = vec![0.0; LATE_S as usize + 1];
            (shares[0], shares[LATE_S as usize]) = (1.0 - late, late);
            if late > 0.0 { shares } else { vec![1.0] }
        };
        self.late.iter().map(of).collect()
    }
}

/// Worlds that are small enough, each with the mean profit of the best policy that does not know
/// the delays of slots before they begin.
fn worlds() -> Vec<(u32, World, f64)> {
    let found = (0..150_u32).into_par_iter().filter_map(|number| {
        let world = World::of(number);
        let best_usd = world.best_usd(&mut Vec::new(), &mut Vec::new(), &mut 20_000);
        best_usd.is_finite().then_some((number, world, best_usd))
    });
    found.collect()
}

impl World {
    /// The mean bounds without foresight and with it, dollars.
    fn bounds_usd(&self, step: Step) -> (f64, f64) {
        let never = Stop::default();
        let without = self.mean(&|day| {
            let delays = day.disturbances.takeoff_delays.as_ref().expect("it has delays");
            let bound = bound_with_penalty(&never, day, delays, &self.probabilities(), step);
            bound.expect("a small day").expect("it is not stopped").upper_bound_usd()
        });
        let with = self.mean(&|day| upper_bound(day, step).expect("a small day").upper_bound_usd());
        (without, with)
    }
}

#[test]
fn no_policy_without_foresight_earns_more_on_the_mean() {
    let worlds = worlds();
    assert!(worlds.len() >= 40, "{} worlds are small enough", worlds.len());
    worlds.par_iter().for_each(|(number, world, best_usd)| {
        let step = Step::from_minutes([60, 15, 5][*number as usize % 3]).expect("a step");
        let (bound_usd, _) = world.bounds_usd(step);
        assert!(bound_usd >= *best_usd, "world {number}: {bound_usd}, possible {best_usd}");
    });
}

#[test]
fn a_day_that_charges_as_needed_has_the_same_bound_without_foresight() {
    let text = include_str!("../../../../networks/disrupted.toml");
    let text = text.replacen("[operations]", "[operations]\ncharging = \"as_needed\"", 1);
    let network = Network::from_toml(&text, "disrupted.toml").expect("a network");
    let day = network.draw(DaySeed::comparison(1).expect("a seed"));
    let step = Step::from_minutes(60).expect("a step");
    let with = upper_bound(&day, step).expect("a small day").upper_bound_usd();
    let without = bound_without_foresight(&Stop::default(), &network, &day, step);
    let without = without.expect("a small day").expect("it is not stopped").upper_bound_usd();
    assert_eq!(
        without.to_bits(),
        with.to_bits(),
        "{without} $ without foresight, {with} $ with it"
    );
}

/// A world of one aircraft, which flies from V0 to V1 or V2 and back with $40 each time, and then
/// has time for one more such flight if it left V1 or V2 on time. Each of them is late with a
/// probability of one half.
fn world_of_a_coin() -> World {
    let vertiport = |id: &str| Vertiport {
        id: id.to_owned(),
        x_mi: 0.0,
        y_mi: 0.0,
        stands: 2,
        chargers: None,
        charger_kw: None,
        busy: false,
        degrees: None,
        stand_cost_usd: 0.0,
        charger_cost_usd: 0.0,
    };
    let between = |usd: f64| {
        Matrix::from_fn(3, move |from, to| if (from.0 == 0) == (to.0 == 0) { 0.0 } else { usd })
    };
    let start = Time::from_seconds(6 * 3600);
    let (start, end) = (start, start + 65 * 60);
    let day = Day {
        name: "coin".to_owned(),
        seed: 0,
        operations: Operations {
            start,
            end,
            takeoff_s: 300,
            landing_s: 300,
            hold_s: 1_800,
            passenger_wait_s: 0,
            charging: Charging::ToFull,
        },
        vertiports: ["V0", "V1", "V2"].map(vertiport).into(),
        aircraft_types: vec![AircraftType {
            id: "T".to_owned(),
            seats: 4,
            speed_mph: 60.0,
            battery_kwh: 1.0,
            energy_kwh_per_mi: 1e-6,
            charge_kw: 100.0,
            self_discharge_per_h: 0.0,
            reserve_kwh: 0.0,
            turnaround_s: 0,
            charge_curve: None,
        }],
        aircraft: vec![Aircraft {
            id: "A".to_owned(),
            kind: TypeIx(0),
            at: VertiportIx(0),
            start_charge_kwh: None,
        }],
        distance_mi: Matrix::from_fn(3, |from, to| if from == to { 0.0 } else { 20.0 }),
        corridors: None,
        fare_usd: between(10.0).into(),
        passenger_cost_usd: between(0.0),
        flight_cost_usd: between(0.0),
        aircraft_cost_usd: 0.0,
        periods: vec![start],
        demand: vec![Matrix::from_fn(3, |from, to| u32::from(from != to) * 8)],
        energy_price_usd: vec![0.0],
        disturbances: Disturbances::default(),
    };
    let day = day.check("coin").expect("a day within the rules");
    World { day, slot_s: 1_800, slots: 3, late: vec![0.0, 0.5, 0.5] }
}

#[test]
fn the_penalty_takes_back_what_knowing_the_coins_is_worth() {
    let world = world_of_a_coin();
    let best_usd = world.best_usd(&mut Vec::new(), &mut Vec::new(), &mut 1_000_000);
    assert_eq!(best_usd, 100.0, "two flights, and the third one in half of the cases");
    let (without_usd, with_usd) = world.bounds_usd(Step::from_minutes(15).expect("a step"));
    assert!(
        (with_usd - 110.0).abs() < 0.01,
        "a policy that knows the coins flies to the better place: {with_usd}"
    );
    assert!((100.0..100.01).contains(&without_usd), "{without_usd}");
}
