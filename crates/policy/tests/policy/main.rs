//! What the rules that need no learning promise, on their own and in whole days.

mod known_closures;
mod prices;
mod rollouts;
mod rules;
