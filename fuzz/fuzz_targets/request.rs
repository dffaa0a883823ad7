//! Sends bytes to the service in place of every part of a request. Each request must be answered.
//! Every day must stay valid: it can be described, played on, and read from the store in the state
//! in memory.

#![no_main]

use std::sync::{LazyLock, Mutex};

use libfuzzer_sys::fuzz_target;
use vertifleet_serve::AnyRequest;

/// One service for all inputs, since each of them leaves it unchanged.
static SERVICE: LazyLock<Mutex<AnyRequest>> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("vertifleet-fuzz-{}", std::process::id()));
    Mutex::new(AnyRequest::open(&folder))
});

fuzz_target!(|bytes: &[u8]| {
    SERVICE.lock().expect("a finding ends the process").send(bytes);
});
