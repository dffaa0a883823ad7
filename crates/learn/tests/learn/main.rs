//! Tests of the networks and their training.

mod evolution;
mod nn_properties;
mod nn_reference;
mod support;
mod training;
