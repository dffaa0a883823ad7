//! Reads traces from any bytes. The reader must never panic, accepted traces must read back as
//! written, and the checker must return a verdict on every schedule.

#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use vertifleet_core::Scenario;
use vertifleet_sim::{Trace, check::check};

/// `crates/core/tests/data/small.json`: vertiports and aircraft are named as there.
static DAY: LazyLock<Scenario> = LazyLock::new(|| {
    let text = include_bytes!("../../crates/core/tests/data/small.json");
    Scenario::from_json(text, "small.json").expect("a day within the rules")
});

fuzz_target!(|text: &[u8]| {
    let Ok(trace) = Trace::from_csv(text, &DAY, "any.csv") else { return };
    let written = trace.to_csv(&DAY);
    let again = Trace::from_csv(written.as_bytes(), &DAY, "again").expect("our own text");
    assert_eq!(again, trace);
    assert_eq!(again.to_csv(&DAY), written, "to the last bit");
    let _ = check(&DAY, &trace).to_string();
});
