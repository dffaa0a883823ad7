//! The guarantees of the bound, the planner and the rolling horizon.

mod bound;
mod bound_of_rest;
mod designs;
mod energy;
mod exhaustive;
mod known_closures;
mod planner;
mod proof;
mod rolling;
