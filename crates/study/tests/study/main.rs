//! What comparisons, evaluations, sweeps and searches for designs promise.

mod account;
mod evaluations;
mod explain;
mod made_up;
mod report;
mod size;
mod sweep;
