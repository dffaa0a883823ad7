//! Proximal policy optimisation, for the policies that fit one number of vertiports.

mod advantage;
mod buffer;
mod row;
mod run;
mod settings;
mod update;

pub use row::PpoRow;
pub use settings::{LearningRateSchedule, PpoSettings, Reward};
