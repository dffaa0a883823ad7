//! A trained policy: its weights, what they are of and where they came from; and the file that holds all of that.
//!
//! A file stands for itself: architecture, features and settings are in its header, so a policy can be run from it without the
//! network file it was trained on. Weights of `gcaps` and `mlp` fit networks with one number of vertiports, those of `gcaps-x` fit
//! any.

use std::collections::BTreeMap;
use std::path::Path;

use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use vertifleet_core::Scenario;
use vertifleet_policy::Policy;

use crate::error::Error;
use crate::gcaps_x::GcapsX;
use crate::header::Header;
use crate::learned::Learned;
use crate::nn;
use crate::tensor_file;

/// No weight file of ours comes near; larger ones are not read.
const LIMIT_BYTES: u64 = 512 << 20;
/// Weights that fit any number of vertiports have the same shapes for all; the layout is made for this one.
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
    /// A rule that the header breaks, or that the parameters do: they must be as many as the network has, and finite.
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

    /// What the weights are of and where they came from.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The name of the policy's kind: `gcaps`, `mlp` or `gcaps-x`.
    pub fn kind(&self) -> &'static str {
        self.header.policy.name()
    }

    /// The parameters, in the order of the layout.
    pub fn params(&self) -> &[f32] {
        &self.params
    }

    /// Where each tensor lies among the parameters.
    pub fn layout(&self) -> &nn::Layout {
        self.net.layout()
    }

    /// The network of layers for a day with so many vertiports. Weights that fit one number only have it for that one, whatever is
    /// asked.
    ///
    /// # Panics
    /// If weights that fit any number are asked for none, or for more than 4,096.
    pub fn net(&self, vertiports: usize) -> nn::NeuralNetwork {
        match self.header.shape.vertiports {
            Some(_) => self.net.clone(),
            None => self.header.network_of_layers(vertiports).expect("a number of vertiports"),
        }
    }

    /// The weights as passes take them.
    pub fn weights(&self) -> nn::Weights {
        self.net.weights(self.params.clone())
    }

    /// A policy that decides by this model. `gcaps-x` rolls out so many of its best choices before it decides, from 2 on; 1 decides at
    /// once, and so do the other kinds.
    pub fn policy(&self, most_rolled_out: usize) -> Box<dyn Policy> {
        match self.header.shape.vertiports {
            Some(_) => Box::new(Learned::new(self)),
            None => Box::new(GcapsX::new(self, most_rolled_out)),
        }
    }

    /// Whether the model can decide on this day.
    ///
    /// # Errors
    /// [`Error::WrongNetwork`] if the day has another number of vertiports than the weights fit.
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

    /// The file's bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let tensors = self.layout().tensors().iter().map(|tensor| {
            let entries = &self.params[tensor.offset..][..tensor.len()];
            (tensor.name.as_str(), tensor.shape.clone(), entries)
        });
        tensor_file::to_bytes(&self.header, tensors)
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
    /// If it cannot be read, is no weight file, or its tensors are not those of the policy its header names; the error says what
    /// differs.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let bytes = vertifleet_core::read_at_most(path, LIMIT_BYTES)?;
        Self::from_bytes(&bytes, &path.display().to_string())
    }

    /// Reads a weight file's bytes; `origin` names them in errors.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_bytes(bytes: &[u8], origin: &str) -> Result<Self, Error> {
        parse(bytes).map_err(|rule| Error::BadWeights { origin: origin.to_owned(), rule })
    }
}

fn parse(bytes: &[u8]) -> Result<Model, String> {
    let header = Header::read(tensor_file::header(bytes)?)?;
    let net = header.network_of_layers(SOME_VERTIPORTS)?;
    // A header may promise more weights than any memory holds; the file has to have them.
    if net.layout().len() > bytes.len() / 4 {
        return Err(format!("{} weights do not fit in the file", net.layout().len()));
    }
    let file = SafeTensors::deserialize(bytes).map_err(|error| error.to_string())?;
    Model::new(header, params(net.layout(), &file)?)
}

/// The parameters in the layout's order; an error says which tensor is not as the layout has it.
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
