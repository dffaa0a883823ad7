//! Learned policies (§IV): features, the GCAPS and MLP networks, proximal policy optimisation, weights, checkpoints.

#![expect(
    clippy::cast_possible_truncation,
    reason = "networks work in single precision; what is truncated on the way there is meant to be"
)]

mod adam;
mod advantage;
mod any_weights;
mod checkpoint;
mod curve;
mod curve_files;
mod error;
mod features;
pub mod kinds;
mod learned;
pub mod nn;
mod ppo;
pub mod relative;
mod rollout;
mod settings;
mod shipped;
mod tensor_file;
mod train;
mod weights;

pub use any_weights::Weights;
pub use checkpoint::Checkpoint;
pub use curve::{CurveRow, EventFile, to_csv};
pub use curve_files::{curve_beside, read_curves};
pub use error::Error;
pub use features::{Observations, Scales, shape};
pub use learned::Learned;
pub use settings::{Reward, Schedule, Settings};
pub use shipped::{Trained, TrainedAny, shipped, shipped_any};
pub use train::{Plan, Training};
pub use weights::{Header, Model, Origin};
