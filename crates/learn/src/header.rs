//! The header of a weight file, which describes the weights and their origin.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use vertifleet_core::FeatureScales;

use crate::nn::{self, Architecture, Shape};
use crate::settings::TrainingSettings;

/// The format of weight files.
pub(crate) const FORMAT: &str = "vertifleet-weights/2";

/// The members that every header has besides the format.
const MEMBERS: [&str; 8] =
    ["network", "policy", "shape", "feature_scales", "settings", "seed", "commit", "steps"];

/// Describes weights and their origin.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Header {
    pub(crate) format: &'static str,
    /// The network that the weights were trained on. Weights of `gcaps-x` were trained on random
    /// networks as well.
    pub network: String,
    /// The policy's kind and sizes.
    pub policy: Architecture,
    /// The number of vertiports and the numbers of features.
    pub shape: FeatureShape,
    /// The divisors of the features; `None` for policies whose features are relative to the day.
    pub feature_scales: Option<FeatureScales>,
    /// The training settings; `None` if another program trained the weights in a way that these
    /// settings cannot describe.
    pub settings: Option<TrainingSettings>,
    /// The seed of the training run, if it is known.
    pub seed: Option<u32>,
    /// The commit of the program that trained the weights.
    pub commit: String,
    /// The number of decisions that had been learned from when these weights were kept.
    pub steps: u64,
    /// The [hash](crate::Model::sha256) of the initial weights of the run; `None` if they were
    /// drawn from the seed, or if their origin is unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub begun_with: Option<String>,
}

/// Sizes of the observations of a policy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FeatureShape {
    /// N, the number of vertiports that the weights fit; `None` if they fit any number.
    pub vertiports: Option<usize>,
    /// F, the number of features of a node.
    pub node_features: usize,
    /// G, the number of features of the aircraft.
    pub aircraft_features: usize,
}

impl From<Shape> for FeatureShape {
    /// The shape of weights that fit one number of vertiports.
    fn from(Shape { vertiports, node_features, aircraft_features }: Shape) -> Self {
        Self { vertiports: Some(vertiports), node_features, aircraft_features }
    }
}

/// A header as it stands in the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawHeader {
    network: String,
    policy: Architecture,
    shape: FeatureShape,
    feature_scales: Option<FeatureScales>,
    settings: Option<Value>,
    seed: Option<u32>,
    commit: String,
    steps: u64,
    begun_with: Option<String>,
}

impl Header {
    /// The same header after learning from this many decisions.
    pub(crate) fn after(&self, steps: u64) -> Self {
        Self { steps, ..self.clone() }
    }

    /// Parses the header of a file.
    pub(crate) fn read(mut header: Map<String, Value>) -> Result<Self, String> {
        let format = header.remove("format").unwrap_or_default();
        let format = format.as_str().unwrap_or_default();
        if format != FORMAT {
            return Err(format!("format must be {FORMAT:?}, found {format:?}"));
        }
        // An unknown value must be null; it must not be left out.
        if let Some(missing) = MEMBERS.iter().find(|&&member| !header.contains_key(member)) {
            return Err(format!("header: missing member {missing:?}"));
        }
        let raw: RawHeader =
            serde_json::from_value(header.into()).map_err(|error| format!("header: {error}"))?;
        let settings = raw.settings.map(|value| TrainingSettings::read(&raw.policy, value));
        let header = Self {
            format: FORMAT,
            network: raw.network,
            settings: settings.transpose()?,
            policy: raw.policy,
            shape: raw.shape,
            feature_scales: raw.feature_scales,
            seed: raw.seed,
            commit: raw.commit,
            steps: raw.steps,
            begun_with: raw.begun_with,
        };
        header.check()?;
        Ok(header)
    }

    /// Checks that the shape and the scales fit the kind of policy.
    fn check(&self) -> Result<(), String> {
        self.policy.check_graph()?;
        self.policy.check_charge().map_err(|rule| format!("charge {rule}"))?;
        // Absurd sizes must be refused before any arithmetic with them.
        self.network_of_layers(1)?;
        if self.policy.fits_any_size() == self.shape.vertiports.is_some() {
            let kind = self.policy.name();
            return Err(format!(
                "{kind} and {:?} vertiports do not go together",
                self.shape.vertiports
            ));
        }
        let ours = self.policy.shape(self.shape.vertiports.unwrap_or_default());
        let sizes = (self.shape.node_features, self.shape.aircraft_features);
        if sizes != (ours.node_features, ours.aircraft_features) {
            return Err(format!("{:?} is not the shape of our features", self.shape));
        }
        if self.policy.learns_by_ppo() != self.feature_scales.is_some() {
            return Err("feature_scales are of gcaps and mlp".to_owned());
        }
        Ok(())
    }

    /// The network of layers; `vertiports` counts only if the weights fit any number.
    pub(crate) fn network_of_layers(&self, vertiports: usize) -> Result<nn::NeuralNetwork, String> {
        let FeatureShape { vertiports: fits, node_features, aircraft_features } = self.shape;
        let vertiports = fits.unwrap_or(vertiports);
        let shape = Shape { vertiports, node_features, aircraft_features };
        nn::NeuralNetwork::new(self.policy.clone(), shape)
    }
}
