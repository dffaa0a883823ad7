//! `Scenario`: one operating day, nothing left to be drawn.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::PyArray1;
use pyo3::prelude::*;
use vertifleet_core as core;

use crate::failure::Failure;
use crate::frames::{count, read_only, table};
use crate::pickle::{Reduced, reduced};

/// One operating day with everything exogenous in it: network, fleet, demand, tariffs, disturbances. Never changes, and neither do its
/// arrays; another day is drawn from a changed network, or read from a changed text of this one (`to_json`, `from_json`).
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

    /// The day that the text of a scenario file describes; `origin` stands for the file in messages.
    #[staticmethod]
    #[pyo3(signature = (text, origin = "<text>"))]
    fn from_json(text: &str, origin: &str) -> Result<Self, Failure> {
        Ok(Self::of(core::Scenario::from_json(text.as_bytes(), origin)?))
    }

    /// Writes the day as a scenario file. A file that is there and is no scenario, or is read-only, is replaced only with `force`.
    #[pyo3(signature = (path, *, force = false))]
    fn write(&self, path: PathBuf, force: bool) -> Result<(), Failure> {
        core::check_output(&path, &core::Scenario::FILE, force)?;
        Ok(self.scenario.write(path)?)
    }

    /// The text of its scenario file.
    fn to_json(&self) -> String {
        self.scenario.to_json()
    }

    /// What people call the day, `paper-7`.
    #[getter]
    fn name(&self) -> &str {
        &self.scenario.name
    }

    /// The seed it was drawn with, of which days of all purposes have their own ranges.
    #[getter]
    fn seed(&self) -> u64 {
        self.scenario.seed
    }

    /// Ids of the vertiports; their order is that of all arrays.
    #[getter]
    fn vertiports(&self) -> Vec<&str> {
        self.scenario.vertiports.iter().map(|vertiport| vertiport.id.as_str()).collect()
    }

    /// Ids of the aircraft.
    #[getter]
    fn aircraft(&self) -> Vec<&str> {
        self.scenario.aircraft.iter().map(|aircraft| aircraft.id.as_str()).collect()
    }

    /// Where each aircraft stands when operations start, as positions of vertiports [aircraft].
    #[getter]
    fn start_positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let places = self.scenario.aircraft.iter().map(|aircraft| count(aircraft.at.0));
        read_only(PyArray1::from_iter(py, places))
    }

    /// Stands of each vertiport [vertiports].
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

    /// When each demand period begins, seconds since midnight [periods].
    #[getter]
    fn periods_s<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let starts = self.scenario.periods.iter().map(|start| count(start.seconds()));
        read_only(PyArray1::from_iter(py, starts))
    }

    /// Passengers who will want to fly [periods, vertiports, vertiports]; no policy sees this where it differs from the forecast.
    #[getter]
    fn demand<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (periods, size) = self.shape();
        let cells = self.scenario.demand.iter().flat_map(core::Matrix::cells);
        read_only(table(py, cells.map(|&passengers| count(passengers)), [periods, size, size])?)
    }

    /// Fares, dollars a passenger [periods, vertiports, vertiports].
    #[getter]
    fn fare_usd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (periods, size) = self.shape();
        let fares =
            (0..periods).flat_map(|period| self.scenario.fare_usd.in_period(period).cells());
        read_only(table(py, fares.copied(), [periods, size, size])?)
    }

    /// Operating cost, dollars a passenger [vertiports, vertiports].
    #[getter]
    fn passenger_cost_usd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let size = self.scenario.vertiports.len();
        read_only(table(
            py,
            self.scenario.passenger_cost_usd.cells().iter().copied(),
            [size, size],
        )?)
    }

    /// What a flight costs with or without passengers, beside its energy, dollars [vertiports, vertiports].
    #[getter]
    fn flight_cost_usd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let size = self.scenario.vertiports.len();
        read_only(table(py, self.scenario.flight_cost_usd.cells().iter().copied(), [size, size])?)
    }

    /// What each aircraft costs whatever it does, dollars a day.
    #[getter]
    fn aircraft_cost_usd(&self) -> f64 {
        self.scenario.aircraft_cost_usd
    }

    /// Price of electricity, dollars per kWh [periods].
    #[getter]
    fn energy_price_usd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        read_only(PyArray1::from_slice(py, &self.scenario.energy_price_usd))
    }

    /// Revenue if every passenger flew, dollars: the denominator of the reward.
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

    /// Periods and vertiports.
    fn shape(&self) -> (usize, usize) {
        (self.scenario.periods.len(), self.scenario.vertiports.len())
    }
}
