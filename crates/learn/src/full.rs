//! `gcaps-full` and `mlp-full`: policies that see what the forecast and the fleet say, and no bid
//! prices.
//!
//! The features of a vertiport describe what a flight there means to the deciding aircraft, what
//! can be flown from there afterwards, and which other aircraft will be there by then
//! ([`features`]), in numbers that mean the same on every network. So `gcaps-full` has the same
//! weights for any number of vertiports and aircraft, as `gcaps-x` has; `mlp-full` lays the same
//! features side by side and fits one number of vertiports. They learn by
//! [imitation](crate::imitation) of roll-outs: prices help to judge choices while they learn, and
//! are not needed to decide.

mod board;
pub(crate) mod features;
mod observer;
mod policy;
#[cfg(test)]
mod tests;

pub use observer::{FullObservation, FullObserver};
pub use policy::FullPolicy;
