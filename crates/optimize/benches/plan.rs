//! The time to plan a day of `paper` with a given number of search steps, where 0 steps give the
//! best day of the policies; and the time to play a day with the rolling horizon.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{Criterion, criterion_group, criterion_main};
use vertifleet_core::{DaySeed, Network};
use vertifleet_optimize::{Budget, Rolling, SearchSettings, plan};
use vertifleet_policy::play;
use vertifleet_sim::Simulation;

fn plans(criterion: &mut Criterion) {
    let network = Network::shipped("paper").expect("a shipped network");
    let day = Arc::new(network.draw(DaySeed::comparison(1).expect("a seed")));
    let mut group = criterion.benchmark_group("plan");
    group.sample_size(10);
    for steps in [0, 1_000] {
        let settings = SearchSettings { budget: Budget::Steps(steps), searches: 1, seed: 1 };
        group.bench_function(format!("{steps} steps of a search"), |bencher| {
            bencher.iter(|| plan(black_box(&day), &settings, Vec::new(), &mut |_| true));
        });
    }
    group.bench_function("rolling, one day", |bencher| {
        bencher.iter(|| {
            let mut simulation = Simulation::new(Arc::clone(&day));
            play(&mut simulation, &mut Rolling::default(), |_| ()).expect("rolling always answers");
            simulation
        });
    });
    group.finish();
}

criterion_group!(benches, plans);
criterion_main!(benches);
