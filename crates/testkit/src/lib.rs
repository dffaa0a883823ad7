//! Shared helpers of the tests of several crates. Most are days: strategies for property tests,
//! days drawn from a number, and days of `paper`. For the tests of the service there are a database
//! server and corrupted texts.
//!
//! This crate builds on `vertifleet-core` alone and is a dependency of tests only.
//!
//! ```
//! use vertifleet_testkit::{Size, any_day};
//!
//! let tiny = Size { vertiports: 3, fleet: 3, hours: 2 };
//! assert!(any_day(7, tiny).vertiports.len() <= 3);
//! ```

mod any_energy_day;
mod any_extended_day;
mod any_small_day;
mod numbered_days;
#[cfg(unix)]
mod postgres;
mod spoilt;

use std::sync::Arc;

use vertifleet_core::{DaySeed, Network, Scenario};

pub use any_energy_day::{
    any_energy_day, any_extreme_energy_day, energy_day, extreme_energy_day, with_energy,
};
pub use any_extended_day::extended_day;
pub use any_small_day::small_day;
pub use numbered_days::{Size, any_day, any_extended_day};
#[cfg(unix)]
pub use postgres::Postgres;
pub use spoilt::{draw, spoilt};

/// A validation day of the network `paper`.
///
/// # Panics
/// Panics if there is no validation day with this number.
pub fn paper_day(seed: u64) -> Arc<Scenario> {
    let network = Network::shipped("paper").expect("a shipped network");
    Arc::new(network.draw(DaySeed::validation(seed).expect("a seed of validation")))
}
