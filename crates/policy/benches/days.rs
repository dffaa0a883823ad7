//! Decisions per second of the simulator, over whole days of the `paper` network with uniformly
//! random choices.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use vertifleet_core::{DaySeed, Network, Scenario};
use vertifleet_policy::{Policy, Random};
use vertifleet_sim::Simulation;

fn play(day: &Arc<Scenario>) -> Simulation {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut policy = Random::new(1);
    while let Some(decision) = simulation.next_decision() {
        let choice = policy.choose(&decision, &simulation.view()).expect("random always answers");
        black_box(simulation.apply(choice).expect("a choice from the mask"));
    }
    simulation
}

fn days(criterion: &mut Criterion) {
    let network = Network::shipped("paper").expect("a shipped network");
    let day = Arc::new(network.draw(DaySeed::comparison(1).expect("a seed")));
    let decisions = u64::from(play(&day).totals().decisions);
    let mut group = criterion.benchmark_group("simulation");
    group.throughput(Throughput::Elements(decisions));
    group.bench_function("random, paper, one day", |bencher| {
        bencher.iter_batched(|| Arc::clone(&day), |day| play(&day), BatchSize::SmallInput);
    });
    group.finish();
}

criterion_group!(benches, days);
criterion_main!(benches);
