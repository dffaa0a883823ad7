//! The policies' kinds and sizes: what a weight file's header says of its network.

use serde::{Deserialize, Serialize};

/// Sizes of the features that a network takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    /// N, the number of vertiports.
    pub vertiports: usize,
    /// Features of a node, 2N + 4.
    pub node_features: usize,
    /// Features of the aircraft, 2N + 2.
    pub aircraft_features: usize,
}

/// A policy's kind and sizes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Architecture {
    /// Graph capsules and attention (§IV, Eq. 18-21).
    Gcaps(GcapsSettings),
    /// The paper's baseline: plain layers on the flattened features.
    Mlp(MlpSettings),
    /// The layers of `gcaps` on features that do not grow with the network, so that no weight depends on its size.
    #[serde(rename = "gcaps-x")]
    GcapsX(GcapsSettings),
}

/// Sizes of a `gcaps` network. P = 2, K = 2 and `L_e` = 1 are fixed (Table 3).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GcapsSettings {
    /// h, the embedding length.
    pub width: usize,
    /// `h_e`, the number of attention heads; divides the width.
    pub heads: usize,
}

/// Sizes of an `mlp` network.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MlpSettings {
    /// Outputs of each layer.
    pub width: usize,
    /// Number of layers before the logits.
    pub layers: usize,
    /// Width of the value head's layer.
    pub value_width: usize,
}

impl Default for GcapsSettings {
    /// Table 3.
    fn default() -> Self {
        Self { width: 256, heads: 8 }
    }
}

impl Default for MlpSettings {
    /// With 8 vertiports as many weights as the default `gcaps`, to 0.1 %.
    fn default() -> Self {
        Self { width: 800, layers: 2, value_width: 256 }
    }
}

impl Architecture {
    /// The policy of that name with its default sizes: `gcaps`, `mlp` or `gcaps-x`.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "gcaps" => Some(Self::Gcaps(GcapsSettings::default())),
            "mlp" => Some(Self::Mlp(MlpSettings::default())),
            "gcaps-x" => Some(Self::GcapsX(GcapsSettings { width: 32, heads: 4 })),
            _ => None,
        }
    }

    /// The policy's name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Gcaps(_) => "gcaps",
            Self::Mlp(_) => "mlp",
            Self::GcapsX(_) => "gcaps-x",
        }
    }
}

/// Sizes beyond these are a damaged file's, and would ask for more memory than there is.
const MOST: usize = 4096;

pub(crate) fn check_size(name: &str, size: usize) -> Result<(), String> {
    if (1..=MOST).contains(&size) {
        return Ok(());
    }
    Err(format!("{name} must be from 1 to {MOST}, found {size}"))
}
