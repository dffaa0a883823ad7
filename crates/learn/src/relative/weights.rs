//! Weight files of `gcaps-x`: as those of the other policies, but for a shape without a number of vertiports.

use std::path::Path;

use safetensors::tensor::SafeTensors;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::nn::{self, Architecture, Prepared};
use crate::relative::course::Course;
use crate::relative::features::{AIRCRAFT_FEATURES, NODE_FEATURES};
use crate::relative::judge;
use crate::{tensor_file, weights};

/// First member of every header.
const FORMAT: &str = "vertifleet-weights-any/1";
/// Weights have the same shapes for any number of vertiports; the layout is made for this one.
const SOME_VERTIPORTS: usize = 2;

/// What weights are of and where they came from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AnyHeader {
    format: String,
    /// Network whose days the run was for; others were of random networks.
    pub network: String,
    /// The policy's kind and sizes.
    pub policy: Architecture,
    /// Features of a node and of the aircraft; there is no number of vertiports.
    pub shape: AnyShape,
    /// What the weights learned from.
    pub course: Course,
    /// Seed of the training run.
    pub seed: u32,
    /// Commit of the program that trained them.
    pub commit: String,
    /// Decisions learned from.
    pub decisions: u64,
}

/// Sizes of the features, whatever the network.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AnyShape {
    /// F, features of a node.
    pub node_features: usize,
    /// G, features of the aircraft.
    pub aircraft_features: usize,
}

impl AnyShape {
    const OURS: Self = Self { node_features: NODE_FEATURES, aircraft_features: AIRCRAFT_FEATURES };
}

/// What a model comes from.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    pub(crate) network: String,
    pub(crate) course: Course,
    pub(crate) seed: u32,
    pub(crate) commit: String,
}

/// A trained policy for networks of any size.
#[derive(Debug, Clone)]
pub struct AnyModel {
    header: AnyHeader,
    net: nn::Network,
    params: Vec<f32>,
}

impl AnyModel {
    /// A model with these parameters.
    ///
    /// # Panics
    /// If the number of parameters is not the architecture's.
    pub(crate) fn new(
        policy: Architecture,
        params: Vec<f32>,
        Source { network, course, seed, commit }: Source,
        decisions: u64,
    ) -> Self {
        let net = judge::network(&policy, SOME_VERTIPORTS);
        assert_eq!(params.len(), net.layout().len(), "parameters of this network");
        let (format, shape) = (FORMAT.to_owned(), AnyShape::OURS);
        let header = AnyHeader { format, network, policy, shape, course, seed, commit, decisions };
        Self { header, net, params }
    }

    /// What the weights are of and where they came from.
    pub fn header(&self) -> &AnyHeader {
        &self.header
    }

    /// The parameters, in the order of the network's layout.
    pub fn params(&self) -> &[f32] {
        &self.params
    }

    /// The network that the parameters are of, for a number of vertiports.
    ///
    /// # Panics
    /// If there are no vertiports or more than 4,096.
    pub fn net(&self, vertiports: usize) -> nn::Network {
        judge::network(&self.header.policy, vertiports)
    }

    pub(crate) fn architecture(&self) -> &Architecture {
        &self.header.policy
    }

    pub(crate) fn prepared(&self) -> Prepared {
        let mut prepared = self.net.prepared();
        self.net.prepare(&self.params, &mut prepared);
        prepared
    }

    /// The file's bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        weights::to_bytes(&self.header, &self.net, &self.params)
    }

    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// If the folder cannot be written to.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        Ok(vertifleet_core::write_atomically(path, &self.to_bytes())?)
    }

    /// Whether a file's bytes claim to be of this kind.
    pub(crate) fn wrote(bytes: &[u8]) -> bool {
        tensor_file::format(bytes).is_some_and(|format| format == FORMAT)
    }

    /// Reads a weight file.
    ///
    /// # Errors
    /// If it cannot be read, is no weight file of this kind, or its tensors are not those of the policy its header names.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let bytes = vertifleet_core::read_at_most(path, weights::LIMIT_BYTES)?;
        Self::from_bytes(&bytes, &path.display().to_string())
    }

    /// Reads a weight file's bytes; `origin` names them in errors.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_bytes(bytes: &[u8], origin: &str) -> Result<Self, Error> {
        let broken = |rule: String| Error::BadWeights { origin: origin.to_owned(), rule };
        let header: AnyHeader =
            tensor_file::header(bytes, FORMAT, |header: &AnyHeader| &header.format)
                .map_err(broken)?;
        if header.shape != AnyShape::OURS {
            return Err(broken(format!("{:?} is not the shape of our features", header.shape)));
        }
        if !matches!(header.policy, Architecture::GcapsX(_)) {
            return Err(broken(format!("a {:?} fits one network only", header.policy.name())));
        }
        let shape = crate::relative::features::shape(SOME_VERTIPORTS);
        let net = nn::Network::new(header.policy.clone(), shape).map_err(broken)?;
        // A header may promise more weights than any memory holds; the file has to have them.
        if net.layout().len() > bytes.len() / 4 {
            return Err(broken(format!("{} weights do not fit in the file", net.layout().len())));
        }
        let file = SafeTensors::deserialize(bytes).map_err(|error| broken(error.to_string()))?;
        let params = weights::collect(&net, &file).map_err(broken)?;
        Ok(Self { header, net, params })
    }
}
