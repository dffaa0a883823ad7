//! The properties that policies of the full observation have with any weights.

use std::sync::Arc;

use vertifleet_core::{DaySeed, Network, Purpose, Scenario, VertiportIx, World};
use vertifleet_policy::{DayPrices, Policy, PricedChoice, RolloutSettings, play};
use vertifleet_sim::{Simulation, check::check};

use vertifleet_observe::PricedDecision;

use crate::Learned;
use crate::gcaps_x_tests::{played, with_opinions};
use crate::nn::{Adjacency, Architecture, GcapsSettings, GraphSettings, Inputs};
use crate::rollouts::RolloutPlayer;
use crate::rows::Rows;
use crate::scorer::Scorer;

fn small(adjacency: Adjacency) -> Architecture {
    let graph = GraphSettings { adjacency, ..GraphSettings::default() };
    Architecture::GcapsFull(GcapsSettings { graph, ..GcapsSettings::of_sizes(8, 2) })
}

/// Two copies of a policy with the same enlarged weights.
fn twice(policy: &Architecture) -> [Learned; 2] {
    let weights = with_opinions(policy, 1);
    [(); 2].map(|()| Learned(Scorer::new(policy, None, Arc::clone(&weights))))
}

/// Days of shipped networks, one of them disturbed, and of random ones.
fn days() -> Vec<Arc<Scenario>> {
    let seed = DaySeed::validation(3).expect("a seed");
    let shipped =
        ["paper", "disrupted", "new-york"].map(|name| Network::shipped(name).expect("shipped"));
    let random = [2, 7].map(|number| World::Random.network(Purpose::Validation, number));
    let shipped = shipped.into_iter().map(Arc::new);
    shipped.chain(random).map(|network| Arc::new(network.draw(seed))).collect()
}

#[test]
fn any_weights_keep_every_rule_on_networks_of_any_size() {
    for policy in [small(Adjacency::Complete), small(Adjacency::Profit)] {
        let weights = with_opinions(&policy, 1);
        let mut policy = Learned(Scorer::new(&policy, None, weights));
        for day in days() {
            let report = check(&day, &played(&day, &mut policy));
            assert!(report.is_valid(), "{report}");
        }
    }
}

#[test]
fn a_batch_of_days_of_all_sizes_is_answered_as_each_alone() {
    let [mut alone, mut together] = twice(&small(Adjacency::Reachable));
    let mut simulations: Vec<Simulation> = days().into_iter().map(Simulation::new).collect();
    for _ in 0..30 {
        let decisions: Vec<_> =
            simulations.iter_mut().map(|day| day.next_decision().expect("days go on")).collect();
        let views = simulations.iter().map(Simulation::view);
        let mut asked = decisions.iter().copied().zip(views);
        let mut choices = Vec::new();
        together.choose_batch(&mut asked, &mut choices).expect("an answer for each");
        let each: Vec<VertiportIx> = decisions
            .iter()
            .zip(&simulations)
            .map(|(decision, day)| alone.choose(decision, &day.view()).expect("an answer"))
            .collect();
        assert_eq!(choices, each);
        for (day, choice) in simulations.iter_mut().zip(choices) {
            day.apply(choice).expect("a choice from the mask");
        }
    }
}

#[test]
fn features_are_bounded_and_choices_are_feasible_on_every_network() {
    for day in days() {
        let mut simulation = Simulation::new(Arc::clone(&day));
        let policy = small(Adjacency::Profit);
        let mut writer = policy.writer(None);
        let mut rows = Rows::new(&policy, day.vertiports.len());
        while let Some(decision) = simulation.next_decision() {
            let view = simulation.view();
            rows.clear();
            rows.push(|row| writer.write(view, &decision, None, row));
            let inputs = rows.inputs();
            let numbers = inputs.nodes.iter().chain(inputs.aircraft);
            let numbers = numbers.chain(inputs.edges);
            assert!(numbers.clone().all(|number| (-2.0..=4.0).contains(number)), "{numbers:?}");
            let feasible = view.feasible(&decision);
            let mask = inputs.mask.iter().enumerate();
            assert!(
                mask.clone()
                    .all(|(at, &open)| { (open == 1) == feasible.contains(VertiportIx::new(at)) })
            );
            let choice = mask.filter(|(_, open)| **open == 1).map(|(at, _)| at).next_back();
            let choice = VertiportIx::new(choice.expect("a mask is never empty"));
            simulation.apply(choice).expect("a choice from the mask");
        }
    }
}

#[test]
fn cached_values_equal_recomputed_ones() {
    let policy = small(Adjacency::Profit);
    let mut remembering = policy.writer(None);
    let mut days: Vec<Simulation> = days().into_iter().map(Simulation::new).collect();
    for number in 0..400 {
        // In turns, as in a batch, and with a different choice each time.
        for simulation in &mut days {
            let Some(decision) = simulation.next_decision() else { continue };
            let view = simulation.view();
            let [kept, fresh] = [&mut remembering, &mut policy.writer(None)].map(|writer| {
                let mut rows = Rows::new(&policy, view.vertiports());
                rows.push(|row| writer.write(view, &decision, None, row));
                let Inputs { nodes, aircraft, edges, .. } = rows.inputs();
                [nodes, aircraft, edges].concat()
            });
            assert!(kept == fresh, "decision {number}");
            let feasible = view.feasible(&decision);
            let choice = feasible.nth(number % feasible.len()).expect("a rank within the mask");
            simulation.apply(choice).expect("it is feasible");
        }
    }
}

#[test]
fn a_choice_that_is_rolled_out_to_the_end_has_the_value_of_the_days_profit() {
    let [mut rolled_out, mut alone] = twice(&small(Adjacency::Complete));
    let settings =
        RolloutSettings { horizon_s: 86_400, rollouts: 2, noise: 0.0, price_weight: 0.0 };
    // Nothing about this day is uncertain.
    let network = Network::shipped("paper").expect("a shipped network");
    let day = Arc::new(network.draw(DaySeed::validation(3).expect("a seed")));
    let mut simulation = Simulation::new(day);
    let mut player = RolloutPlayer::default();
    for number in 0..120 {
        let decision = simulation.next_decision().expect("the day goes on");
        if number % 30 == 7 {
            let view = simulation.view();
            let prices = DayPrices::of(view, decision.time);
            let scene = PricedDecision::of(view, &decision, &prices);
            let listed: Vec<PricedChoice> = view
                .feasible(&decision)
                .iter()
                .map(|to| PricedChoice { worth_usd: 0.0, to })
                .collect();
            let values_usd = player.values_usd(&mut rolled_out.0, &settings, scene, &listed);
            for (choice, &value_usd) in listed.iter().zip(values_usd) {
                let mut then = simulation.clone();
                then.apply(choice.to).expect("it is feasible");
                play(&mut then, &mut alone, |_| ()).expect("it always answers");
                assert_eq!(value_usd, then.ledger().profit_usd());
            }
        }
        let view = simulation.view();
        let to = alone.choose(&decision, &view).expect("it always answers");
        simulation.apply(to).expect("it is feasible");
    }
}
