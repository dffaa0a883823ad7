//! Whether the days of a study come from a shipped network, or from a network that only has the
//! name of one.
//!
//! Users who want more aircraft copy `networks/paper.toml`, change a number and leave the name as
//! it is. What is known about the shipped network, above all the published figures, then says
//! nothing about the copy.

use std::sync::Arc;

use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};
use vertifleet_core::{Network, Scenario};

/// The origin of the network of some days.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NetworkOrigin {
    /// The program ships the network.
    Shipped,
    /// The program ships a network with this name, but draws other days from it.
    Changed,
    /// The program ships no network with this name.
    Own,
}

impl NetworkOrigin {
    /// The origin of the network with this name, judged by days that are said to come from it.
    pub fn of<'a>(network: &str, days: impl IntoIterator<Item = &'a Scenario>) -> Self {
        match Network::shipped(network) {
            None => Self::Own,
            Some(shipped) if days.into_iter().all(|day| shipped.draws(day)) => Self::Shipped,
            Some(_) => Self::Changed,
        }
    }

    /// Like [`of`](Self::of), for many days and on all threads.
    pub(crate) fn of_all(network: &str, days: &[Arc<Scenario>]) -> Self {
        match Network::shipped(network) {
            None => Self::Own,
            Some(shipped) if days.par_iter().all(|day| shipped.draws(day)) => Self::Shipped,
            Some(_) => Self::Changed,
        }
    }

    /// The origin of all days together, if some have this origin and some the other.
    pub(crate) fn with(self, other: Self) -> Self {
        if self == other { self } else { Self::Changed }
    }
}

/// The name of the network that a day was drawn from: `paper` for `paper-7`.
pub(crate) fn network_of(scenario: &Scenario) -> &str {
    scenario.name.strip_suffix(&format!("-{}", scenario.seed)).unwrap_or(&scenario.name)
}

#[cfg(test)]
mod tests {
    use vertifleet_core::{DaySeed, Network};

    use super::NetworkOrigin;

    #[test]
    fn a_copy_is_the_shipped_network_until_a_number_of_it_changes() {
        let text = include_str!("../../../networks/paper.toml");
        let origin = |text: &str| {
            let network = Network::from_toml(text, "a copy").expect("a network");
            let day = network.draw(DaySeed::comparison(7).expect("a seed"));
            NetworkOrigin::of(network.name(), [&day])
        };
        assert_eq!(origin(text), NetworkOrigin::Shipped);
        assert_eq!(origin(&format!("{text}\n# a remark\n")), NetworkOrigin::Shipped);
        let more_stands = text.replace("stands = 6", "stands = 7");
        assert_ne!(more_stands, text);
        assert_eq!(origin(&more_stands), NetworkOrigin::Changed);
        let renamed = text.replace("name = \"paper\"", "name = \"mine\"");
        assert_ne!(renamed, text);
        assert_eq!(origin(&renamed), NetworkOrigin::Own);
    }
}
