//! `gcaps-x`: bid prices corrected by one network of layers, which serves networks of every size.
//!
//! The features of `gcaps` and `mlp` grow with the number of vertiports, and so do their weights.
//! Here the features of a node describe what a flight to that vertiport means to the deciding
//! aircraft, in dimensionless numbers (`features`), so the graph capsules and the attention of §IV
//! have the same weights for any number of vertiports and aircraft. The network does not decide by
//! itself: the day's bid prices say what each choice is worth, and the network says what to add to
//! that (`scorer`). It learns by [imitation](crate::imitation) of roll-outs.

pub(crate) mod features;
mod observer;
mod policy;
pub(crate) mod scorer;
#[cfg(test)]
mod tests;

#[cfg(test)]
pub(crate) use tests::{first_column, played, with_opinions};
use vertifleet_policy::RolloutSettings;

pub use observer::{PricedObservation, PricedObserver};
pub use policy::GcapsX;

/// The settings of the roll-outs that `gcaps-x` learns from, and of its own, if its choices are
/// rolled out at all.
pub(crate) const ROLLOUTS: RolloutSettings =
    RolloutSettings { horizon_s: 7_200, rollouts: 8, noise: 0.06, price_weight: 0.5 };
