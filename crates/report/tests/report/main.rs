//! What studies and their reports promise.

mod comparison;
mod day;
mod explain;
mod made_up;
mod size;
mod sweep;
