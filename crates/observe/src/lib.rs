//! Observations of decisions, as arrays.
//!
//! An observation consists of [parts](Part), each with a name, a shape, a unit and a scale. A
//! [`Layout`] puts the requested parts side by side in one row of numbers, and fills it without
//! allocating memory. Everything in a row comes from a [`View`](vertifleet_sim::View), so it
//! contains only information that is available at the decision.
//!
//! Learned policies decide by some of these numbers. A [`Writer`] writes an [`Observation`] in the
//! form in which their networks read it.
//!
//! ```
//! use std::sync::Arc;
//!
//! use vertifleet_core::{DaySeed, Network};
//! use vertifleet_observe::{Layout, Observer, Part, Scene, Sizes};
//! use vertifleet_sim::Simulation;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let network = Network::find("paper")?;
//! let layout = Layout::new(vec![Part::DemandLeft, Part::ActionMask], Sizes::of(&network));
//! let mut day = Simulation::new(Arc::new(network.draw(DaySeed::comparison(1)?)));
//! let decision = day.next_decision().ok_or("a day begins with a decision")?;
//! let mut row = vec![0.0; layout.width()];
//! layout.write(&mut row, &Scene::of(day.view(), &decision), &mut Observer::of(&network));
//! let [demand, mask] = [&row[..64], &row[64..]];
//! assert!(demand.iter().sum::<f32>() > 0.0);
//! assert_eq!(mask[decision.at.at()], 1.0);
//! # Ok(())
//! # }
//! ```

#![expect(
    clippy::cast_possible_truncation,
    reason = "observations are in single precision; what is truncated on the way there is meant to be"
)]

mod board;
mod charge;
mod column;
mod full;
mod layout;
mod observation;
mod observer;
mod pairs;
mod paper;
mod part;
mod preset;
mod priced;
mod scene;
mod sizes;
mod write;

pub use full::Edges;
pub use layout::{Layout, Placed, write_in_units};
pub use observation::{Observation, Row, Shape, Writer};
pub use observer::Observer;
pub use part::{Axis, Info, Part};
pub use preset::{PRESETS, preset};
pub use priced::{LOGITS_A_UNIT, PricedDecision};
pub use scene::Scene;
pub use sizes::Sizes;
