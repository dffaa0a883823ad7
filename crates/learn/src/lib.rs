//! Learned policies (§IV): networks of layers, the three ways to learn, weights, checkpoints, and
//! the shipped models.
//!
//! This crate builds on `vertifleet-observe`. A [`Model`] contains a policy's weights and their
//! origin. A [`TrainingRequest`] starts a [`TrainingRun`], which learns by PPO, by imitation of
//! roll-outs or by evolution. A [`RunFolder`] writes the files of a run.
//!
//! ```
//! use std::sync::Arc;
//!
//! use vertifleet_core::{DaySeed, Network};
//! use vertifleet_learn::shipped;
//! use vertifleet_policy::play;
//! use vertifleet_sim::Simulation;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let model = shipped("gcaps-x", "paper")?.model;
//! let day = Network::find("paper")?.draw(DaySeed::comparison(1)?);
//! let mut simulation = Simulation::new(Arc::new(day));
//! play(&mut simulation, model.policy(1).as_mut(), |_| ())?;
//! assert!(simulation.ledger().profit_usd() > 36_000.0);
//! # Ok(())
//! # }
//! ```
//!
//! Training, one update at a time:
//!
//! ```
//! use vertifleet_core::{Stop, World};
//! use vertifleet_learn::nn::Architecture;
//! use vertifleet_learn::{TrainingRequest, TrainingSettings};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let policy = Architecture::named("mlp").ok_or("a kind of policy")?;
//! let mut settings = TrainingSettings::preset(&policy, "default")?;
//! settings.set([("total_steps", "200"), ("n_envs", "4"), ("n_steps", "25"), ("batch_size", "100"), ("eval_days", "1")])?;
//! let world = World::find("paper")?;
//! let request = TrainingRequest { world, policy, settings, seed: 1, begin_with: None, commit: String::new() };
//! let mut run = request.start()?;
//! while !run.is_done() {
//!     run.advance(&Stop::default(), &|_| ())?;
//! }
//! assert_eq!(run.curve().steps(), 200);
//! # Ok(())
//! # }
//! ```

#![expect(
    clippy::cast_possible_truncation,
    reason = "networks work in single precision; what is truncated on the way there is meant to be"
)]

mod adam;
mod error;
mod evolution;
mod gcaps_x;
#[cfg(test)]
mod gcaps_x_tests;
mod header;
mod imitation;
pub mod kinds;
mod learned;
#[cfg(test)]
mod learned_tests;
mod lockstep;
mod model;
pub mod nn;
mod ppo;
mod rollouts;
mod rows;
mod run;
mod scorer;
mod settings;
mod shipped;
mod tensor_file;
mod validation;

pub use error::Error;
pub use evolution::{EvolutionRow, EvolutionSettings};
pub use gcaps_x::GcapsX;
pub use header::{FeatureShape, Header};
pub use imitation::{ImitationRow, ImitationSettings};
pub use learned::Learned;
pub use model::Model;
pub use ppo::{LearningRateSchedule, PpoRow, PpoSettings, Reward};
pub use run::{Cell, Curve, RunFolder, TrainingRequest, TrainingRun, TrainingWatch, Work, sizes};
pub use settings::{TrainingSettings, set};
pub use shipped::{Shipped, shipped};
pub use vertifleet_observe::Observation;
