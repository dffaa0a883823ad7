//! The kinds of policies and their sizes, as the header of a weight file states them. A kind is an
//! observation and a network; the table in [`Architecture::parts`] lists both.

use serde::{Deserialize, Serialize};
use vertifleet_core::FeatureScales;
use vertifleet_observe::{Edges, Observation, Shape, Writer};

use crate::nn::network::NeuralNetwork;

/// The kind of a policy, with its sizes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Architecture {
    /// Graph capsules and attention (§IV, Eq. 18-21).
    Gcaps(GcapsSettings),
    /// The paper's baseline: plain layers on the flattened features.
    Mlp(MlpSettings),
    /// The layers of `gcaps` on features whose number does not grow with the network, so no weight
    /// depends on the network's size.
    #[serde(rename = "gcaps-x")]
    GcapsX(GcapsSettings),
    /// The layers of `gcaps` on the full observation, which needs no bid prices; no weight depends
    /// on the network's size.
    #[serde(rename = "gcaps-full")]
    GcapsFull(GcapsSettings),
    /// Plain layers on the full observation, flattened.
    #[serde(rename = "mlp-full")]
    MlpFull(MlpSettings),
}

/// Sizes of a `gcaps` network.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GcapsSettings {
    /// h, the embedding length.
    pub width: usize,
    /// `h_e`, the number of attention heads; it divides the width.
    pub heads: usize,
    /// The relations between the vertiports.
    #[serde(default, skip_serializing_if = "GraphSettings::is_of_the_paper")]
    pub graph: GraphSettings,
    /// Whether `gcaps-x` or `gcaps-full` observes the features of charge too.
    #[serde(default, skip_serializing_if = "is_false")]
    pub charge: bool,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes members by reference")]
fn is_false(flag: &bool) -> bool {
    !flag
}

/// How a `gcaps` network relates the vertiports to each other, and the aircraft. The default is the
/// paper's (Table 3), on the complete graph of the vertiports; the others are alternatives for
/// comparisons.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GraphSettings {
    /// Computes embeddings from the features of vertiports.
    pub encoder: EncoderKind,
    /// P, the highest moment of the graph capsules.
    pub moments: usize,
    /// K, the highest power of the Laplacian; with 0 there is no graph, and with 1 on the complete
    /// graph the layers are those of deep sets.
    pub hops: usize,
    /// `L_e`, the number of layers of the encoder.
    pub layers: usize,
    /// Defines which vertiports are neighbours.
    pub adjacency: Adjacency,
    /// How the Laplacian is computed from the adjacency.
    pub laplacian: Laplacian,
    /// Whether the decoder attends to the vertiports (Eq. 20); without it, it reads their mean.
    pub attention: bool,
}

/// Computes embeddings from the features of vertiports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum EncoderKind {
    /// Graph capsules (Eq. 18 and 19).
    Capsules,
    /// Self-attention of all vertiports (Vaswani et al., 2017), which uses no graph.
    Transformer,
}

/// Defines which vertiports are neighbours: the weight of the edge from one to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Adjacency {
    /// 1 for every pair.
    Complete,
    /// 1 / (1 + flight time in hours), for pairs that can be flown.
    Distance,
    /// 1 / (1 + the distance between the features), as in the code of the paper's authors.
    Similarity,
    /// 1 for every pair that the deciding aircraft's type can fly now.
    Reachable,
    /// The profit per hour of a flight, in hourly profits of a typical full flight, with the
    /// passengers who wait now.
    Profit,
}

/// How the Laplacian is computed from the adjacency A, with the degrees D of A on the diagonal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Laplacian {
    /// (D - A) / N.
    Plain,
    /// I - D^-1 A.
    Normalised,
}

/// Sizes of an `mlp` network.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MlpSettings {
    /// Number of outputs of each layer.
    pub width: usize,
    /// Number of layers before the logits.
    pub layers: usize,
    /// Width of the value head's layer.
    pub value_width: usize,
}

impl GcapsSettings {
    /// A network of the paper with other sizes.
    pub fn of_sizes(width: usize, heads: usize) -> Self {
        Self { width, heads, graph: GraphSettings::default(), charge: false }
    }
}

impl Default for GcapsSettings {
    /// The sizes of Table 3.
    fn default() -> Self {
        Self::of_sizes(256, 8)
    }
}

impl Default for GraphSettings {
    /// Table 3, on the complete graph.
    fn default() -> Self {
        Self {
            encoder: EncoderKind::Capsules,
            moments: 2,
            hops: 2,
            layers: 1,
            adjacency: Adjacency::Complete,
            laplacian: Laplacian::Plain,
            attention: true,
        }
    }
}

impl GraphSettings {
    /// Whether these are the settings of the paper.
    pub fn is_of_the_paper(&self) -> bool {
        *self == Self::default()
    }

    /// Whether the encoder is the paper's, regardless of the decoder.
    pub(crate) fn uses_paper_encoder(&self) -> bool {
        Self { attention: true, ..*self }.is_of_the_paper()
    }

    /// Checks that the sizes are within reasonable bounds.
    ///
    /// # Errors
    /// Returns the rule that is broken.
    pub(crate) fn check(&self) -> Result<(), String> {
        let within = |name: &str, size: usize, low: usize, high: usize| {
            let rule = || format!("{name} must be from {low} to {high}, found {size}");
            (low..=high).contains(&size).then_some(()).ok_or_else(rule)
        };
        within("moments", self.moments, 1, 4)?;
        within("hops", self.hops, 0, 4)?;
        within("layers", self.layers, 1, 8)
    }
}

impl Default for MlpSettings {
    /// With 8 vertiports this is as many weights as the default `gcaps` has, to 0.1 %.
    fn default() -> Self {
        Self { width: 800, layers: 2, value_width: 256 }
    }
}

impl Architecture {
    /// The policy with this name, `gcaps`, `mlp`, `gcaps-x`, `gcaps-full` or `mlp-full`, with its
    /// default sizes.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "gcaps" => Some(Self::Gcaps(GcapsSettings::default())),
            "mlp" => Some(Self::Mlp(MlpSettings::default())),
            "gcaps-x" => Some(Self::GcapsX(GcapsSettings::of_sizes(32, 4))),
            "gcaps-full" => Some(Self::GcapsFull(GcapsSettings::of_sizes(64, 4))),
            "mlp-full" => {
                Some(Self::MlpFull(MlpSettings { width: 256, layers: 2, value_width: 64 }))
            }
            _ => None,
        }
    }

    /// The table of all kinds: name, observation and network.
    fn parts(&self) -> (&'static str, Observation, Layers<'_>) {
        use Layers::{Graph, Plain};
        match self {
            Self::Gcaps(sizes) => ("gcaps", Observation::Paper, Graph(sizes)),
            Self::Mlp(sizes) => ("mlp", Observation::Paper, Plain(sizes)),
            Self::GcapsX(sizes) => {
                ("gcaps-x", Observation::Priced { charge: sizes.charge }, Graph(sizes))
            }
            Self::GcapsFull(sizes) => {
                ("gcaps-full", Observation::Full { charge: sizes.charge }, Graph(sizes))
            }
            Self::MlpFull(sizes) => ("mlp-full", Observation::Full { charge: false }, Plain(sizes)),
        }
    }

    /// The policy's name.
    pub fn name(&self) -> &'static str {
        self.parts().0
    }

    /// The policy's observation.
    pub fn observation(&self) -> Observation {
        self.parts().1
    }

    /// The policy's network.
    pub(crate) fn layers(&self) -> Layers<'_> {
        self.parts().2
    }

    /// The shape of the policy's observation of a day with this number of vertiports.
    pub(crate) fn shape(&self, vertiports: usize) -> Shape {
        self.observation().shape(vertiports)
    }

    /// The weights of edges that the network reads with each observation. Other graphs follow from
    /// the features of the vertiports, or are complete.
    pub fn edges(&self) -> Option<Edges> {
        let Layers::Graph(GcapsSettings { graph, .. }) = self.layers() else { return None };
        match (graph.encoder, graph.adjacency) {
            (EncoderKind::Capsules, Adjacency::Distance) => Some(Edges::Distance),
            (EncoderKind::Capsules, Adjacency::Reachable) => Some(Edges::Reachable),
            (EncoderKind::Capsules, Adjacency::Profit) => Some(Edges::Profit),
            _ => None,
        }
    }

    /// The writer of the policy's observation; `scales` are for the paper's observation.
    pub(crate) fn writer(&self, scales: Option<FeatureScales>) -> Writer {
        Writer::new(self.observation(), scales, self.edges())
    }

    /// The network for this number of vertiports.
    pub(crate) fn network(&self, vertiports: usize) -> NeuralNetwork {
        NeuralNetwork::new(self.clone(), self.shape(vertiports)).expect(
            "sizes were checked when the weights were made, and days have at most 256 vertiports",
        )
    }

    /// Whether the policy can learn by PPO, which needs a value of the present state alone. Every
    /// policy can learn by imitation of roll-outs.
    pub fn learns_by_ppo(&self) -> bool {
        self.observation() == Observation::Paper
    }

    /// Whether the weights fit networks of any size: neither features nor layers grow with it.
    pub fn fits_any_size(&self) -> bool {
        self.observation() != Observation::Paper && matches!(self.layers(), Layers::Graph(_))
    }

    /// Checks that the features of charge are asked for only where the policy can observe them.
    ///
    /// # Errors
    /// Returns the rule that is broken.
    pub(crate) fn check_charge(&self) -> Result<(), String> {
        if matches!(self, Self::Gcaps(GcapsSettings { charge: true, .. })) {
            return Err("must be false for gcaps, whose observation is the paper's".to_owned());
        }
        Ok(())
    }

    /// The same policy without the features of charge.
    pub(crate) fn without_charge(&self) -> Self {
        let mut policy = self.clone();
        if let Self::GcapsX(sizes) | Self::GcapsFull(sizes) = &mut policy {
            sizes.charge = false;
        }
        policy
    }

    /// Checks that the policy's observation contains the graph.
    ///
    /// # Errors
    /// Returns the rule that is broken.
    pub(crate) fn check_graph(&self) -> Result<(), String> {
        if self.edges().is_some() && !self.observation().is_full() {
            let name = self.name();
            return Err(format!(
                "the observation of {name} shows no flights between two other vertiports"
            ));
        }
        Ok(())
    }
}

/// The layers of a policy's network, with their sizes.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Layers<'a> {
    /// Graph capsules and attention.
    Graph(&'a GcapsSettings),
    /// Plain layers.
    Plain(&'a MlpSettings),
}

/// Larger sizes can only come from a damaged file, and could request more memory than there is.
const MOST: usize = 4096;

pub(crate) fn check_size(name: &str, size: usize) -> Result<(), String> {
    if (1..=MOST).contains(&size) {
        return Ok(());
    }
    Err(format!("{name} must be from 1 to {MOST}, found {size}"))
}
