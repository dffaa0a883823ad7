//! Learned policies (§IV): features, the GCAPS and MLP networks, proximal policy optimisation, weights, checkpoints.

#![expect(
    clippy::cast_possible_truncation,
    reason = "networks work in single precision; what is truncated on the way there is meant to be"
)]

mod adam;
mod error;
mod features;
mod gcaps_x;
mod header;
mod imitation;
pub mod kinds;
mod learned;
mod model;
pub mod nn;
mod ppo;
mod run;
mod settings;
mod shipped;
mod tensor_file;

pub use error::Error;
pub use features::{Observations, Scales, shape};
pub use gcaps_x::GcapsX;
pub use header::{FeatureShape, Header};
pub use imitation::{ImitationRow, ImitationSettings};
pub use learned::Learned;
pub use model::Model;
pub use ppo::{PpoRow, PpoSettings, Reward, Schedule};
pub use run::{Curve, RunFolder, TrainingPlan, TrainingRun, TrainingWatch, Work};
pub use settings::TrainingSettings;
pub use shipped::{Shipped, shipped};
