//! `Network`: the network that days are drawn from.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyMapping;
use vertifleet_core::{self as core, DaySeed, Purpose};

use crate::failure::{Failure, warn};
use crate::frames::{members, plain, table};
use crate::pickle::{Reduced, reduced};
use crate::scenario::Scenario;
use crate::whole_number::WholeNumber;

/// A network: vertiports, fleet, tariffs, and the models that days are drawn from.
///
/// `Network("paper")` is the shipped network with that name (`Network.shipped` lists the names),
/// `Network("random:7")` is the random network with that number, by which policies are compared;
/// `Network("random-training:7")` is one to learn from, and `Network("random-validation:7")` one to
/// choose settings by. `Network("mine.toml")` is read from the network file at that path. A
/// `Network` never changes. A pickle of it contains the whole
/// network.
#[pyclass(frozen, from_py_object, module = "vertifleet")]
#[derive(Clone)]
pub(crate) struct Network {
    pub(crate) network: Arc<core::Network>,
    /// The Python expression that made the network.
    source: String,
}

#[pymethods]
impl Network {
    #[new]
    fn new(py: Python<'_>, name_or_path: PathBuf) -> PyResult<Self> {
        let name_or_path = name_or_path.to_string_lossy();
        let source = format!("vertifleet.Network({name_or_path:?})");
        let network = core::Network::find(&name_or_path).map_err(Failure::from)?;
        Self::told(py, network, source)
    }

    /// Reads a network from the text of a network file. `origin` is the name of the file in
    /// messages.
    #[staticmethod]
    #[pyo3(signature = (text, origin = "<text>"))]
    fn from_toml(py: Python<'_>, text: &str, origin: &str) -> PyResult<Self> {
        let source = format!("vertifleet.Network.from_toml(..., {origin:?})");
        let network = core::Network::from_toml(text, origin).map_err(Failure::from)?;
        Self::told(py, network, source)
    }

    /// The names of the shipped networks.
    #[staticmethod]
    fn shipped() -> Vec<&'static str> {
        core::Network::shipped_names().collect()
    }

    /// The same network with some members of its network file changed:
    /// `network.changed({"fleet.0.count": 52, "vertiports.V3.stands": 8})`.
    ///
    /// A path names members from the outside in. An entry of a list is named by its `id` or by its
    /// position, counted from 0, and `*` stands for all entries. The result is checked like any
    /// network file.
    fn changed(&self, changes: &Bound<'_, PyMapping>) -> PyResult<Self> {
        let asked = members("changes", changes)?;
        let network = self.network.changed(asked.iter().map(|(path, value)| (path, value)));
        let source = format!("{}.changed({})", self.source, changes.repr()?);
        Self::told(changes.py(), network.map_err(Failure::from)?, source)
    }

    /// The Python expression that made the network, for people to read. A report contains it in its
    /// command.
    #[getter]
    fn source(&self) -> &str {
        &self.source
    }

    /// The name of the network. The days that are drawn from it are called `{name}-{seed}`.
    #[getter]
    fn name(&self) -> &str {
        self.network.name()
    }

    /// The split that a random network was drawn for: "training", "validation" or "comparison".
    /// None for other networks, which serve every split.
    #[getter]
    fn split(&self) -> Option<&'static str> {
        self.network.purpose().map(core::Purpose::name)
    }

    /// The text of the network file.
    #[getter]
    fn toml(&self) -> &str {
        self.network.toml()
    }

    /// Ids of the vertiports, in the order that all arrays use.
    #[getter]
    fn vertiports(&self) -> Vec<&str> {
        self.network.vertiports().iter().map(|vertiport| vertiport.id.as_str()).collect()
    }

    /// Number of aircraft.
    #[getter]
    fn fleet_size(&self) -> usize {
        self.network.fleet_size()
    }

    /// The numbers that the features of learned policies are divided by, as in the headers of
    /// weight files.
    #[getter]
    fn feature_scales<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.network.feature_scales())
    }

    /// Mean demand, passengers [periods, vertiports, vertiports]. The demand of the drawn days
    /// scatters around it.
    #[getter]
    fn mean_demand<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let means = self.network.mean_demand();
        let size = self.network.vertiports().len();
        table(
            py,
            means.iter().flat_map(|mean| mean.cells().iter().copied()),
            [means.len(), size, size],
        )
    }

    /// Draws the day of a seed. The same seed gives the same day everywhere.
    ///
    /// Days for different purposes ("comparison", "validation", "training") are never the same, so
    /// that no policy is judged on a day that it learned from.
    #[pyo3(signature = (seed, purpose = "comparison"))]
    fn draw(&self, seed: WholeNumber, purpose: &str) -> Result<Scenario, Failure> {
        let seed = seed.of("seed")?;
        let purpose = Purpose::named(purpose).ok_or_else(|| {
            Failure::argument(format!(
                "purpose must be \"comparison\", \"validation\" or \"training\", found {purpose:?}"
            ))
        })?;
        let seed = DaySeed::of_purpose(purpose, seed)?;
        Ok(Scenario::of(self.network.draw(seed)))
    }

    fn __repr__(&self) -> String {
        let (vertiports, fleet) = (self.network.vertiports().len(), self.network.fleet_size());
        format!("<Network {}: {vertiports} vertiports, {fleet} aircraft>", self.network.name())
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.network.toml() == other.network.toml()
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.network.toml().hash(&mut hasher);
        hasher.finish()
    }

    fn __copy__(&self) -> Self {
        self.clone()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.clone()
    }

    /// Restores a pickled network.
    #[staticmethod]
    fn restored(text: &str, source: String) -> Result<Self, Failure> {
        Ok(Self::of(core::Network::from_toml(text, &source)?, source))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Reduced<'py, (&str, &str)> {
        reduced::<Self, _>(py, "restored", (self.network.toml(), &self.source))
    }
}

impl Network {
    /// Wraps a network that has just been read, and emits a Python warning for everything that
    /// looks wrong with it.
    fn told(py: Python<'_>, network: core::Network, source: String) -> PyResult<Self> {
        for warning in network.warnings() {
            warn(py, &format!("[{}] {source}: {warning}", warning.code()))?;
        }
        Ok(Self::of(network, source))
    }

    pub(crate) fn of(network: core::Network, source: String) -> Self {
        Self { network: Arc::new(network), source }
    }

    /// Checks that a day has as many vertiports as this network, which is the number that the
    /// observation arrays have room for.
    pub(crate) fn check_fits(&self, day: &core::Scenario) -> Result<(), Failure> {
        let (expected, found) = (self.network.vertiports().len(), day.vertiports.len());
        if expected == found {
            return Ok(());
        }
        Err(Failure::argument(format!(
            "scenario {:?} has {found} vertiports, but network {:?} has {expected}",
            day.name,
            self.network.name()
        )))
    }
}
