//! Reads result files from any bytes. The reader must never panic, and every result that it accepts
//! can be verified, with findings and without a panic.

#![no_main]

use libfuzzer_sys::fuzz_target;
use vertifleet_core::Stop;
use vertifleet_study::evaluation::{ResultFile, verify};

fuzz_target!(|text: &[u8]| {
    let Ok(result) = ResultFile::from_json(text, "any.json") else { return };
    let _ = verify(&result, &Stop::default()).map(|verification| verification.to_string());
});
