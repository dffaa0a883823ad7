//! The kinds of policies and their sizes, as the header of a weight file states them.

use serde::{Deserialize, Serialize};

/// The sizes of a network's features.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    /// N, the number of vertiports.
    pub vertiports: usize,
    /// F, the number of features of a node; 2N + 4 for `gcaps` and `mlp`.
    pub node_features: usize,
    /// G, the number of features of the aircraft; 2N + 2 for `gcaps` and `mlp`.
    pub aircraft_features: usize,
}

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
    /// How the vertiports are related to each other.
    #[serde(default, skip_serializing_if = "GraphSettings::is_of_the_paper")]
    pub graph: GraphSettings,
}

/// How a `gcaps` network relates the vertiports to each other, and the aircraft. The default is the
/// paper's (Table 3), on the complete graph of the vertiports; the others are what it can be
/// compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GraphSettings {
    /// What makes embeddings of the features of vertiports.
    pub encoder: EncoderKind,
    /// P, the highest moment of the graph capsules.
    pub moments: usize,
    /// K, the highest power of the Laplacian; with 0 there is no graph, and with 1 on the complete
    /// graph the layers are those of deep sets.
    pub hops: usize,
    /// `L_e`, the number of layers of the encoder.
    pub layers: usize,
    /// What makes vertiports neighbours.
    pub adjacency: Adjacency,
    /// How the Laplacian follows from the adjacency.
    pub laplacian: Laplacian,
    /// Whether the decoder attends to the vertiports (Eq. 20); without it, it reads their mean.
    pub attention: bool,
}

/// What makes embeddings of the features of vertiports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum EncoderKind {
    /// Graph capsules (Eq. 18 and 19).
    Capsules,
    /// Self-attention of all vertiports (Vaswani et al., 2017), which knows no graph.
    Transformer,
}

/// What makes vertiports neighbours: the weight of the edge from one to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Adjacency {
    /// 1 for every pair.
    Complete,
    /// 1 / (1 + flight time in hours), for pairs that can be flown.
    Distance,
    /// 1 / (1 + the distance between the features), as the code of the paper's authors has it.
    Similarity,
    /// 1 for every pair that the deciding aircraft's type can fly now.
    Reachable,
    /// The profit per hour of a flight, in hourly profits of a typical full flight, with the
    /// passengers who wait now.
    Profit,
}

/// How the Laplacian follows from the adjacency A, with the degrees D of A on the diagonal.
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
        Self { width, heads, graph: GraphSettings::default() }
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

    /// Whether the encoder is the paper's, whatever the decoder is.
    pub(crate) fn uses_paper_encoder(&self) -> bool {
        Self { attention: true, ..*self }.is_of_the_paper()
    }

    fn adjacency_in_use(&self) -> Adjacency {
        match self.encoder {
            EncoderKind::Capsules => self.adjacency,
            EncoderKind::Transformer => Adjacency::Complete,
        }
    }

    /// Checks that the sizes are such as can be meant.
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

impl Adjacency {
    /// Whether the weights come with the observation, and do not follow from the features of the
    /// vertiports.
    pub fn is_observed(self) -> bool {
        matches!(self, Self::Distance | Self::Reachable | Self::Profit)
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

    /// What makes vertiports neighbours; every vertiport is that of every other where there is no
    /// graph.
    pub fn adjacency(&self) -> Adjacency {
        match self {
            Self::Gcaps(settings) | Self::GcapsX(settings) | Self::GcapsFull(settings) => {
                settings.graph.adjacency_in_use()
            }
            Self::Mlp(_) | Self::MlpFull(_) => Adjacency::Complete,
        }
    }

    /// Whether the weights fit networks of any size.
    pub fn fits_any_size(&self) -> bool {
        matches!(self, Self::GcapsX(_) | Self::GcapsFull(_))
    }

    /// Checks that the graph is one that the policy's observation shows.
    ///
    /// # Errors
    /// Returns the rule that is broken.
    pub(crate) fn check_graph(&self) -> Result<(), String> {
        let name = self.name();
        if matches!(self, Self::GcapsFull(_)) {
            Ok(())
        } else if self.adjacency().is_observed() {
            Err(format!("the observation of {name} shows no flights between two other vertiports"))
        } else {
            Ok(())
        }
    }

    /// Whether the policy decides by the day's bid prices and its network.
    pub fn sees_prices(&self) -> bool {
        matches!(self, Self::GcapsX(_))
    }

    /// Whether the policy's observation shows what the forecast says; that of the paper shows the
    /// present alone.
    pub fn sees_the_forecast(&self) -> bool {
        !matches!(self, Self::Gcaps(_) | Self::Mlp(_))
    }

    /// Whether the policy can learn by PPO. Every policy can learn by imitation of roll-outs.
    pub fn learns_by_ppo(&self) -> bool {
        matches!(self, Self::Gcaps(_) | Self::Mlp(_))
    }

    /// The policy's name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Gcaps(_) => "gcaps",
            Self::Mlp(_) => "mlp",
            Self::GcapsX(_) => "gcaps-x",
            Self::GcapsFull(_) => "gcaps-full",
            Self::MlpFull(_) => "mlp-full",
        }
    }
}

/// Larger sizes can only come from a damaged file, and could ask for more memory than there is.
const MOST: usize = 4096;

pub(crate) fn check_size(name: &str, size: usize) -> Result<(), String> {
    if (1..=MOST).contains(&size) {
        return Ok(());
    }
    Err(format!("{name} must be from 1 to {MOST}, found {size}"))
}
