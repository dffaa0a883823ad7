//! Writes weight files as seeds for fuzzing, the smallest of each kind:
//! `cargo run --example seeds -- FOLDER`.

use std::path::PathBuf;
use std::sync::Arc;

use vertifleet_core::{Network, World};
use vertifleet_learn::nn::{Architecture, GcapsSettings, MlpSettings};
use vertifleet_learn::{TrainingRequest, TrainingSettings};

/// A network of three vertiports, like the day of the fuzzed policies.
const NETWORK: &str = include_str!("../../crates/core/tests/data/small.toml");

fn main() {
    let folder = PathBuf::from(std::env::args().nth(1).expect("a folder to write to"));
    std::fs::create_dir_all(&folder).expect("a folder that can be made");
    let network = Arc::new(Network::from_toml(NETWORK, "small.toml").expect("a good network"));
    let tiny = || GcapsSettings { width: 2, heads: 1, ..GcapsSettings::default() };
    for policy in [
        Architecture::Gcaps(tiny()),
        Architecture::Mlp(MlpSettings { width: 2, layers: 1, value_width: 2 }),
        Architecture::GcapsX(tiny()),
    ] {
        let path = folder.join(policy.name());
        let settings = TrainingSettings::preset(&policy, "default").expect("a preset");
        let (world, commit) = (World::Network(Arc::clone(&network)), String::new());
        let plan = TrainingRequest { world, policy, settings, seed: 1, commit };
        let model = plan.start().expect("settings within their bounds").model();
        model.write(&path).expect("a folder of ours");
    }
}
