//! The time to find the prices of a `paper` day, to recompute them and to decide by them, and to
//! recompute them on a day of 100 vertiports and 2,000 aircraft and to play it.

use std::fmt::Write;
use std::hint::black_box;
use std::sync::Arc;

use criterion::measurement::WallTime;
use criterion::{BatchSize, BenchmarkGroup, Criterion, criterion_group, criterion_main};
use vertifleet_core::{DaySeed, Network, Scenario};
use vertifleet_policy::{BidPricePolicy, DayPrices, play};
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
    bench_renewal(
        &mut group,
        "paper, found again after a quarter of an hour",
        &simulation,
        &morning,
    );
    let decision = simulation.next_decision().expect("a day has decisions");
    group.bench_function("paper, one choice", |bencher| {
        bencher.iter(|| morning.best_choice(black_box(simulation.view()), &decision));
    });
    group.sample_size(10);
    bench_day(&mut group, "paper, one day", &day);
    group.finish();
}

/// The time to recompute the prices of the morning after a quarter of an hour.
fn bench_renewal(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    simulation: &Simulation,
    morning: &DayPrices,
) {
    let later = simulation.scenario().operations.start + 900;
    group.bench_function(name, |bencher| {
        bencher.iter_batched_ref(
            || morning.clone(),
            |prices| prices.refresh(black_box(simulation.view()), later),
            BatchSize::LargeInput,
        );
    });
}

/// The time to play a day by prices.
fn bench_day(group: &mut BenchmarkGroup<'_, WallTime>, name: &str, day: &Arc<Scenario>) {
    group.bench_function(name, |bencher| {
        bencher.iter(|| {
            let mut simulation = Simulation::new(Arc::clone(day));
            play(&mut simulation, &mut BidPricePolicy::default(), |_| ())
                .expect("prices always answer");
            simulation
        });
    });
}

/// 100 vertiports spread evenly over 45 x 45 miles, with 26 stands each, and 2,000 aircraft.
/// Everything else is as in `paper`, except for a demand that a fleet of this size can just about
/// carry.
fn large_network() -> Network {
    let paper = include_str!("../../../networks/paper.toml");
    let (head, _) = paper.split_once("[[vertiports]]").expect("paper lists its vertiports");
    let (_, tail) = paper.split_once("[[aircraft_types]]").expect("paper lists its types");
    let mut text = head.to_owned();
    for at in 0..100_u32 {
        // A low-discrepancy sequence: powers of the plastic number.
        let spread = |ratio: f64| 45.0 * (ratio * f64::from(at)).fract();
        let (x_mi, y_mi) = (spread(0.754_877_666), spread(0.569_840_291));
        write!(
            text,
            "[[vertiports]]\nid = \"V{at}\"\nx_mi = {x_mi:.1}\ny_mi = {y_mi:.1}\nstands = 26\nbusy = {}\n\n",
            at < 25
        )
        .expect("memory takes everything");
    }
    text.push_str("[[aircraft_types]]");
    text.push_str(
        &tail
            .replace("count = 40", "count = 2000")
            .replace("peak = { mean = 100, sd = 10 }", "peak = { mean = 9, sd = 2 }")
            .replace("busy_pairs = { mean = 50, sd = 10 }", "busy_pairs = { mean = 5, sd = 1 }")
            .replace("otherwise = { mean = 30, sd = 5 }", "otherwise = { mean = 3, sd = 0.6 }"),
    );
    Network::from_toml(&text, "a large network").expect("a valid network")
}

fn large(criterion: &mut Criterion) {
    let day = Arc::new(large_network().draw(DaySeed::comparison(1).expect("a seed")));
    assert_eq!((day.vertiports.len(), day.aircraft.len()), (100, 2_000));
    let mut group = criterion.benchmark_group("prices");
    group.sample_size(10);
    let (start, simulation) = (day.operations.start, Simulation::new(Arc::clone(&day)));
    let morning = DayPrices::of(simulation.view(), start);
    bench_renewal(
        &mut group,
        "100 vertiports and 2,000 aircraft, found again",
        &simulation,
        &morning,
    );
    bench_day(&mut group, "100 vertiports and 2,000 aircraft, one day", &day);
    group.finish();
}

criterion_group!(benches, prices, large);
criterion_main!(benches);
