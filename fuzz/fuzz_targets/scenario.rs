//! Reads scenarios from any bytes. The reader must never panic, and accepted scenarios must read
//! back as written.

#![no_main]

use libfuzzer_sys::fuzz_target;
use vertifleet_core::Scenario;

fuzz_target!(|text: &[u8]| {
    let Ok(scenario) = Scenario::from_json(text, "any.json") else { return };
    let written = scenario.to_json();
    let again = Scenario::from_json(written.as_bytes(), "again").expect("our own text");
    assert_eq!(again, scenario);
    assert_eq!(again.to_json(), written, "to the last bit");
    let _ = scenario.warnings();
    scenario.into_day().check("again").expect("it was accepted before");
});
