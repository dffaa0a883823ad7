//! A trained policy and its file: the weights, a description of them, and their origin.
//!
//! A file is complete in itself: architecture, features and settings are in its header, so the
//! policy runs without the network file that it was trained on. Weights of `gcaps`, `mlp` and
//! `mlp-full` fit networks with one number of vertiports; those of `gcaps-x` and `gcaps-full` fit
//! any number.

use std::collections::BTreeMap;
use std::path::Path;

use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use sha2::{Digest as _, Sha256};
use vertifleet_core::Scenario;
use vertifleet_observe::Observation;
use vertifleet_policy::Policy;

use crate::error::Error;
use crate::gcaps_x::GcapsX;
use crate::header::Header;
use crate::learned::Learned;
use crate::nn;
use crate::tensor_file;

/// Largest weight file, bytes. No weight file of this program comes near this size.
const LIMIT_BYTES: u64 = 512 << 20;
/// Weights that fit any number of vertiports have the same shapes for every number; the layout is
/// made for this one.
const SOME_VERTIPORTS: usize = 2;

/// A trained policy: its header and its parameters.
#[derive(Debug, Clone)]
pub struct Model {
    header: Header,
    net: nn::NeuralNetwork,
    params: Vec<f32>,
}

impl Model {
    /// A model with this header and these parameters.
    ///
    /// # Errors
    /// Returns the rule that is broken if the header is not valid, if a parameter is not finite, or
    /// if their number is not that of the network.
    pub fn new(header: Header, params: Vec<f32>) -> Result<Self, String> {
        let net = header.network_of_layers(SOME_VERTIPORTS)?;
        if params.len() != net.layout().len() {
            return Err(format!(
                "{} weights, but the policy has {}",
                params.len(),
                net.layout().len()
            ));
        }
        match params.iter().position(|value| !value.is_finite()) {
            Some(at) => Err(format!("weight {at} is not a finite number")),
            None => Ok(Self { header, net, params }),
        }
    }

    /// Describes the weights and their origin.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The name of the policy's kind: `gcaps`, `mlp`, `gcaps-x`, `gcaps-full` or `mlp-full`.
    pub fn kind(&self) -> &'static str {
        self.header.policy.name()
    }

    /// The parameters, in the order of the layout.
    pub fn params(&self) -> &[f32] {
        &self.params
    }

    /// The place of each tensor among the parameters.
    pub fn layout(&self) -> &nn::Layout {
        self.net.layout()
    }

    /// The network of layers for a day with `vertiports` vertiports. If the weights fit one number
    /// only, the network is for that number, regardless of `vertiports`.
    ///
    /// # Panics
    /// Panics if the weights fit any number and `vertiports` is 0 or above 4,096.
    pub fn net(&self, vertiports: usize) -> nn::NeuralNetwork {
        match self.header.shape.vertiports {
            Some(_) => self.net.clone(),
            None => self.header.network_of_layers(vertiports).expect("a number of vertiports"),
        }
    }

    /// The weights in the form that passes use.
    pub fn weights(&self) -> nn::Weights {
        self.net.weights(self.params.clone())
    }

    /// A policy that decides by this model. With `most_rolled_out` of 2 or more, `gcaps-x` rolls
    /// that many of its best choices out before it decides; with 1 it decides at once, as the other
    /// kinds always do.
    pub fn policy(&self, most_rolled_out: usize) -> Box<dyn Policy> {
        match self.header.policy.observation() {
            Observation::Priced { .. } => Box::new(GcapsX::new(self, most_rolled_out)),
            Observation::Paper | Observation::Full { .. } => Box::new(Learned::new(self)),
        }
    }

    /// Whether the model can decide on this day.
    ///
    /// # Errors
    /// Returns [`Error::WrongNetwork`] if the day has another number of vertiports than the weights
    /// fit.
    pub fn check_fits(&self, scenario: &Scenario) -> Result<(), Error> {
        let found = scenario.vertiports.len();
        match self.header.shape.vertiports {
            Some(trained) if trained != found => {
                let (network, scenario) = (self.header.network.clone(), scenario.name.clone());
                Err(Error::WrongNetwork { network, trained, scenario, found })
            }
            _ => Ok(()),
        }
    }

    /// The bytes of the weight file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let tensors = self.layout().tensors().iter().map(|tensor| {
            let entries = &self.params[tensor.offset..][..tensor.len()];
            (tensor.name.as_str(), tensor.shape.clone(), entries)
        });
        tensor_file::to_bytes(&self.header, tensors)
    }

    /// SHA-256 of the bytes of the weight file, in hexadecimal digits. It identifies the weights:
    /// it is what `sha256sum` prints for a file that [`write`](Self::write) wrote.
    pub fn sha256(&self) -> String {
        let digest = Sha256::digest(self.to_bytes());
        digest.iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
    }

    /// Writes the weight file, completely or not at all.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be written to.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        Ok(vertifleet_core::write_atomically(path, &self.to_bytes())?)
    }

    /// Reads a weight file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read, is not a weight file, or has other tensors than
    /// the policy that its header names; the error names the difference.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let bytes = vertifleet_core::read_at_most(path, LIMIT_BYTES)?;
        Self::from_bytes(&bytes, &path.display().to_string())
    }

    /// Parses the bytes of a weight file; `origin` names the file in errors.
    ///
    /// # Errors
    /// The same as those of [`read`](Self::read).
    pub fn from_bytes(bytes: &[u8], origin: &str) -> Result<Self, Error> {
        parse(bytes).map_err(|rule| Error::BadWeights { origin: origin.to_owned(), rule })
    }
}

fn parse(bytes: &[u8]) -> Result<Model, String> {
    let header = Header::read(tensor_file::header(bytes)?)?;
    let net = header.network_of_layers(SOME_VERTIPORTS)?;
    // A header may claim more weights than fit in memory, so check first that the file is long
    // enough.
    if net.layout().len() > bytes.len() / 4 {
        return Err(format!("{} weights do not fit in the file", net.layout().len()));
    }
    let file = SafeTensors::deserialize(bytes).map_err(|error| error.to_string())?;
    Model::new(header, params(net.layout(), &file)?)
}

/// The parameters in the layout's order. The error names the tensor that differs from the layout.
fn params(layout: &nn::Layout, file: &SafeTensors<'_>) -> Result<Vec<f32>, String> {
    let mut found: BTreeMap<String, TensorView<'_>> = file.tensors().into_iter().collect();
    let mut params = Vec::with_capacity(layout.len());
    for tensor in layout.tensors() {
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
    match found.keys().next() {
        Some(name) => Err(format!("tensor {name:?} does not belong to this policy")),
        None => Ok(params),
    }
}
