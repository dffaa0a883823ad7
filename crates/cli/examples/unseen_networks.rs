//! How `gcaps-x` does on networks that it never saw: one day each of random networks that no training draws, beside the rules
//! and the certified bound.
//!
//! Run: `cargo run --release -p vertifleet-cli --example unseen_networks -- WEIGHTS [50]`

use std::path::Path;
use std::sync::Arc;

use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use vertifleet_core::{DaySeed, Purpose, Scenario};
use vertifleet_learn::random_network;
use vertifleet_learn::relative::{AnyModel, GcapsX};
use vertifleet_optimize::{Step, upper_bound};
use vertifleet_policy::{Greedy, Policy, Priced, play};
use vertifleet_sim::Simulation;

/// Who plays, in the order of the columns.
const NAMES: [&str; 3] = ["greedy", "prices", "gcaps-x"];

/// A network's day: sizes, and the share of the bound that each policy earns.
struct Outcome {
    vertiports: usize,
    fleet: usize,
    shares: [f64; 3],
}

fn profit_usd(policy: &mut dyn Policy, day: &Arc<Scenario>) -> f64 {
    let mut simulation = Simulation::new(Arc::clone(day));
    play(&mut simulation, policy, |_| ()).expect("these policies always have an answer");
    simulation.ledger().profit_usd()
}

fn outcome(number: u64, model: &Arc<AnyModel>) -> Outcome {
    let seed = DaySeed::comparison(number).expect("few numbers");
    let day = Arc::new(random_network(Purpose::Comparison, number).draw(seed));
    let step = Step::from_minutes(3).expect("minutes of a step");
    let bound_usd = upper_bound(&day, step).expect("a day that can be bounded").upper_bound_usd();
    let policies: [Box<dyn Policy>; 3] =
        [Box::new(Greedy), Box::new(Priced::default()), Box::new(GcapsX::new(Arc::clone(model)))];
    let shares = policies.map(|mut policy| profit_usd(policy.as_mut(), &day) / bound_usd);
    Outcome { vertiports: day.vertiports.len(), fleet: day.aircraft.len(), shares }
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().expect("a file with weights of gcaps-x");
    let model = Arc::new(AnyModel::read(Path::new(&path)).expect("weights of gcaps-x"));
    let count: u64 = arguments.next().map_or(50, |count| count.parse().expect("a number"));
    let outcomes: Vec<Outcome> =
        (0..count).into_par_iter().map(|number| outcome(number, &model)).collect();
    println!("network,vertiports,aircraft,{}", NAMES.join(","));
    for (number, Outcome { vertiports, fleet, shares }) in outcomes.iter().enumerate() {
        let shares = shares.map(|share| format!("{share:.4}")).join(",");
        println!("{number},{vertiports},{fleet},{shares}");
    }
    for (at, name) in NAMES.iter().enumerate() {
        let mean = outcomes.iter().map(|outcome| outcome.shares[at]).sum::<f64>() / count as f64;
        let beats = |other: usize| {
            outcomes.iter().filter(|outcome| outcome.shares[at] > outcome.shares[other]).count()
        };
        println!(
            "{name}: {:.2} % of the bound; above greedy on {}, above prices on {} of {count}",
            100.0 * mean,
            beats(0),
            beats(1)
        );
    }
}
