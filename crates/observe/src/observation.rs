//! The observations of learned policies, in the form in which their networks read them.

use vertifleet_core::FeatureScales;
use vertifleet_policy::{DayPrices, PricedChoice};
use vertifleet_sim::{Decision, View};

use crate::full::Edges;
use crate::paper::Scales;
use crate::priced::PricedDecision;
use crate::{charge, column, full, paper, priced};

/// The observations of learned policies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Observation {
    /// The paper's (§IV.A): the present alone, divided by the scales of the network file.
    Paper,
    /// The day with its bid prices.
    Priced {
        /// Whether the features of charge come after the others.
        charge: bool,
    },
    /// The forecast and the fleet, without prices.
    Full {
        /// Whether the features of charge come after the others.
        charge: bool,
    },
}

/// The sizes of a network's features.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    /// N, the number of vertiports.
    pub vertiports: usize,
    /// F, the number of features of a node; 2N + 4 in the paper's observation.
    pub node_features: usize,
    /// G, the number of features of the aircraft; 2N + 2 in the paper's observation.
    pub aircraft_features: usize,
}

impl Observation {
    /// The shape of the features of a day with this number of vertiports.
    pub const fn shape(self, vertiports: usize) -> Shape {
        let (node_features, aircraft_features) = match self {
            Self::Paper => (2 * vertiports + 4, 2 * vertiports + 2),
            Self::Priced { charge } => {
                with_charge(priced::NODES.len(), priced::AIRCRAFT.len(), charge)
            }
            Self::Full { charge } => with_charge(full::NODES.len(), full::AIRCRAFT.len(), charge),
        };
        Shape { vertiports, node_features, aircraft_features }
    }

    /// The names of the features of a vertiport, and of those of the aircraft, in their order.
    /// Those of the paper have no names: most of them concern another vertiport each.
    pub fn names(self) -> [Vec<&'static str>; 2] {
        let (mut names, has_charge) = match self {
            Self::Paper => return [Vec::new(), Vec::new()],
            Self::Priced { charge } => {
                ([column::names(&priced::NODES), column::names(&priced::AIRCRAFT)], charge)
            }
            Self::Full { charge } => {
                ([column::names(&full::NODES), column::names(&full::AIRCRAFT)], charge)
            }
        };
        if has_charge {
            names[0].extend(column::names(&charge::NODES));
            names[1].extend(column::names(&charge::AIRCRAFT));
        }
        names
    }

    /// Whether bid prices are part of the observation.
    pub const fn is_priced(self) -> bool {
        matches!(self, Self::Priced { .. })
    }

    /// Whether the observation is that of policies without bid prices on any network.
    pub const fn is_full(self) -> bool {
        matches!(self, Self::Full { .. })
    }

    /// Whether the features of charge are part of the observation.
    const fn has_charge(self) -> bool {
        matches!(self, Self::Priced { charge: true } | Self::Full { charge: true })
    }
}

const fn with_charge(nodes: usize, aircraft: usize, charge: bool) -> (usize, usize) {
    if charge {
        return (nodes + charge::NODES.len(), aircraft + charge::AIRCRAFT.len());
    }
    (nodes, aircraft)
}

/// A row that is being written; initially all zeros.
pub struct Row<'a> {
    /// Node features [N x F].
    pub nodes: &'a mut [f32],
    /// Aircraft features `[G]`.
    pub aircraft: &'a mut [f32],
    /// 1 for each vertiport that may be chosen `[N]`.
    pub mask: &'a mut [u8],
    /// Weights of edges [N x N], or none.
    pub edges: &'a mut [f32],
    /// Share of the day that is left.
    pub clock: &'a mut f32,
}

/// Writes the observation of one kind of policy. It caches values of recent days.
#[derive(Debug, Clone)]
pub struct Writer {
    eye: Eye,
    /// The observation, whose number of features a row has.
    observation: Observation,
}

#[derive(Debug, Clone)]
enum Eye {
    Paper(Scales),
    Priced(priced::Eye),
    Full(full::Eye, Option<Edges>),
}

impl Writer {
    /// A writer of an observation; `scales` belong to the paper's, and `edges` to the full one.
    ///
    /// # Panics
    /// Panics if the paper's observation has no scales.
    pub fn new(
        observation: Observation,
        scales: Option<FeatureScales>,
        edges: Option<Edges>,
    ) -> Self {
        let eye = match observation {
            Observation::Paper => {
                Eye::Paper(Scales::from(scales.expect("the paper's observation has scales")))
            }
            Observation::Priced { .. } => Eye::Priced(priced::Eye::default()),
            Observation::Full { .. } => Eye::Full(full::Eye::default(), edges),
        };
        Self { eye, observation }
    }

    /// Writes the row of a decision. `priced` has the day's prices and the choices that the network
    /// decides between, the best first; only the observation at prices needs them.
    ///
    /// # Panics
    /// Panics if the row has another shape, or if prices are missing.
    pub fn write<'a>(
        &mut self,
        view: View<'a>,
        decision: &'a Decision,
        priced: Option<(&'a DayPrices, &'a [PricedChoice])>,
        row: &mut Row<'_>,
    ) {
        let feasible = view.feasible(decision);
        let stride = self.observation.shape(view.vertiports()).node_features;
        if self.observation.has_charge() {
            charge::write_nodes(view, decision, stride, row.nodes);
            charge::write_aircraft(view, decision, row.aircraft);
        }
        match &mut self.eye {
            Eye::Paper(scales) => {
                scales.write_nodes(row.nodes, view);
                scales.write_aircraft(row.aircraft, decision, view);
                *row.clock = paper::clock(view, decision);
            }
            Eye::Priced(eye) => {
                let (of_day, listed) = priced.expect("the observation is made at prices");
                let look = eye.look(PricedDecision::of(view, decision, of_day), listed);
                look.write_nodes(stride, row.nodes);
                look.write_aircraft(&mut row.aircraft[..priced::AIRCRAFT.len()]);
                for choice in listed {
                    row.mask[choice.to.at()] = 1;
                }
                // Only the value head reads the clock, and `gcaps-x` does not use the value head.
                return;
            }
            Eye::Full(eye, edges) => {
                let look = eye.look(view, decision, feasible);
                look.write_nodes(stride, row.nodes);
                look.write_aircraft(&mut row.aircraft[..full::AIRCRAFT.len()]);
                if let Some(edges) = *edges {
                    look.write_edges(edges, view.vertiports(), row.edges);
                }
                *row.clock = column::day_left(view, decision.time) as f32;
            }
        }
        feasible.iter().for_each(|at| row.mask[at.at()] = 1);
    }
}
