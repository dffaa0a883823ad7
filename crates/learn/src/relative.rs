//! `gcaps-x`: one network for every size of network (design §5).
//!
//! What the paper's networks see grows with the number of vertiports, and so do their weights. Here a node shows what flying
//! there means to the aircraft that decides, in numbers without dimension ([`features`]), so the graph capsules and the
//! attention of §IV have the same weights for any number of vertiports and aircraft. The network does not begin from nothing:
//! the day's prices say what each choice is worth, and the network what to add to that ([`judge`]). It learns from trying
//! choices out ([`lessons`], [`fit`]).

mod checkpoint;
mod course;
mod features;
mod fit;
mod judge;
mod lessons;
mod policy;
mod rollouts;
#[cfg(test)]
mod tests;
mod training;
mod weights;

pub use course::Course;
pub use policy::GcapsX;
pub use training::{Plan, Round, Study};
pub use weights::{AnyHeader, AnyModel, AnyShape};
