//! Observations by name.

use crate::Part;

/// The names of the observations.
pub const PRESETS: [&str; 4] = ["paper", "full", "gcaps-x", "gcaps-full"];

/// The parts of a named observation: `paper` (§IV.A), `full` (everything that may be seen and needs
/// no bid prices), `gcaps-x` (what that policy sees) or `gcaps-full` (what that policy sees on the
/// complete graph of vertiports alone, and `mlp-full`); `None` for other names. All of them have
/// the mask.
pub fn preset(name: &str) -> Option<Vec<Part>> {
    let parts = match name {
        "paper" => {
            vec![Part::Nodes, Part::Aircraft, Part::Clock, Part::Adjacency, Part::ActionMask]
        }
        "full" => Part::all().filter(|part| !part.is_of_a_policy()).collect(),
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
