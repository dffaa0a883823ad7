//! Evolution strategies: weights are perturbed at random, whole days are played with them, and they
//! move towards higher profit (T. Salimans, J. Ho, X. Chen, S. Sidor, I. Sutskever, *Evolution
//! strategies as a scalable alternative to reinforcement learning*, 2017).
//!
//! All aircraft decide by the perturbed weights, so a day evaluates a convention of the whole fleet
//! and not a single choice. No choice is credited and no value is learned. The cost is many days: a
//! generation plays each of its days twice for every pair.

mod direction;
mod row;
mod run;
mod settings;

pub use row::EvolutionRow;
pub use settings::EvolutionSettings;
