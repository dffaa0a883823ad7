//! `compare`: many policies on many days.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vertifleet_core::{self as core, DaySeed, Stop};
use vertifleet_learn::Scales;
use vertifleet_optimize::Step;
use vertifleet_progress::Bars;
use vertifleet_study::competitor::Selection;
use vertifleet_study::report::{self, Records as _};
use vertifleet_study::{
    ComparisonRecords, ComparisonReport, DayRecord, Error, OwnDays, PolicySource, comparison,
};

use crate::failure::{Failure, warn};
use crate::frames::{Columns, frame, loads};
use crate::interruptible::{self, interruptible};
use crate::network::Network;
use crate::pickle::{Reduced, reduced};
use crate::policy_source::{Raised, policy_source};
use crate::scenario::Scenario;
use crate::whole_number::WholeNumber;

/// The results of many policies on the same days: one row for each policy and day, and statistics.
#[pyclass(frozen, module = "vertifleet")]
#[derive(Clone)]
pub(crate) struct Comparison {
    study: ComparisonRecords,
    warnings: Vec<String>,
}

#[pymethods]
impl Comparison {
    /// A row for each policy and day, as a dict of numpy arrays, one for each column, in dollars, kWh and counts.
    /// `upper_bound_usd` and `bound_share` are present only if bounds were requested.
    #[getter]
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = Columns::new(py);
        let days = || self.study.policies.iter().flat_map(|policy| &policy.days);
        let names = self.study.policies.iter();
        columns.texts(
            "policy",
            names.flat_map(|policy| policy.days.iter().map(|_| policy.name.as_str())),
        )?;
        columns.texts("day", days().map(|day| day.day.as_str()))?;
        columns.counts("seed", days().map(|day| day.seed))?;
        let names = days().next().map(|day| day.totals.numbers().map(|(name, _)| name));
        for (at, name) in names.into_iter().flatten().enumerate() {
            columns.day_numbers(name, days().map(|day| day.totals.numbers()[at].1))?;
        }
        if self.study.bound_step_s.is_some() {
            columns.numbers("upper_bound_usd", days().filter_map(|day| day.upper_bound_usd))?;
            columns.numbers("bound_share", days().filter_map(DayRecord::bound_share))?;
        }
        Ok(columns.into_dict())
    }

    /// Warnings about what is allowed but probably not intended, such as shipped weights on a changed copy of their
    /// network.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// The rows as a pandas `DataFrame`.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame(&self.columns(py)?, "pandas")
    }

    /// The rows as a polars `DataFrame`.
    fn to_polars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame(&self.columns(py)?, "polars")
    }

    /// The statistics, as `vertifleet compare --json` prints them: means with confidence intervals, paired tests, times
    /// per decision.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        loads(py, &self.study.json().map_err(Failure::from)?)
    }

    /// Writes a table, figures and a report page into a folder, and returns the path of the page. An earlier report in
    /// the folder is replaced, but a read-only one only with `force`. A folder that holds anything else is refused, or,
    /// with `force`, kept under another name.
    #[pyo3(signature = (folder, *, force = false))]
    fn report(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<PathBuf> {
        let paths = py.detach(|| report::write(&self.study, &folder, force));
        let paths = paths.map_err(Failure::from)?;
        if let Some(kept) = &paths.kept {
            warn(py, &format!("what was there before is now {}", kept.display()))?;
        }
        Ok(paths.page)
    }

    /// Joins comparisons of the same policies into one. Each part must begin with the day after the last day of the
    /// part before it. Each time per decision in the result is the highest one among the parts.
    #[staticmethod]
    fn join(parts: Vec<PyRef<'_, Self>>) -> Result<Self, Failure> {
        let studies = parts.iter().map(|part| part.study.clone()).collect();
        let mut warnings: Vec<String> = Vec::new();
        for warning in parts.iter().flat_map(|part| &part.warnings) {
            if !warnings.contains(warning) {
                warnings.push(warning.clone());
            }
        }
        Ok(Self { study: ComparisonRecords::join(studies)?, warnings })
    }

    /// Restores a comparison from the text that `pickle` keeps.
    #[staticmethod]
    #[pyo3(signature = (text, warnings = Vec::new()))]
    fn from_json(text: &str, warnings: Vec<String>) -> Result<Self, Failure> {
        let study = serde_json::from_str(text);
        let study = study.map_err(|error| Failure::argument(format!("no comparison: {error}")))?;
        // The statistics check the records, and everything that is shown of a comparison relies on these checks.
        ComparisonReport::of(&study)?;
        Ok(Self { study, warnings })
    }

    fn __str__(&self) -> Result<String, Failure> {
        Ok(self.study.text()?)
    }

    fn __repr__(&self) -> String {
        let (policies, days) = (self.study.policies.len(), self.study.days);
        format!("<Comparison on {}: {policies} policies, {days} days>", self.study.network)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Reduced<'py, (String, Vec<String>)> {
        let text = serde_json::to_string(&self.study).expect("records are plain data");
        reduced::<Self, _>(py, "from_json", (text, self.warnings.clone()))
    }
}

/// The highest number of days in a comparison, the same as in the `vertifleet` program.
const DAYS: u32 = 1_000_000;

/// The arguments of a comparison, by their names in Python. `policies` are names as in `vertifleet compare`. `models`
/// maps names to weight files, `Model`s or functions. `bound` requests upper bounds with slices of `step` minutes.
/// `policy_seed` is the seed of the random policy and of the planner's search.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Arguments<'py> {
    policies: Vec<String>,
    days: WholeNumber,
    seed: WholeNumber,
    models: BTreeMap<String, Bound<'py, PyAny>>,
    bound: bool,
    step: WholeNumber,
    policy_seed: WholeNumber,
}

/// The arguments of a comparison other than its days and their seed, checked and converted to Rust types.
struct Request {
    policies: Vec<String>,
    models: Vec<(String, PolicySource)>,
    step: Option<Step>,
    policy_seed: u64,
}

/// Days that are drawn from a network.
struct Drawn {
    network: Arc<core::Network>,
    days: u32,
    seed: u64,
}

impl Request {
    /// A policy that is a function sees the days as days of `network`.
    fn of(network: Option<&Network>, arguments: &Arguments<'_>, raised: &Raised) -> PyResult<Self> {
        let step = Step::from_minutes(arguments.step.of("step")?);
        let scales = network.map(|network| Scales::from(network.network.feature_scales()));
        let source = |(name, value): (&String, &Bound<'_, PyAny>)| {
            Ok((name.clone(), policy_source(value, scales, raised)?))
        };
        Ok(Self {
            policies: arguments.policies.clone(),
            models: arguments.models.iter().map(source).collect::<PyResult<_>>()?,
            step: arguments.bound.then_some(step).transpose().map_err(Failure::from)?,
            policy_seed: arguments.policy_seed.of("policy_seed")?,
        })
    }

    fn selection(&self) -> Selection<'_> {
        let Self { policies, models, policy_seed, .. } = self;
        Selection { policies, models, seed: *policy_seed }
    }

    /// The comparison on the first `days` of the drawn days.
    fn on(&self, drawn: &Drawn, days: u32, stop: &Stop) -> Result<comparison::Comparison, Error> {
        let Drawn { network, seed, .. } = drawn;
        comparison::Comparison::new(network, &self.selection(), *seed, days, self.step, stop)
    }

    /// The comparison on the caller's own days.
    fn on_own(&self, days: OwnDays) -> Result<comparison::Comparison, Error> {
        comparison::Comparison::of_own(days, &self.selection(), self.step)
    }
}

impl Drawn {
    fn of(network: &Network, arguments: &Arguments<'_>) -> Result<Self, Failure> {
        let days = arguments.days.of("days")?;
        if days > DAYS {
            return Err(Failure::argument(format!("days must be at most {DAYS}, found {days}")));
        }
        let network = Arc::clone(&network.network);
        Ok(Self { network, days, seed: arguments.seed.of("seed")? })
    }
}

/// Checks everything about a comparison that can be checked before its days are played, and returns the warnings.
#[pyfunction]
#[pyo3(signature = (network, arguments))]
pub(crate) fn check_comparison(
    py: Python<'_>,
    network: &Network,
    arguments: Arguments<'_>,
) -> PyResult<Vec<String>> {
    let request = Request::of(Some(network), &arguments, &Raised::default())?;
    let drawn = Drawn::of(network, &arguments)?;
    let warnings = interruptible(py, 1, move |stop| {
        DaySeed::comparison(drawn.seed.saturating_add(drawn.days.saturating_sub(1).into()))?;
        Ok::<_, Error>(request.on(&drawn, drawn.days.min(1), stop)?.warnings().collect())
    })?;
    Ok(warnings.map_err(Failure::from)?)
}

/// Plays days of a network with every policy; all policies play the same days. The first day has the seed `seed`.
/// `command` is the command that the report says it was made with. The `warnings` of the result name what is allowed
/// but probably not intended.
#[pyfunction]
#[pyo3(signature = (network, arguments, *, threads = None, command = ""))]
pub(crate) fn compare(
    py: Python<'_>,
    network: &Network,
    arguments: Arguments<'_>,
    threads: Option<WholeNumber>,
    command: &str,
) -> PyResult<Comparison> {
    let raised = Raised::default();
    let request = Request::of(Some(network), &arguments, &raised)?;
    let drawn = Drawn::of(network, &arguments)?;
    played(py, threads, command, &raised, move |stop| request.on(&drawn, drawn.days, stop))
}

/// Reads the scenario files for a comparison, and returns the days and a text that says where they came from. A folder
/// stands for all files in it whose names end in `.json`.
#[pyfunction]
pub(crate) fn read_days(paths: Vec<PathBuf>) -> Result<(Vec<Scenario>, String), Failure> {
    let days = OwnDays::read(&paths)?;
    let (scenarios, from) = days.into_parts();
    Ok((scenarios.into_iter().map(|scenario| Scenario { scenario }).collect(), from))
}

/// Plays the caller's own days with every policy. `origin` says where they came from. The arguments `days` and `seed`
/// are ignored here. A policy that is a function sees the days as days of `network`.
#[pyfunction]
#[pyo3(signature = (scenarios, origin, network, arguments, *, threads = None, command = ""))]
pub(crate) fn compare_own(
    py: Python<'_>,
    scenarios: Vec<Py<Scenario>>,
    origin: String,
    network: Option<&Network>,
    arguments: Arguments<'_>,
    threads: Option<WholeNumber>,
    command: &str,
) -> PyResult<Comparison> {
    let raised = Raised::default();
    let request = Request::of(network, &arguments, &raised)?;
    let scenario = |day: &Py<Scenario>| Arc::clone(&day.get().scenario);
    let days = OwnDays::of(scenarios.iter().map(scenario).collect(), origin);
    let days = days.map_err(Failure::from)?;
    played(py, threads, command, &raised, move |_| request.on_own(days))
}

/// Makes a comparison and plays it on its own threads.
fn played(
    py: Python<'_>,
    threads: Option<WholeNumber>,
    command: &str,
    raised: &Raised,
    made: impl FnOnce(&Stop) -> Result<comparison::Comparison, Error> + Send + 'static,
) -> PyResult<Comparison> {
    let (threads, command) = (interruptible::threads(threads)?, command.to_owned());
    let outcome = interruptible(py, threads, move |stop| {
        let comparison = made(stop)?;
        let warnings = comparison.warnings().collect();
        let study = comparison.run(command, stop, &Bars)?;
        Ok::<_, Error>(Comparison { study, warnings })
    })?;
    match raised.take() {
        Some(error) => Err(error),
        None => Ok(outcome.map_err(Failure::from)?),
    }
}
