//! The time to prove an upper bound of a `paper` day on one core.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use vertifleet_core::{DaySeed, Network};
use vertifleet_optimize::{Step, upper_bound};

fn bound(criterion: &mut Criterion) {
    let network = Network::shipped("paper").expect("a shipped network");
    let day = network.draw(DaySeed::comparison(1).expect("a seed"));
    let mut group = criterion.benchmark_group("bound");
    group.sample_size(10);
    for minutes in [15, 5, 3, 1] {
        let step = Step::from_minutes(minutes).expect("a step");
        group.bench_function(format!("paper, one day, {minutes} min"), |bencher| {
            bencher.iter(|| black_box(upper_bound(&day, step).expect("a small day")));
        });
    }
    group.finish();
}

criterion_group!(benches, bound);
criterion_main!(benches);
