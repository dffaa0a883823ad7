//! Reads networks from any text. The reader must never panic, and every day drawn from a network
//! that it accepts must be a valid scenario.

#![no_main]

use libfuzzer_sys::fuzz_target;
use vertifleet_core::{DaySeed, Network};

fuzz_target!(|text: &str| {
    let Ok(network) = Network::from_toml(text, "any.toml") else { return };
    let day = network.draw(DaySeed::comparison(1).expect("a small seed"));
    day.into_day().check("drawn").expect("a network draws valid days only");
});
