//! How long prices of a `paper` day take to find, to find anew, and to decide by.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use vertifleet_core::{DaySeed, Network};
use vertifleet_policy::{DayPrices, Priced, play};
use vertifleet_sim::Simulation;

fn prices(criterion: &mut Criterion) {
    let network = Network::shipped("paper").expect("a shipped network");
    let day = Arc::new(network.draw(DaySeed::comparison(1).expect("a seed")));
    let mut simulation = Simulation::new(Arc::clone(&day));
    let start = day.operations.start;
    let mut group = criterion.benchmark_group("prices");
    group.bench_function("paper, found in the morning", |bencher| {
        bencher.iter(|| DayPrices::of(black_box(simulation.view()), start));
    });
    let morning = DayPrices::of(simulation.view(), start);
    group.bench_function("paper, found anew after a quarter of an hour", |bencher| {
        bencher.iter_batched_ref(
            || morning.clone(),
            |prices| prices.keep_up(black_box(simulation.view()), start + 900),
            BatchSize::SmallInput,
        );
    });
    let decision = simulation.next_decision().expect("a day has decisions");
    group.bench_function("paper, one choice", |bencher| {
        bencher.iter(|| morning.best_choice(black_box(simulation.view()), &decision));
    });
    group.sample_size(10);
    group.bench_function("paper, one day", |bencher| {
        bencher.iter(|| {
            let mut simulation = Simulation::new(Arc::clone(&day));
            play(&mut simulation, &mut Priced::default(), |_| ()).expect("prices always answer");
            simulation
        });
    });
    group.finish();
}

criterion_group!(benches, prices);
criterion_main!(benches);
