//! Decisions per second over whole days of uniformly random choices, with an observation written
//! for each decision.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use vertifleet_core::{DaySeed, Network, Scenario};
use vertifleet_observe::{Layout, Observer, PRESETS, Scene, Sizes, preset};
use vertifleet_policy::{Policy, Random};
use vertifleet_sim::Simulation;

fn play(day: &Arc<Scenario>, layout: &Layout, observer: &mut Observer) -> Simulation {
    let mut simulation = Simulation::new(Arc::clone(day));
    let mut policy = Random::new(1);
    let mut row = vec![0.0; layout.width()];
    while let Some(decision) = simulation.next_decision() {
        layout.write(&mut row, &Scene::of(simulation.view(), &decision), observer);
        black_box(&row);
        let choice = policy.choose(&decision, &simulation.view()).expect("random always answers");
        simulation.apply(choice).expect("a choice from the mask");
    }
    simulation
}

fn observation(criterion: &mut Criterion) {
    let network = Network::shipped("paper").expect("a shipped network");
    let day = Arc::new(network.draw(DaySeed::comparison(1).expect("a seed")));
    let mut group = criterion.benchmark_group("simulation");
    for name in PRESETS {
        let layout = Layout::new(preset(name).expect("a preset"), Sizes::of(&network));
        let mut observer = Observer::of(&network);
        let decisions = u64::from(play(&day, &layout, &mut observer).totals().decisions);
        group.throughput(Throughput::Elements(decisions));
        group.bench_function(
            format!("random with observation {name}, paper, one day"),
            |bencher| {
                bencher.iter_batched(
                    || Arc::clone(&day),
                    |day| play(&day, &layout, &mut observer),
                    BatchSize::SmallInput,
                );
            },
        );
    }
    group.finish();
}

criterion_group!(benches, observation);
criterion_main!(benches);
