//! `Trace`: every decision of a day, and `check`, which checks a trace independently of the
//! simulator.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vertifleet_core as core;
use vertifleet_picture::schedule;
use vertifleet_sim as sim;

use crate::failure::Failure;
use crate::frames::{Columns, frame, plain};
use crate::pickle::{Reduced, reduced};
use crate::picture::Picture;
use crate::scenario::Scenario;

/// Every decision of a day with its outcome, one row each, in the order in which they were taken.
/// It is a complete schedule.
#[pyclass(frozen, module = "vertifleet")]
#[derive(Clone)]
pub(crate) struct Trace {
    pub(crate) scenario: Arc<core::Scenario>,
    pub(crate) trace: Arc<sim::Trace>,
}

#[pymethods]
impl Trace {
    /// The day.
    #[getter]
    fn scenario(&self) -> Scenario {
        Scenario { scenario: Arc::clone(&self.scenario) }
    }

    /// Reads a trace of a day from a CSV file.
    #[staticmethod]
    fn read(path: PathBuf, scenario: &Scenario) -> Result<Self, Failure> {
        let trace = sim::Trace::read(&path, &scenario.scenario)?;
        Ok(Self { scenario: Arc::clone(&scenario.scenario), trace: Arc::new(trace) })
    }

    /// Reads a trace from the text of a CSV file. `origin` is the name of the file in messages.
    #[staticmethod]
    #[pyo3(signature = (text, scenario, origin = "<text>"))]
    fn from_csv(text: &str, scenario: &Scenario, origin: &str) -> Result<Self, Failure> {
        let trace = sim::Trace::from_csv(text.as_bytes(), &scenario.scenario, origin)?;
        Ok(Self { scenario: Arc::clone(&scenario.scenario), trace: Arc::new(trace) })
    }

    /// Writes the trace as a CSV file. An existing file that is read-only or not a trace is
    /// replaced only with `force`.
    #[pyo3(signature = (path, *, force = false))]
    fn write(&self, path: PathBuf, force: bool) -> Result<(), Failure> {
        core::check_output(&path, &sim::Trace::FILE, force)?;
        Ok(self.trace.write(&self.scenario, &path)?)
    }

    /// The trace as the text of a CSV file.
    fn to_csv(&self) -> String {
        self.trace.to_csv(&self.scenario)
    }

    /// The columns as numpy arrays, with the same names as in the file. Times are in seconds since
    /// midnight, money in dollars and energy in kWh. `aircraft`, `from` and `to` are positions in
    /// `Scenario.aircraft` and `Scenario.vertiports`. A hold goes from a vertiport to itself. Only
    /// days that charge as needed have columns `charge_kwh`, at the decision, and `takeoff`.
    #[getter]
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let rows = &self.trace.rows;
        let columns = Columns::new(py);
        columns.counts("time", rows.iter().map(|row| row.time.seconds()))?;
        columns.counts("aircraft", rows.iter().map(|row| row.aircraft.0))?;
        columns.counts("from", rows.iter().map(|row| row.from.0))?;
        columns.counts("to", rows.iter().map(|row| row.to.0))?;
        columns.counts("passengers", rows.iter().map(|row| row.passengers))?;
        columns.numbers("revenue", rows.iter().map(|row| row.revenue_usd))?;
        columns.numbers("passenger_cost", rows.iter().map(|row| row.passenger_cost_usd))?;
        columns.numbers("energy_kwh", rows.iter().map(|row| row.energy_kwh))?;
        columns.numbers("energy_cost", rows.iter().map(|row| row.energy_cost_usd))?;
        columns.counts("arrival", rows.iter().map(|row| row.arrival.seconds()))?;
        columns.counts("ready", rows.iter().map(|row| row.ready.seconds()))?;
        if self.scenario.has_flight_costs() {
            columns.numbers("flight_cost", rows.iter().map(|row| row.flight_cost_usd))?;
        }
        if self.scenario.operations.charging == core::Charging::AsNeeded {
            columns.numbers("charge_kwh", rows.iter().map(|row| row.charge_kwh))?;
            columns.counts("takeoff", rows.iter().map(|row| row.takeoff.seconds()))?;
        }
        Ok(columns.into_dict())
    }

    /// The columns as a pandas `DataFrame`.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame(&self.columns(py)?, "pandas")
    }

    /// The columns as a polars `DataFrame`.
    fn to_polars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame(&self.columns(py)?, "polars")
    }

    /// The trace as a picture: the passengers by pair, the schedule of every aircraft, the
    /// occupancy of the vertiports, and the demand served and spilled.
    pub(crate) fn plot(&self, py: Python<'_>) -> Picture {
        Picture { text: py.detach(|| schedule(&self.scenario, &self.trace.rows)) }
    }

    fn _repr_svg_(&self, py: Python<'_>) -> String {
        self.plot(py).text
    }

    fn __len__(&self) -> usize {
        self.trace.rows.len()
    }

    fn __repr__(&self) -> String {
        format!("<Trace of {}: {} decisions>", self.scenario.name, self.trace.rows.len())
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.trace == other.trace && self.scenario == other.scenario
    }

    fn __hash__(&self) -> u64 {
        self.scenario.seed
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Reduced<'py, (String, Scenario)> {
        let scenario = Scenario { scenario: Arc::clone(&self.scenario) };
        reduced::<Self, _>(py, "from_csv", (self.to_csv(), scenario))
    }
}

/// Checks a schedule against the rules, independently of the simulator. Returns the report as a
/// dict: `valid`, `totals` (the results of the day, computed again), `broken` (how often each rule
/// is broken) and `findings` (where it is broken). A schedule of another day is matched by the ids
/// of its vertiports and aircraft, like a file.
#[pyfunction]
#[pyo3(signature = (scenario, trace))]
pub(crate) fn check<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    trace: &Trace,
) -> PyResult<Bound<'py, PyAny>> {
    let day = &scenario.scenario;
    let report = py.detach(|| {
        let same = same_ids(&trace.scenario, day);
        let read = if same { None } else { Some(trace.trace.to_csv(&trace.scenario)) };
        let read = read.map(|text| sim::Trace::from_csv(text.as_bytes(), day, "the schedule"));
        Ok::<_, Failure>(sim::check::check(day, read.transpose()?.as_ref().unwrap_or(&trace.trace)))
    })?;
    plain(py, &report)
}

/// Whether two days have the same vertiports and aircraft at the same positions.
fn same_ids(one: &core::Scenario, other: &core::Scenario) -> bool {
    one.vertiports.len() == other.vertiports.len() && ids(one).eq(ids(other))
}

fn ids(day: &core::Scenario) -> impl Iterator<Item = &str> {
    let vertiports = day.vertiports.iter().map(|vertiport| vertiport.id.as_str());
    vertiports.chain(day.aircraft.iter().map(|aircraft| aircraft.id.as_str()))
}
