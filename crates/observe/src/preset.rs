//! Observations by name.

use crate::Part;

/// The names of the observations.
pub const PRESETS: [&str; 5] = ["paper", "full", "full-v1", "gcaps-x", "gcaps-full"];

/// The parts of a named observation, or `None` for other names; all of them have the mask:
/// - `paper`: the observation of §IV.A.
/// - `full`: the day until the end of the next demand period, without the charge of batteries.
/// - `full-v1`: every part but the features of learned policies: what the program's rules read.
/// - `gcaps-x`: the observation of that policy.
/// - `gcaps-full`: the observation of `mlp-full`, and of `gcaps-full` on the complete graph.
pub fn preset(name: &str) -> Option<Vec<Part>> {
    let parts = match name {
        "paper" => {
            vec![Part::Nodes, Part::Aircraft, Part::Clock, Part::Adjacency, Part::ActionMask]
        }
        "full" => {
            let new = |part: &Part| part.is_of_a_policy() || part.is_new_in_full_v1();
            Part::all().filter(|part| !new(part)).collect()
        }
        "full-v1" => Part::all().filter(|part| !part.is_of_a_policy()).collect(),
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
