//! What the networks and their training promise.

mod evolution;
mod nn_properties;
mod nn_reference;
mod support;
mod training;
