//! `Scenario`: one operating day, as data.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::PyArray1;
use pyo3::prelude::*;
use vertifleet_core as core;

use crate::failure::Failure;
use crate::frames::{count, read_only, table};
use crate::pickle::{Reduced, reduced};
use crate::picture::Picture;

/// One operating day with all that happens to the fleet from outside: network, fleet, demand,
/// tariffs and disturbances. A `Scenario` never changes, and neither do its arrays. To get a
/// different day, draw it from a changed network, or change the text of this day (`to_json`,
/// `from_json`).
#[pyclass(frozen, module = "vertifleet")]
#[derive(Clone)]
pub(crate) struct Scenario {
    pub(crate) scenario: Arc<core::Scenario>,
}

#[pymethods]
impl Scenario {
    /// Reads a scenario file.
    #[staticmethod]
    fn read(path: PathBuf) -> Result<Self, Failure> {
        Ok(Self::of(core::Scenario::read(path)?))
    }

    /// Reads a day from the text of a scenario file. `origin` is the name of the file in messages.
    #[staticmethod]
    #[pyo3(signature = (text, origin = "<text>"))]
    fn from_json(text: &str, origin: &str) -> Result<Self, Failure> {
        Ok(Self::of(core::Scenario::from_json(text.as_bytes(), origin)?))
    }

    /// Writes the day as a scenario file. An existing file that is read-only or not a scenario file
    /// is replaced only with `force`.
    #[pyo3(signature = (path, *, force = false))]
    fn write(&self, path: PathBuf, force: bool) -> Result<(), Failure> {
        core::check_output(&path, &core::Scenario::FILE, force)?;
        Ok(self.scenario.write(path)?)
    }

    /// The text of the scenario file.
    fn to_json(&self) -> String {
        self.scenario.to_json()
    }

    /// The day as a picture: its vertiports, and its demand by pair and by time.
    fn plot(&self, py: Python<'_>) -> Picture {
        Picture { text: py.detach(|| vertifleet_picture::day(&self.scenario)) }
    }

    fn _repr_svg_(&self, py: Python<'_>) -> String {
        self.plot(py).text
    }

    /// The name of the day, for example `paper-7`.
    #[getter]
    fn name(&self) -> &str {
        &self.scenario.name
    }

    /// The seed that the day was drawn with. The seeds of training, validation and comparison days
    /// have separate ranges.
    #[getter]
    fn seed(&self) -> u64 {
        self.scenario.seed
    }

    /// The split of the day: "training", "validation" or "comparison". It is that of its seed, or
    /// that of its network if the network was drawn for a stricter one: every day of "random:7" is
    /// a comparison day.
    #[getter]
    fn split(&self) -> &'static str {
        self.scenario.purpose().name()
    }

    /// Ids of the vertiports, in the order that all arrays use.
    #[getter]
    fn vertiports(&self) -> Vec<&str> {
        self.scenario.vertiports.iter().map(|vertiport| vertiport.id.as_str()).collect()
    }

    /// Ids of the aircraft.
    #[getter]
    fn aircraft(&self) -> Vec<&str> {
        self.scenario.aircraft.iter().map(|aircraft| aircraft.id.as_str()).collect()
    }

    /// The initial place of each aircraft, as positions of vertiports [aircraft].
    #[getter]
    fn start_positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let places = self.scenario.aircraft.iter().map(|aircraft| count(aircraft.at.0));
        read_only(PyArray1::from_iter(py, places))
    }

    /// Number of stands at each vertiport [vertiports].
    #[getter]
    fn stands<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let stands = self.scenario.vertiports.iter().map(|vertiport| count(vertiport.stands));
        read_only(PyArray1::from_iter(py, stands))
    }

    /// Positions of the vertiports, miles east and north [vertiports, 2].
    #[getter]
    fn positions_mi<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let vertiports = &self.scenario.vertiports;
        let places = vertiports.iter().flat_map(|vertiport| [vertiport.x_mi, vertiport.y_mi]);
        read_only(table(py, places, [vertiports.len(), 2])?)
    }

    /// Distances, miles [vertiports, vertiports].
    #[getter]
    fn distance_mi<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let size = self.scenario.vertiports.len();
        read_only(table(py, self.scenario.distance_mi.cells().iter().copied(), [size, size])?)
    }

    /// Start of each demand period, seconds since midnight [periods].
    #[getter]
    fn periods_s<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let starts = self.scenario.periods.iter().map(|start| count(start.seconds()));
        read_only(PyArray1::from_iter(py, starts))
    }

    /// Demand, passengers [periods, vertiports, vertiports]. Where it differs from the forecast, no
    /// policy observes it.
    #[getter]
    fn demand<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (periods, size) = self.shape();
        let cells = self.scenario.demand.iter().flat_map(core::Matrix::cells);
        read_only(table(py, cells.map(|&passengers| count(passengers)), [periods, size, size])?)
    }

    /// Fares, dollars per passenger [periods, vertiports, vertiports].
    #[getter]
    fn fare_usd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (periods, size) = self.shape();
        let fares =
            (0..periods).flat_map(|period| self.scenario.fare_usd.in_period(period).cells());
        read_only(table(py, fares.copied(), [periods, size, size])?)
    }

    /// Passenger cost: the cost of carrying a passenger, dollars per passenger [vertiports,
    /// vertiports].
    #[getter]
    fn passenger_cost_usd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let size = self.scenario.vertiports.len();
        read_only(table(
            py,
            self.scenario.passenger_cost_usd.cells().iter().copied(),
            [size, size],
        )?)
    }

    /// Flight cost: the cost of a flight with or without passengers, energy excluded, dollars
    /// [vertiports, vertiports].
    #[getter]
    fn flight_cost_usd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let size = self.scenario.vertiports.len();
        read_only(table(py, self.scenario.flight_cost_usd.cells().iter().copied(), [size, size])?)
    }

    /// Aircraft cost: the fixed cost of each aircraft, dollars per day.
    #[getter]
    fn aircraft_cost_usd(&self) -> f64 {
        self.scenario.aircraft_cost_usd
    }

    /// Price of electricity, dollars per kWh [periods].
    #[getter]
    fn energy_price_usd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        read_only(PyArray1::from_slice(py, &self.scenario.energy_price_usd))
    }

    /// Potential: the revenue if every passenger flew, dollars. It is the denominator of the
    /// reward.
    #[getter]
    fn potential_usd(&self) -> f64 {
        self.scenario.potential_usd()
    }

    fn __repr__(&self) -> String {
        let (vertiports, fleet) = (self.scenario.vertiports.len(), self.scenario.aircraft.len());
        format!("<Scenario {}: {vertiports} vertiports, {fleet} aircraft>", self.scenario.name)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.scenario == other.scenario
    }

    fn __hash__(&self) -> u64 {
        self.scenario.seed
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Reduced<'py, (String, &str)> {
        reduced::<Self, _>(py, "from_json", (self.scenario.to_json(), &self.scenario.name))
    }
}

impl Scenario {
    pub(crate) fn of(scenario: core::Scenario) -> Self {
        Self { scenario: Arc::new(scenario) }
    }

    /// The numbers of periods and vertiports.
    fn shape(&self) -> (usize, usize) {
        (self.scenario.periods.len(), self.scenario.vertiports.len())
    }
}
