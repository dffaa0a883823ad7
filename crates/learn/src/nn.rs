//! The policies' networks, forward and backward: pure functions of slices, no simulator, no randomness but the first
//! weights'.
//!
//! All of a network's weights are one flat vector that a [`Layout`] describes, so the optimiser, clipping and files
//! need to know no layer. A [`NeuralNetwork`] is immutable and shared; what a pass needs is a [`Workspace`], allocated once
//! for the largest batch. Everything here runs on one thread: callers cut batches into chunks, one workspace and
//! [`Gradient`] each, and add the gradients up in a fixed order.

mod architecture;
mod batch;
mod gcaps;
mod init;
mod layer_norm;
mod layout;
mod linear;
mod mlp;
mod network;
mod product;
mod relu;
#[cfg(test)]
mod slope_tests;
mod value_head;

pub use architecture::{Architecture, GcapsSettings, MlpSettings, Shape};
pub use batch::{Inputs, Slopes};
pub use layout::{Layout, Tensor};
pub use network::{Gradient, NeuralNetwork, Weights, Workspace};
