//! Imports vertiports (CSV, Parquet, GeoJSON) from any bytes. The reader must never panic, and days
//! can be drawn from every network that it makes.

#![no_main]

mod planner_files;

use libfuzzer_sys::fuzz_target;
use planner_files::import_with;

fuzz_target!(|bytes: &[u8]| {
    import_with("vertiports", bytes);
});
