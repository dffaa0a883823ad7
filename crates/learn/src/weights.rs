//! Weight files: safetensors with a JSON header that says what the weights are of and where they came from.
//!
//! A file stands for itself: architecture, shape and feature scales are in its header, so a policy can be run from it
//! without the network file it was trained on.

use std::collections::BTreeMap;
use std::path::Path;

use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use serde::{Deserialize, Serialize};
use vertifleet_core::{FeatureScales, Scenario};

use crate::error::Error;
use crate::features;
use crate::nn::{self, Architecture, Shape};
use crate::settings::Settings;
use crate::tensor_file;

/// First member of every header.
const FORMAT: &str = "vertifleet-weights/1";
/// No weight file of ours comes near; larger ones are not read.
pub(crate) const LIMIT_BYTES: u64 = 512 << 20;

/// What weights are of and where they came from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    format: String,
    /// Network that the weights were trained on.
    pub network: String,
    /// The policy's kind and sizes.
    pub policy: Architecture,
    /// Number of vertiports and features.
    pub shape: Shape,
    /// What features are divided by.
    pub feature_scales: FeatureScales,
    /// Training settings; none where the weights were trained by another program in a way that these have no words for.
    pub settings: Option<Settings>,
    /// Seed of the training run, where it is known.
    pub seed: Option<u32>,
    /// Commit of the program that trained them.
    pub commit: String,
    /// Decisions learned from when these weights were kept.
    pub steps: u64,
}

/// A trained policy: its header and its parameters.
#[derive(Debug, Clone)]
pub struct Model {
    header: Header,
    net: nn::Network,
    params: Vec<f32>,
}

/// What a model is made of, beside its parameters.
#[derive(Debug, Clone)]
pub struct Origin {
    /// Network that the weights were trained on.
    pub network: String,
    /// What features are divided by.
    pub feature_scales: FeatureScales,
    /// Training settings.
    pub settings: Settings,
    /// Seed of the training run.
    pub seed: u32,
    /// Commit of the program.
    pub commit: String,
}

impl Model {
    /// A model with these parameters.
    ///
    /// # Panics
    /// If the number of parameters is not the network's.
    pub fn new(net: nn::Network, params: Vec<f32>, origin: Origin, steps: u64) -> Self {
        assert_eq!(params.len(), net.layout().len(), "parameters of this network");
        let Origin { network, feature_scales, settings, seed, commit } = origin;
        let header = Header {
            format: FORMAT.to_owned(),
            network,
            policy: net.architecture().clone(),
            shape: net.shape(),
            feature_scales,
            settings: Some(settings),
            seed: Some(seed),
            commit,
            steps,
        };
        Self { header, net, params }
    }

    /// What the weights are of and where they came from.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The network that the parameters are of.
    pub fn net(&self) -> &nn::Network {
        &self.net
    }

    /// The parameters, in the order of the network's layout.
    pub fn params(&self) -> &[f32] {
        &self.params
    }

    /// Whether the model can decide on this day.
    ///
    /// # Errors
    /// [`Error::WrongNetwork`] if the day has another number of vertiports than the weights were trained on.
    pub fn check_fits(&self, scenario: &Scenario) -> Result<(), Error> {
        let trained = self.header.shape.vertiports;
        let found = scenario.vertiports.len();
        if trained == found {
            return Ok(());
        }
        let network = self.header.network.clone();
        Err(Error::WrongNetwork { network, trained, scenario: scenario.name.clone(), found })
    }

    /// The file's bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        to_bytes(&self.header, &self.net, &self.params)
    }

    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// If the folder cannot be written to.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        Ok(vertifleet_core::write_atomically(path, &self.to_bytes())?)
    }

    /// Reads a weight file.
    ///
    /// # Errors
    /// If it cannot be read, is no weight file, or its tensors are not those of the policy its header names; the
    /// error says what differs.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let bytes = vertifleet_core::read_at_most(path, LIMIT_BYTES)?;
        Self::from_bytes(&bytes, &path.display().to_string())
    }

    /// Reads a weight file's bytes; `origin` names them in errors.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_bytes(bytes: &[u8], origin: &str) -> Result<Self, Error> {
        let broken = |rule: String| Error::BadWeights { origin: origin.to_owned(), rule };
        let header: Header =
            tensor_file::header(bytes, FORMAT, |header: &Header| &header.format).map_err(broken)?;
        header.settings.as_ref().map_or(Ok(()), Settings::check)?;
        let net = nn::Network::new(header.policy.clone(), header.shape).map_err(broken)?;
        if header.shape != features::shape(header.shape.vertiports) {
            return Err(broken(format!("{:?} is not the shape of our features", header.shape)));
        }
        // A header may promise more weights than any memory holds; the file has to have them.
        if net.layout().len() > bytes.len() / 4 {
            return Err(broken(format!("{} weights do not fit in the file", net.layout().len())));
        }
        let file = SafeTensors::deserialize(bytes).map_err(|error| broken(error.to_string()))?;
        let params = collect(&net, &file).map_err(broken)?;
        Ok(Self { header, net, params })
    }
}

/// The bytes of a file with this header and a network's parameters.
pub(crate) fn to_bytes(header: &impl Serialize, net: &nn::Network, params: &[f32]) -> Vec<u8> {
    let tensors = net.layout().tensors().iter().map(|tensor| {
        let entries = &params[tensor.offset..][..tensor.len()];
        (tensor.name.as_str(), tensor.shape.clone(), entries)
    });
    tensor_file::to_bytes(header, tensors)
}

/// The parameters in the layout's order; an error says which tensor is not as the layout has it.
pub(crate) fn collect(net: &nn::Network, file: &SafeTensors<'_>) -> Result<Vec<f32>, String> {
    let mut found: BTreeMap<String, TensorView<'_>> = file.tensors().into_iter().collect();
    let mut params = Vec::with_capacity(net.layout().len());
    for tensor in net.layout().tensors() {
        let name = &tensor.name;
        let view =
            found.remove(name.as_str()).ok_or_else(|| format!("tensor {name:?} is missing"))?;
        if view.dtype() != Dtype::F32 || view.shape() != tensor.shape.as_slice() {
            return Err(format!(
                "tensor {name:?} must be F32 of shape {:?}, found {:?} of shape {:?}",
                tensor.shape,
                view.dtype(),
                view.shape(),
            ));
        }
        params.extend(tensor_file::entries(&view));
    }
    if let Some(name) = found.keys().next() {
        return Err(format!("tensor {name:?} does not belong to this policy"));
    }
    match params.iter().position(|value| !value.is_finite()) {
        Some(at) => Err(format!("weight {at} is not a finite number")),
        None => Ok(params),
    }
}
