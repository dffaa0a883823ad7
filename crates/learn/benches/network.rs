//! The speed of the networks: for one decision, for decisions in batches, and for a chunk of an
//! update, each on one thread.

mod work;

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use work::{Decisions, Learner, network};

/// The time per decision, alone and in a batch.
fn decisions(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("decisions");
    for name in ["gcaps", "mlp"] {
        let network = network(name);
        let weights = network.weights(network.init(1));
        for batch in [1, 16, 256] {
            let decisions = Decisions::new(network.shape(), batch);
            let mut workspace = network.workspace(batch);
            group.throughput(Throughput::Elements(batch as u64));
            group.bench_function(BenchmarkId::new(name, batch), |bencher| {
                bencher.iter(|| {
                    network.forward(&weights, decisions.inputs(0, batch), &mut workspace);
                    black_box(workspace.logits());
                });
            });
        }
    }
    group.finish();
}

/// A gradient step on 2,048 decisions, by the size of the chunks: forward pass, backward pass, sum
/// of gradients, Adam.
fn updates(criterion: &mut Criterion) {
    const DECISIONS: usize = 2048;
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let mut group = criterion.benchmark_group("update of 2048");
    group.sample_size(10).throughput(Throughput::Elements(DECISIONS as u64));
    for name in ["gcaps", "mlp"] {
        let decisions = Decisions::new(network(name).shape(), DECISIONS);
        for chunk in [32, 64, 128, 256] {
            let mut learner = Learner::new(network(name), chunk);
            group.bench_function(BenchmarkId::new(name, format!("chunks of {chunk}")), |bencher| {
                bencher.iter(|| one_thread.install(|| learner.step(&decisions)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, decisions, updates);
criterion_main!(benches);
