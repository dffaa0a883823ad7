//! Decisions per second that `gcaps` learns from, in gradient steps as PPO takes them.
//! `benches/pytorch_update.py` runs this example and compares it with PyTorch.
//!
//! ```text
//! update_speed [decisions per step] [decisions per chunk] [seconds]
//! ```
//!
//! `RAYON_NUM_THREADS` sets its number of threads.

#[path = "../benches/work/mod.rs"]
mod work;

use std::time::{Duration, Instant};

use work::{Decisions, Learner, network};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let mut number = |otherwise: usize| {
        arguments
            .next()
            .map_or(otherwise, |text| text.parse().expect("arguments are whole numbers"))
    };
    let (step, chunk, seconds) = (number(1024), number(128), number(3));
    let network = network("gcaps");
    let decisions = Decisions::new(network.shape(), step);
    let mut learner = Learner::new(network, chunk);
    learner.step(&decisions);
    let start = Instant::now();
    let mut steps = 0_u32;
    while start.elapsed() < Duration::from_secs(seconds as u64) {
        learner.step(&decisions);
        steps += 1;
    }
    println!("{:.0}", f64::from(steps) * step as f64 / start.elapsed().as_secs_f64());
}
