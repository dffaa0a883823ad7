//! The policies' networks of layers, forward and backward: pure functions of slices, without the
//! simulator and without randomness except for the first weights.
//!
//! All weights of a network are one flat vector that a [`Layout`] describes, so the optimiser, the
//! clipping and the files do not depend on the layers. A [`NeuralNetwork`] is immutable and shared;
//! a pass works in a [`Workspace`], which is allocated once for the largest batch. Everything here
//! runs on one thread: callers split batches into chunks, give each a workspace and a [`Gradient`],
//! and add the gradients up in a fixed order.

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

pub use architecture::{
    Adjacency, Architecture, EncoderKind, GcapsSettings, GraphSettings, Laplacian, MlpSettings,
};
pub(crate) use batch::maximum;
pub use batch::{Inputs, Slopes};
pub use layout::{Layout, Tensor};
pub use network::{Gradient, NeuralNetwork, Weights, Workspace};
pub use vertifleet_observe::Shape;
