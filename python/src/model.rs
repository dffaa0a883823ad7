//! `Model`: the weights of a learned policy.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;
use std::sync::Arc;

use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyMapping};
use vertifleet_core::check_output;
use vertifleet_learn::nn::{self, Architecture, Inputs};
use vertifleet_learn::{TrainingSettings, kinds, shipped};

use crate::failure::Failure;
use crate::frames::{members, plain, table};
use crate::pickle::{Reduced, reduced};

/// The weights of a learned policy: `gcaps`, `mlp` or `mlp-full` for one number of vertiports, or
/// `gcaps-x` or `gcaps-full` for any network. A `Model` never changes.
#[pyclass(frozen, module = "vertifleet")]
pub(crate) struct Model {
    pub(crate) model: Arc<vertifleet_learn::Model>,
}

#[pymethods]
impl Model {
    /// Reads a weight file of any learned policy, which is a safetensors file.
    #[staticmethod]
    fn read(path: PathBuf) -> Result<Self, Failure> {
        Ok(Self { model: Arc::new(vertifleet_learn::Model::read(&path)?) })
    }

    /// Reads the weights from the bytes of a weight file. `origin` is the name of the file in
    /// messages.
    #[staticmethod]
    #[pyo3(signature = (bytes, origin = "<bytes>"))]
    fn from_bytes(bytes: &[u8], origin: &str) -> Result<Self, Failure> {
        Ok(Self { model: Arc::new(vertifleet_learn::Model::from_bytes(bytes, origin)?) })
    }

    /// The shipped weights of a policy for a network.
    #[staticmethod]
    #[pyo3(signature = (policy = "gcaps-x", network = "paper"))]
    fn shipped(policy: &str, network: &str) -> Result<Self, Failure> {
        Ok(Self { model: Arc::new(shipped(policy, network)?.model) })
    }

    /// Writes the weights as a weight file. An existing file that is read-only or not a weight file
    /// is replaced only with `force`.
    #[pyo3(signature = (path, *, force = false))]
    fn write(&self, path: PathBuf, force: bool) -> Result<(), Failure> {
        check_output(&path, &kinds::WEIGHTS, force)?;
        Ok(self.model.write(&path)?)
    }

    /// The weights as the bytes of a weight file.
    fn to_bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.model.to_bytes())
    }

    /// SHA-256 of the weight file in hexadecimal digits, which identifies the weights in result
    /// files.
    #[getter]
    fn sha256(&self) -> String {
        self.model.sha256()
    }

    /// The name of the policy: gcaps, mlp, gcaps-x, gcaps-full or mlp-full.
    #[getter]
    fn kind(&self) -> &'static str {
        self.model.kind()
    }

    /// The header of the weight file, as a dict. It contains the task and the origin of the
    /// weights.
    #[getter]
    fn header<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, self.model.header())
    }

    /// Copies of the tensors by name.
    #[getter]
    fn tensors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let tensors = PyDict::new(py);
        for tensor in self.model.layout().tensors() {
            let entries = &self.model.params()[tensor.offset..][..tensor.len()];
            let array = PyArray1::from_slice(py, entries);
            tensors.set_item(&tensor.name, array.reshape(tensor.shape.clone())?)?;
        }
        Ok(tensors)
    }

    /// The logits [B, N], minus infinity where the mask is 0, and the values [B] of a batch of
    /// decisions, as the policy in Rust computes them. The inputs `nodes` [B, N * F] or [B, N, F],
    /// `aircraft` [B, G], `mask` [B, N] and `clock` [B] or [B, 1], which is the share of the day
    /// that is left, are the same as in the observations of the vector environment. `edges` [B, N,
    /// N] or [B, N * N] are the weights of edges, if the weights' graph has observed ones. For
    /// gcaps-x this is the output of the layers alone, without the day's prices.
    #[pyo3(signature = (nodes, aircraft, mask, clock, edges = None))]
    fn forward<'py>(
        &self,
        nodes: &Bound<'py, PyAny>,
        aircraft: &Bound<'py, PyAny>,
        mask: &Bound<'py, PyAny>,
        clock: &Bound<'py, PyAny>,
        edges: Option<&Bound<'py, PyAny>>,
    ) -> Reduced<'py, Bound<'py, PyAny>> {
        let py = nodes.py();
        let [batch, vertiports] = sizes(mask)?;
        // No network has more vertiports.
        let net = self.model.net(vertiports.clamp(1, 256));
        let shape = net.shape();
        let (size, features) = (shape.vertiports, shape.node_features);
        let policy = &self.model.header().policy;
        let edges = edges_of(edges, policy.edges().is_some(), [batch, size * size])?;
        let nodes = entries("nodes", nodes, [batch, size * features])?;
        let aircraft = entries("aircraft", aircraft, [batch, shape.aircraft_features])?;
        let clock = entries("clock", clock, [batch, 1])?;
        let mask = entries("mask", mask, [batch, size])?;
        let mask: Vec<u8> = mask.iter().map(|&feasible| u8::from(feasible != 0.0)).collect();
        let inputs = Inputs {
            batch,
            nodes: &nodes,
            aircraft: &aircraft,
            mask: &mask,
            edges: &edges,
            clock: &clock,
        };
        let space = py.detach(|| pass(&net, &self.model.weights(), inputs));
        let logits = table(py, space.logits().iter().copied(), [batch, size])?;
        Ok((logits, PyArray1::from_slice(py, space.values()).into_any()))
    }

    fn __repr__(&self) -> String {
        format!("<Model {}>", self.model.kind())
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.model.to_bytes() == other.model.to_bytes()
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.model.to_bytes().hash(&mut hasher);
        hasher.finish()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Reduced<'py, (Bound<'py, PyBytes>,)> {
        reduced::<Self, _>(py, "from_bytes", (self.to_bytes(py),))
    }
}

/// The numbers of rows and columns of the mask.
fn sizes(table: &Bound<'_, PyAny>) -> PyResult<[usize; 2]> {
    let shape: Vec<usize> =
        table.py().import("numpy")?.call_method1("shape", (table,))?.extract()?;
    shape.try_into().map_err(|shape| {
        Failure::argument(format!("mask must have two dimensions, [B, N], found {shape:?}")).into()
    })
}

/// The entries of edges, which must be given if and only if the weights read them.
fn edges_of(
    given: Option<&Bound<'_, PyAny>>,
    is_read: bool,
    sizes: [usize; 2],
) -> PyResult<Vec<f32>> {
    match (given, is_read) {
        (Some(array), true) => entries("edges", array, sizes),
        (None, false) => Ok(Vec::new()),
        (None, true) => {
            let hint =
                "the parts of an observation that show them are in the reference of observations";
            Err(Failure::hinted("these weights need edges".to_owned(), hint.to_owned()).into())
        }
        (Some(_), false) => {
            let rule = "these weights read no edges: leave them out".to_owned();
            Err(Failure::argument(rule).into())
        }
    }
}

/// The entries of an array of any number type, row by row. The array may have more or fewer than
/// two dimensions if it has the same rows.
fn entries(
    name: &str,
    array: &Bound<'_, PyAny>,
    [rows, columns]: [usize; 2],
) -> PyResult<Vec<f32>> {
    let numpy = array.py().import("numpy")?;
    let array = numpy.call_method1("asarray", (array, "float32"))?;
    let shape: Vec<usize> = array.getattr("shape")?.extract()?;
    if shape.first() != Some(&rows) || shape.iter().product::<usize>() != rows * columns {
        let message = format!("{name} must have {rows} rows of {columns} entries, found {shape:?}");
        return Err(Failure::argument(message).into());
    }
    let flat = numpy.call_method1("ravel", (array,))?;
    Ok(flat.extract::<PyReadonlyArray1<'_, f32>>()?.as_slice()?.to_vec())
}

fn pass(net: &nn::NeuralNetwork, weights: &nn::Weights, inputs: Inputs<'_>) -> nn::Workspace {
    let mut space = net.workspace(inputs.batch);
    net.forward(weights, inputs, &mut space);
    space
}

/// The settings of a training preset of `gcaps` and `mlp` as a dict: `default`, `paper` (Table 2),
/// `imitation` or `evolution`. Settings can be changed: `settings("paper", ent_coef=0.4)`. Changed
/// settings are checked in the same way as by `vertifleet train --set`.
#[pyfunction]
#[pyo3(signature = (preset = "default", **changes))]
pub(crate) fn settings<'py>(
    py: Python<'py>,
    preset: &str,
    changes: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let policy = Architecture::named("gcaps").expect("a policy with sizes");
    let mut settings = TrainingSettings::preset(&policy, preset).map_err(Failure::from)?;
    if let Some(named) = changes {
        let named = self::changes(named.as_mapping())?;
        settings.set(borrowed(&named)).map_err(Failure::from)?;
    }
    plain(py, &settings)
}

/// The changes of settings in a mapping, in the form of `vertifleet train --set`.
pub(crate) fn changes(mapping: &Bound<'_, PyMapping>) -> PyResult<Vec<(String, String)>> {
    let members = members("settings", mapping)?;
    Ok(members.into_iter().map(|(name, value)| (name, whole(value).to_string())).collect())
}

/// The changes as pairs of borrowed texts.
pub(crate) fn borrowed(changes: &[(String, String)]) -> impl Iterator<Item = (&str, &str)> {
    changes.iter().map(|(name, value)| (name.as_str(), value.as_str()))
}

/// Turns a float without a fraction into a whole number, because users of Python write `1e6` for a
/// million.
fn whole(value: serde_json::Value) -> serde_json::Value {
    match value.as_f64() {
        Some(number) if number.fract() == 0.0 && number.abs() < 1e15 =>
        {
            #[expect(clippy::cast_possible_truncation, reason = "whole, and far from i64's ends")]
            (number as i64).into()
        }
        _ => value,
    }
}
