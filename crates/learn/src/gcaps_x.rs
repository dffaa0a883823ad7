//! `gcaps-x`: bid prices corrected by one network for every size of network.
//!
//! What the paper's networks see grows with the number of vertiports, and so do their weights. Here a node shows what flying
//! there means to the aircraft that decides, in numbers without dimension (`features`), so the graph capsules and the attention of
//! §IV have the same weights for any number of vertiports and aircraft. The network does not decide by itself: the day's bid prices
//! say what each choice is worth, and the network what to add to that (`scorer`). It learns by [imitation](crate::imitation) of
//! roll-outs.

pub(crate) mod features;
mod policy;
mod rollouts;
pub(crate) mod scorer;
#[cfg(test)]
mod tests;

use vertifleet_policy::RolloutSettings;

pub use policy::GcapsX;

/// How `gcaps-x` rolls choices out where it does.
const ROLLOUTS: RolloutSettings =
    RolloutSettings { horizon_s: 7_200, rollouts: 8, noise: 0.06, price_weight: 0.5 };
