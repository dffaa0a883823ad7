//! The service on bytes that stand in the place of every part of a request: each request is
//! answered, and every day stays one that can be described, played on, and read again from the
//! store as it is in memory.

#![no_main]

use std::sync::{LazyLock, Mutex};

use libfuzzer_sys::fuzz_target;
use vertifleet_serve::AnyRequest;

/// One service for all inputs, since each of them leaves it as it was.
static SERVICE: LazyLock<Mutex<AnyRequest>> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("vertifleet-fuzz-{}", std::process::id()));
    Mutex::new(AnyRequest::open(&folder))
});

fuzz_target!(|bytes: &[u8]| {
    SERVICE.lock().expect("a finding ends the process").send(bytes);
});
