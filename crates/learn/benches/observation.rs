//! Decisions per second over whole days of uniformly random choices, with the observation of §IV.A
//! written for each decision.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use vertifleet_core::{DaySeed, Network, Scenario};
use vertifleet_learn::{Observations, Scales, shape};
use vertifleet_policy::{Policy, Random};
use vertifleet_sim::Simulation;

fn play(day: &Arc<Scenario>, observations: &mut Observations, scales: &Scales) -> Simulation {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut policy = Random::new(1);
    while let Some(decision) = simulation.next_decision() {
        observations.write(0, &decision, &simulation.view(), scales);
        black_box(observations.inputs(1));
        let choice = policy.choose(&decision, &simulation.view()).expect("random always answers");
        simulation.apply(choice).expect("a choice from the mask");
    }
    simulation
}

fn observation(criterion: &mut Criterion) {
    let network = Network::shipped("paper").expect("a shipped network");
    let day = Arc::new(network.draw(DaySeed::comparison(1).expect("a seed")));
    let scales = Scales::from(network.feature_scales());
    let mut observations = Observations::new(shape(network.vertiports().len()), 1);
    let decisions = u64::from(play(&day, &mut observations, &scales).totals().decisions);
    let mut group = criterion.benchmark_group("simulation");
    group.throughput(Throughput::Elements(decisions));
    group.bench_function("random with observations, paper, one day", |bencher| {
        bencher.iter_batched(
            || Arc::clone(&day),
            |day| play(&day, &mut observations, &scales),
            BatchSize::SmallInput,
        );
    });
    group.finish();
}

criterion_group!(benches, observation);
criterion_main!(benches);
