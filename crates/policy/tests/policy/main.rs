//! The guarantees of the rules that need no learning, for single decisions and in whole days.

mod known_closures;
mod prices;
mod rollouts;
mod rules;
