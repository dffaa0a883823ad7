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
    /// The layers of `gcaps` on features whose number does not grow with the network, so no weight depends on the
    /// network's size.
    #[serde(rename = "gcaps-x")]
    GcapsX(GcapsSettings),
}

/// Sizes of a `gcaps` network. P = 2, K = 2 and `L_e` = 1 are fixed (Table 3).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GcapsSettings {
    /// h, the embedding length.
    pub width: usize,
    /// `h_e`, the number of attention heads; it divides the width.
    pub heads: usize,
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

impl Default for GcapsSettings {
    /// The sizes of Table 3.
    fn default() -> Self {
        Self { width: 256, heads: 8 }
    }
}

impl Default for MlpSettings {
    /// With 8 vertiports this is as many weights as the default `gcaps` has, to 0.1 %.
    fn default() -> Self {
        Self { width: 800, layers: 2, value_width: 256 }
    }
}

impl Architecture {
    /// The policy with this name, `gcaps`, `mlp` or `gcaps-x`, with its default sizes.
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

/// Larger sizes can only come from a damaged file, and could ask for more memory than there is.
const MOST: usize = 4096;

pub(crate) fn check_size(name: &str, size: usize) -> Result<(), String> {
    if (1..=MOST).contains(&size) {
        return Ok(());
    }
    Err(format!("{name} must be from 1 to {MOST}, found {size}"))
}
