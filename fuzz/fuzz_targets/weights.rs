//! Reads weight files from any bytes. The readers must never panic, and accepted weights must read
//! back as written. A policy that was read decides from the mask, with any weights.

#![no_main]

use std::sync::{Arc, LazyLock};

use libfuzzer_sys::fuzz_target;
use vertifleet_core::Scenario;
use vertifleet_learn::Model;
use vertifleet_policy::{Policy, play};
use vertifleet_sim::Simulation;

/// A day of three vertiports, as many as the seeds' weights are for.
static DAY: LazyLock<Arc<Scenario>> = LazyLock::new(|| {
    let text = include_bytes!("../../crates/core/tests/data/small.json");
    Arc::new(Scenario::from_json(text, "small.json").expect("a day within the rules"))
});

fn plays(policy: &mut dyn Policy) {
    let mut day = Simulation::new(Arc::clone(&DAY));
    play(&mut day, policy, |_| ()).expect("a policy chooses from the mask");
}

fuzz_target!(|bytes: &[u8]| {
    if let Ok(model) = Model::from_bytes(bytes, "any") {
        let again = Model::from_bytes(&model.to_bytes(), "again").expect("our own bytes");
        assert_eq!((again.header(), again.params()), (model.header(), model.params()));
        if model.check_fits(&DAY).is_ok() {
            plays(model.policy(1).as_mut());
        }
    }
});
