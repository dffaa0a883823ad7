//! A weight file of either kind: for networks with one number of vertiports, or for any.

use std::path::Path;

use crate::error::Error;
use crate::relative::AnyModel;
use crate::weights::{self, Model};

/// A trained policy.
#[derive(Debug, Clone)]
pub enum Weights {
    /// For networks with the number of vertiports that it was trained on.
    OfOneSize(Box<Model>),
    /// For networks of any size.
    OfAnySize(Box<AnyModel>),
}

impl Weights {
    /// Reads a weight file of either kind.
    ///
    /// # Errors
    /// As [`Model::read`] and [`AnyModel::read`].
    pub fn read(path: &Path) -> Result<Self, Error> {
        let bytes = vertifleet_core::read_at_most(path, weights::LIMIT_BYTES)?;
        Self::from_bytes(&bytes, &path.display().to_string())
    }

    /// Reads a weight file's bytes; `origin` names them in errors.
    ///
    /// # Errors
    /// As [`Model::from_bytes`] and [`AnyModel::from_bytes`].
    pub fn from_bytes(bytes: &[u8], origin: &str) -> Result<Self, Error> {
        if AnyModel::wrote(bytes) {
            return Ok(Self::OfAnySize(Box::new(AnyModel::from_bytes(bytes, origin)?)));
        }
        Ok(Self::OfOneSize(Box::new(Model::from_bytes(bytes, origin)?)))
    }

    /// The name of the policy's kind.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::OfOneSize(model) => model.header().policy.name(),
            Self::OfAnySize(model) => model.header().policy.name(),
        }
    }
}
