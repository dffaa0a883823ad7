//! Observations by name.

use crate::Part;

/// The names of the observations.
pub const PRESETS: [&str; 4] = ["paper", "full", "gcaps-x", "gcaps-full"];

/// The parts of a named observation, or `None` for other names; all of them have the mask:
/// - `paper`: the observation of §IV.A.
/// - `full`: every part that needs no bid prices, except for the charge of batteries.
/// - `gcaps-x`: the observation of that policy.
/// - `gcaps-full`: the observation of `mlp-full`, and of `gcaps-full` on the complete graph.
pub fn preset(name: &str) -> Option<Vec<Part>> {
    let parts = match name {
        "paper" => {
            vec![Part::Nodes, Part::Aircraft, Part::Clock, Part::Adjacency, Part::ActionMask]
        }
        "full" => {
            Part::all().filter(|part| !part.is_of_a_policy() && !part.is_of_charge()).collect()
        }
        "gcaps-x" => {
            vec![Part::PricedNodes, Part::PricedAircraft, Part::PricedWorth, Part::ActionMask]
        }
        "gcaps-full" => vec![
            Part::FullNodes,
            Part::FullAircraft,
            Part::Clock,
            Part::VertiportMask,
            Part::ActionMask,
        ],
        _ => return None,
    };
    Some(parts)
}
