//! Imitation of roll-outs: the decisions of played days are rolled out, and the network learns to
//! make the choice with the highest value in the roll-outs (DAgger: S. Ross, G. Gordon, D. Bagnell,
//! *A reduction of imitation learning and structured prediction to no-regret online learning*,
//! 2011).

mod dataset;
mod row;
mod run;
mod settings;
mod teacher;
mod update;

pub use row::ImitationRow;
pub use settings::ImitationSettings;
