//! `generalise`: a day of each of many random networks.

use std::collections::BTreeMap;
use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vertifleet_optimize::Step;
use vertifleet_progress::Bars;
use vertifleet_study::competitor::Selection;
use vertifleet_study::generalisation::{self as study, GeneralisationRecords};
use vertifleet_study::report::Records as _;
use vertifleet_study::{DayRecord, Error, MOST_DAYS, PolicySource};

use crate::comparison::write_report;
use crate::failure::{Failure, warn};
use crate::frames::{Columns, frame, loads};
use crate::interruptible::{self, interruptible};
use crate::policy_source::{OwnCalls, policy_source};
use crate::whole_number::WholeNumber;

/// The seed of the random policy and of the planner's search, as in the program.
const SEED: u64 = 0;

/// The results of policies on a day of each of many random networks: one row for each policy and network, and
/// statistics.
#[pyclass(frozen, module = "vertifleet")]
pub(crate) struct Generalisation {
    study: GeneralisationRecords,
}

#[pymethods]
impl Generalisation {
    /// The statistics, as `vertifleet generalise --json` prints them.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        loads(py, &self.study.json().map_err(Failure::from)?)
    }

    /// A row for each policy and network, as a dict of numpy arrays: `policy`, `network`, `seed`, the sizes of the
    /// network, `profit_usd`, `upper_bound_usd` and `bound_share`.
    #[getter]
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = Columns::new(py);
        let rows = || {
            self.study.policies.iter().flat_map(|policy| {
                let days = policy.days.iter().zip(&self.study.networks);
                days.map(move |(day, network)| (policy, day, network))
            })
        };
        columns.texts("policy", rows().map(|(policy, _, _)| policy.name.as_str()))?;
        columns.texts("network", rows().map(|(_, _, network)| network.name.as_str()))?;
        columns.counts("seed", rows().map(|(_, day, _)| day.seed))?;
        columns.counts("vertiports", rows().map(|(_, _, network)| network.vertiports))?;
        columns.counts("aircraft", rows().map(|(_, _, network)| network.aircraft))?;
        columns.numbers("profit_usd", rows().map(|(_, day, _)| day.totals.profit_usd))?;
        columns.numbers("upper_bound_usd", rows().filter_map(|(_, day, _)| day.upper_bound_usd))?;
        let share = |(_, day, _): (_, &DayRecord, _)| day.bound_share();
        columns.numbers("bound_share", rows().filter_map(share))?;
        Ok(columns.into_dict())
    }

    /// The rows as a pandas `DataFrame`.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame(&self.columns(py)?, "pandas")
    }

    /// The rows as a polars `DataFrame`.
    fn to_polars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame(&self.columns(py)?, "polars")
    }

    /// Writes a table, a figure and a report page into a folder, and returns the path of the page. An earlier report in
    /// the folder is replaced, but a read-only one only with `force`. A folder that holds anything else is refused, or,
    /// with `force`, kept under another name.
    #[pyo3(signature = (folder, *, force = false))]
    fn report(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<PathBuf> {
        write_report(py, &self.study, &folder, force)
    }

    fn __str__(&self) -> Result<String, Failure> {
        Ok(self.study.text()?)
    }

    fn __repr__(&self) -> String {
        let (policies, networks) = (self.study.policies.len(), self.study.networks.len());
        format!("<Generalisation: {policies} policies, {networks} networks>")
    }
}

/// Plays a day of each of the first random networks with every policy, and bounds these days. A policy that is a
/// function says what its environment drew its days from.
#[pyfunction]
#[pyo3(signature = (policies, models, *, networks, step, threads, command))]
pub(crate) fn generalise(
    py: Python<'_>,
    policies: Vec<String>,
    models: BTreeMap<String, Bound<'_, PyAny>>,
    networks: WholeNumber,
    step: WholeNumber,
    threads: Option<WholeNumber>,
    command: String,
) -> PyResult<Generalisation> {
    let calls = OwnCalls::default();
    let source = |(name, value): (String, Bound<'_, PyAny>)| {
        let source = policy_source(&value, &name, None, &calls)?;
        Ok((name, source))
    };
    let models =
        models.into_iter().map(source).collect::<PyResult<Vec<(String, PolicySource)>>>()?;
    let step = Step::from_minutes(step.of("step")?).map_err(Failure::from)?;
    let networks: u32 = networks.of("networks")?;
    if !(1..=MOST_DAYS).contains(&networks) {
        let rule = format!("networks must be from 1 to {MOST_DAYS}, found {networks}");
        return Err(Failure::argument(rule).into());
    }
    let outcome = interruptible(py, interruptible::threads(threads)?, move |stop| {
        let selection = Selection { policies: &policies, models: &models, seed: SEED };
        let generalisation = study::Generalisation::new(&selection, networks, step)?;
        let study = generalisation.run(command, stop, &Bars)?;
        Ok::<_, Error>(Generalisation { study })
    })?;
    let generalisation = calls.answered(outcome)?;
    for warning in calls.warnings() {
        warn(py, &warning)?;
    }
    Ok(generalisation)
}
