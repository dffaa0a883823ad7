//! The [`Policy`] trait, the policies that need no learning, and how a day is played with one.
//!
//! This crate builds on `vertifleet-sim`. A policy sees a day only through a `View`. [`Greedy`] is
//! a rule, [`BidPricePolicy`] decides by [`DayPrices`], and a [`RolloutEvaluator`] evaluates
//! choices by roll-outs.
//!
//! ```
//! use std::sync::Arc;
//!
//! use vertifleet_core::{DaySeed, Network};
//! use vertifleet_policy::{Greedy, play};
//! use vertifleet_sim::Simulation;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let day = Network::find("paper")?.draw(DaySeed::comparison(1)?);
//! let mut simulation = Simulation::new(Arc::new(day));
//! play(&mut simulation, &mut Greedy, |row| assert!(row.passengers <= 4))?;
//! assert!(simulation.ledger().profit_usd() > 30_000.0);
//! # Ok(())
//! # }
//! ```

mod bid_prices;
mod draw;
mod greedy;
mod play;
mod policy;
mod price_memory;
mod prices;
mod random;
mod replay;
mod rollouts;
mod shortlist;
mod stoppable;

pub use bid_prices::BidPricePolicy;
pub use draw::draw;
pub use greedy::Greedy;
pub use play::{PlayError, play};
pub use policy::{Policy, PolicyError};
pub use price_memory::PriceMemory;
pub use prices::{Choices, DayPrices, PricedChoice, units_usd};
pub use random::Random;
pub use replay::Replay;
pub use rollouts::{RolloutEvaluator, RolloutSettings, fleet_worth_usd};
pub use shortlist::Shortlist;
pub use stoppable::Stoppable;
