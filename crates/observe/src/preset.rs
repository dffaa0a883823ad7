//! Observations by name.

use crate::Part;

/// The parts of a named observation: `paper` (§IV.A), `full` (everything that may be seen and needs no bid prices) or
/// `gcaps-x` (what that policy sees); `None` for other names. All of them have the mask.
pub fn preset(name: &str) -> Option<Vec<Part>> {
    let paper = [Part::Nodes, Part::Aircraft, Part::Clock, Part::Adjacency];
    match name {
        "paper" => Some(paper.into_iter().chain([Part::ActionMask]).collect()),
        "full" => {
            Some(Part::all().filter(|part| !paper.contains(part) && !part.is_priced()).collect())
        }
        "gcaps-x" => {
            Some(vec![Part::PricedNodes, Part::PricedAircraft, Part::PricedWorth, Part::ActionMask])
        }
        _ => None,
    }
}
