//! Checkpoints: everything that a run needs to continue bit for bit, in one safetensors file.
//!
//! Randomness is a function of seed, day and decision, so there is no generator to store. This
//! module writes the common parts of all ways to learn: the identity of the run, the parameters and
//! Adam's moments. Each way adds its own [progress](Checkpoint::progress) and tensors.

use std::fmt::Display;
use std::path::Path;

use safetensors::tensor::{Dtype, SafeTensors};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use crate::adam::Adam;
use crate::error::Error;
use crate::run::RunIdentity;
use crate::settings::{TrainingSettings, first_difference};
use crate::tensor_file;

/// The format of checkpoints.
const FORMAT: &str = "vertifleet-checkpoint/2";
/// Largest checkpoint, bytes. No checkpoint of this program comes near this size.
const LIMIT_BYTES: u64 = 16 << 30;
/// The tensors of the parameters and of Adam's moments.
const LEARNER: [&str; 3] = ["params", "adam_first", "adam_second"];

/// The tensor of the best weights, for the ways to learn that keep them.
pub(crate) const BEST_PARAMS: &str = "best_params";

/// A checkpoint that was read and belongs to the requested run.
pub(crate) struct Checkpoint<Progress> {
    pub(crate) params: Vec<f32>,
    pub(crate) adam: Adam,
    /// The progress of the run, in the form of its way to learn.
    pub(crate) progress: Progress,
    bytes: Vec<u8>,
}

/// The header of a checkpoint; the first member identifies the kind of file.
#[derive(Serialize)]
struct Header<'a, Progress> {
    format: &'static str,
    run: &'a RunIdentity,
    adam_steps: u64,
    progress: &'a Progress,
}

/// Writes a checkpoint, completely or not at all; `others` are the additional tensors of the way to
/// learn.
pub(crate) fn write<'a>(
    path: &Path,
    run: &RunIdentity,
    params: &'a [f32],
    adam: &'a Adam,
    progress: &impl Serialize,
    others: impl IntoIterator<Item = (String, &'a [f32])>,
) -> Result<(), Error> {
    let header = Header { format: FORMAT, run, adam_steps: adam.steps, progress };
    let learner = LEARNER.map(str::to_owned).into_iter().zip([params, &adam.first, &adam.second]);
    let tensors: Vec<(String, &[f32])> = learner.chain(others).collect();
    let tensors =
        tensors.iter().map(|(name, entries)| (name.as_str(), vec![entries.len()], *entries));
    let bytes = tensor_file::to_bytes(&header, tensors);
    Ok(vertifleet_core::write_atomically(path, &bytes)?)
}

/// Reads the checkpoint of this run, whose network has `parameters` parameters.
pub(crate) fn read<Progress: DeserializeOwned>(
    path: &Path,
    asked: &RunIdentity,
    parameters: usize,
) -> Result<Checkpoint<Progress>, Error> {
    let bytes = vertifleet_core::read_at_most(path, LIMIT_BYTES)?;
    parse(bytes, asked, parameters).map_err(|rule| Error::BadCheckpoint { rule })
}

fn parse<Progress: DeserializeOwned>(
    bytes: Vec<u8>,
    asked: &RunIdentity,
    parameters: usize,
) -> Result<Checkpoint<Progress>, String> {
    let mut header = tensor_file::header(&bytes)?;
    let format = header.get("format").and_then(Value::as_str).unwrap_or_default();
    if format != FORMAT {
        return Err(format!("format must be {FORMAT:?}, found {format:?}"));
    }
    check_same(&mut header, asked)?;
    let adam_steps = member(&mut header, "adam_steps")?;
    let progress = member(&mut header, "progress")?;
    let file = SafeTensors::deserialize(&bytes).map_err(|error| error.to_string())?;
    let [params, first, second] = LEARNER.map(|name| tensor(&file, name, parameters));
    let adam = Adam { first: first?, second: second?, steps: adam_steps };
    let params = params?;
    Ok(Checkpoint { params, adam, progress, bytes })
}

impl<Progress> Checkpoint<Progress> {
    /// The tensor of the weights that did best so far.
    pub(crate) fn best_params(&self) -> Result<Vec<f32>, Error> {
        self.others(|file| tensor(file, BEST_PARAMS, self.params.len()))
    }

    /// The additional tensors of the way to learn, which `read` takes from the file.
    pub(crate) fn others<T>(
        &self,
        read: impl FnOnce(&SafeTensors<'_>) -> Result<T, String>,
    ) -> Result<T, Error> {
        let file = SafeTensors::deserialize(&self.bytes).map_err(|error| error.to_string());
        file.and_then(|file| read(&file)).map_err(|rule| Error::BadCheckpoint { rule })
    }
}

/// The entries of a tensor, which must be exactly `entries` finite numbers.
pub(crate) fn tensor(
    file: &SafeTensors<'_>,
    name: &str,
    entries: usize,
) -> Result<Vec<f32>, String> {
    let view = file.tensor(name).map_err(|error| error.to_string())?;
    if view.dtype() != Dtype::F32 || view.shape() != [entries] {
        return Err(format!("tensor {name:?} must be {entries} numbers of F32"));
    }
    let values: Vec<f32> = tensor_file::entries(&view).collect();
    if values.iter().any(|value| !value.is_finite()) {
        return Err(format!("tensor {name:?}: a number is not finite"));
    }
    Ok(values)
}

/// Checks the rows of a curve, given by their numbers, which a run of `most` steps can have.
pub(crate) fn check_steps(
    steps: &str,
    numbers: impl ExactSizeIterator<Item = u32>,
    most: u32,
) -> Result<(), Error> {
    let broken = |rule| Err(Error::BadCheckpoint { rule });
    if numbers.len() > most as usize {
        return broken(format!("{} {steps} are more than the run has", numbers.len()));
    }
    if numbers.zip(1..).any(|(number, expected)| number != expected) {
        return broken(format!("{steps} must be numbered from 1 on"));
    }
    Ok(())
}

/// Removes a member from a header and returns it.
fn member<T: DeserializeOwned>(header: &mut Map<String, Value>, name: &str) -> Result<T, String> {
    let value = header.remove(name).unwrap_or_default();
    serde_json::from_value(value).map_err(|error| format!("header: {name}: {error}"))
}

/// Checks that the checkpoint belongs to the requested run.
fn check_same(header: &mut Map<String, Value>, asked: &RunIdentity) -> Result<(), String> {
    let mut run: Map<String, Value> = member(header, "run")?;
    let settings = run.remove("settings").unwrap_or_default();
    let different = |what: &str, found: &dyn Display, asked: &dyn Display| {
        Err(format!("it belongs to a run with {what} {found}, not {asked}"))
    };
    let network: String = member(&mut run, "network")?;
    if network != asked.network {
        return different("network", &network, &asked.network);
    }
    if member::<u32>(&mut run, "network_fingerprint")? != asked.network_fingerprint {
        return Err(format!("network {network:?} has changed since the run was started"));
    }
    let policy = member(&mut run, "policy")?;
    if policy != asked.policy {
        return different("policy", &format!("{policy:?}"), &format!("{:?}", asked.policy));
    }
    let seed: u32 = member(&mut run, "seed")?;
    if seed != asked.seed {
        return different("seed", &seed, &asked.seed);
    }
    let begun: Option<String> = member(&mut run, "begun_with")?;
    if begun != asked.begun_with {
        let hash = |begun: &Option<String>| begun.clone().unwrap_or_else(|| "none".to_owned());
        return different("begin_with", &hash(&begun), &hash(&asked.begun_with));
    }
    let settings = TrainingSettings::read(&policy, settings)?;
    match first_difference(&settings, &asked.settings) {
        Some((name, found, asked)) => different(&format!("setting {name}"), &found, &asked),
        None => Ok(()),
    }
}
