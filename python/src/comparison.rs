//! `compare`: many policies on many days.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vertifleet_core::{self as core, Stop};
use vertifleet_optimize::Step;
use vertifleet_progress::Bars;
use vertifleet_report::{comparison_folder, folder};
use vertifleet_study::comparison::DrawnDays;
use vertifleet_study::competitor::Selection;
use vertifleet_study::sweep::{Design, Factor, Sweep, SweepRequest};
use vertifleet_study::{
    ComparisonRecords, ComparisonReport, DayRecord, Error, MOST_DAYS, OwnDays, PolicySource,
    comparison,
};

use crate::days::purpose_of;
use crate::failure::{Failure, warn};
use crate::frames::{Columns, frame, loads};
use crate::interruptible::{self, interruptible};
use crate::network::Network;
use crate::pickle::{Reduced, reduced};
use crate::policy_source::{OwnCalls, policy_source};
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
    /// A row for each policy and day, as a dict of numpy arrays, one for each column, in dollars,
    /// kWh and counts. `upper_bound_usd` and `bound_share` are present only if bounds were
    /// requested.
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

    /// Warnings about what is allowed but probably not intended, such as shipped weights on a
    /// changed copy of their network.
    #[getter]
    pub(crate) fn warnings(&self) -> Vec<String> {
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

    /// The statistics, as `vertifleet compare --json` prints them: means with confidence intervals,
    /// paired tests, times per decision.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        loads(py, &self.statistics()?.to_json())
    }

    /// Writes a table, figures and a report page into a folder, and returns the path of the page.
    /// An earlier report in the folder is replaced, but a read-only one only with `force`. A folder
    /// that holds anything else is refused, or, with `force`, kept under another name.
    #[pyo3(signature = (folder, *, force = false))]
    fn report(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<PathBuf> {
        let written = py.detach(|| -> Result<_, Failure> {
            Ok(folder::write(&comparison_folder(&self.statistics()?, &self.study), &folder, force)?)
        })?;
        if let Some(kept) = &written.kept {
            warn(py, &format!("what was there before is now {}", kept.display()))?;
        }
        Ok(written.page)
    }

    /// Joins comparisons of the same policies into one. Each part must begin with the day after the
    /// last day of the part before it. Each time per decision in the result is the highest one
    /// among the parts.
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
        // The statistics check the records, and everything that is shown of a comparison relies on
        // these checks.
        ComparisonReport::of(&study)?;
        Ok(Self { study, warnings })
    }

    fn _repr_html_(&self) -> Result<String, Failure> {
        Ok(comparison_folder(&self.statistics()?, &self.study).tables_html())
    }

    fn __str__(&self) -> Result<String, Failure> {
        Ok(comparison_folder(&self.statistics()?, &self.study).text())
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

impl Comparison {
    /// A comparison with these records.
    pub(crate) fn new(study: ComparisonRecords, warnings: Vec<String>) -> Self {
        Self { study, warnings }
    }

    fn statistics(&self) -> Result<ComparisonReport, Failure> {
        Ok(ComparisonReport::of(&self.study)?)
    }

    /// The records of the comparison.
    pub(crate) fn records(&self) -> &ComparisonRecords {
        &self.study
    }
}

/// The arguments of a comparison, by their names in Python. `policies` are names as in `vertifleet
/// compare`. `models` maps names to weight files, `Model`s or functions. `bound` requests upper
/// bounds with slices of `step` minutes. `policy_seed` is the seed of the random policy and of the
/// planner's search.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Arguments<'py> {
    policies: Vec<String>,
    days: Days,
    models: BTreeMap<String, Bound<'py, PyAny>>,
    bound: bool,
    step: WholeNumber,
    policy_seed: WholeNumber,
}

/// The days of a comparison: `days` of them drawn from a network, the first from `seed`, or the
/// caller's own, with a text that says where they came from.
#[derive(FromPyObject)]
enum Days {
    Own { scenarios: Vec<Py<Scenario>>, origin: String },
    Drawn { days: WholeNumber, seed: WholeNumber, split: String },
}

/// A comparison that was asked for, with its arguments checked and converted to Rust types.
pub(crate) struct Request {
    network: Option<Arc<core::Network>>,
    days: RequestedDays,
    policies: Vec<String>,
    models: Vec<(String, PolicySource)>,
    step: Option<Step>,
    policy_seed: u64,
}

enum RequestedDays {
    Own(OwnDays),
    Drawn(DrawnDays),
}

impl Request {
    /// A policy that is a function sees the days as days of `network`.
    pub(crate) fn of(
        network: Option<&Network>,
        arguments: Arguments<'_>,
        calls: &OwnCalls,
    ) -> PyResult<Self> {
        let step = Step::from_minutes(arguments.step.of("step")?);
        let source = |(name, value): (String, Bound<'_, PyAny>)| {
            let source = policy_source(&value, &name, network, calls)?;
            Ok((name, source))
        };
        Ok(Self {
            network: network.map(|network| Arc::clone(&network.network)),
            days: arguments.days.checked()?,
            policies: arguments.policies,
            models: arguments.models.into_iter().map(source).collect::<PyResult<_>>()?,
            step: arguments.bound.then_some(step).transpose().map_err(Failure::from)?,
            policy_seed: arguments.policy_seed.of("policy_seed")?,
        })
    }

    /// The comparison on the days, or on no more than `most` of them where days are drawn.
    fn comparison(self, most: u32, stop: &Stop) -> Result<comparison::Comparison, Error> {
        let Self { network, days, policies, models, step, policy_seed } = self;
        let selection = Selection { policies: &policies, models: &models, seed: policy_seed };
        match (days, network) {
            (RequestedDays::Drawn(drawn), Some(network)) => {
                let drawn = DrawnDays { days: drawn.days.min(most), ..drawn };
                comparison::Comparison::new(&network, &selection, drawn, step, stop)
            }
            (RequestedDays::Own(days), _) => comparison::Comparison::of_own(days, &selection, step),
            (RequestedDays::Drawn(_), None) => unreachable!("days are drawn from a network"),
        }
    }

    /// The sweep over these factors; with `latin`, over this many cells of a Latin hypercube.
    pub(crate) fn sweep(
        self,
        factors: Vec<Factor>,
        latin: Option<usize>,
        stop: &Stop,
    ) -> Result<Sweep, Error> {
        let Self { network, days, policies, models, step, policy_seed } = self;
        let selection = Selection { policies: &policies, models: &models, seed: policy_seed };
        let (RequestedDays::Drawn(drawn), Some(network)) = (days, network) else {
            unreachable!("the days of a sweep are drawn from a network")
        };
        let request = SweepRequest {
            network: &network,
            factors,
            design: latin
                .map_or(Design::Grid, |cells| Design::LatinHypercube { cells, seed: drawn.first }),
            selection: &selection,
            drawn,
            bound_step: step,
        };
        Sweep::new(request, stop)
    }
}

impl Days {
    fn checked(self) -> PyResult<RequestedDays> {
        Ok(match self {
            Self::Own { scenarios, origin } => {
                let scenarios = scenarios.iter().map(|day| Arc::clone(&day.get().scenario));
                let days = OwnDays::of(scenarios.collect(), origin).map_err(Failure::from)?;
                RequestedDays::Own(days)
            }
            Self::Drawn { days, seed, split } => {
                let (days, first) = (days.of("days")?, seed.of("seed")?);
                let purpose = purpose_of(&split)?;
                if days > MOST_DAYS {
                    let rule = format!("days must be at most {MOST_DAYS}, found {days}");
                    return Err(Failure::argument(rule).into());
                }
                RequestedDays::Drawn(DrawnDays { purpose, first, days })
            }
        })
    }
}

/// Checks everything about a comparison that can be checked before its days are played, and returns
/// the warnings.
#[pyfunction]
#[pyo3(signature = (network, arguments))]
pub(crate) fn check_comparison(
    py: Python<'_>,
    network: Option<&Network>,
    arguments: Arguments<'_>,
) -> PyResult<Vec<String>> {
    let request = Request::of(network, arguments, &OwnCalls::default())?;
    let warnings = interruptible(py, 1, move |stop| {
        if let RequestedDays::Drawn(drawn) = &request.days {
            drawn.check()?;
        }
        Ok::<_, Error>(request.comparison(1, stop)?.warnings().collect())
    })?;
    Ok(warnings.map_err(Failure::from)?)
}

/// Reads the scenario files for a comparison, and returns the days and a text that says where they
/// came from. A folder stands for all files in it whose names end in `.json`.
#[pyfunction]
pub(crate) fn read_days(paths: Vec<PathBuf>) -> Result<(Vec<Scenario>, String), Failure> {
    let days = OwnDays::read(&paths)?;
    let (scenarios, from) = days.into_parts();
    Ok((scenarios.into_iter().map(|scenario| Scenario { scenario }).collect(), from))
}

/// Plays days with every policy; all policies play the same days. A policy that is a function sees
/// the caller's own days as days of `network`. `command` is the command that the report says it was
/// made with. The `warnings` of the result name what is allowed but probably not intended.
#[pyfunction]
#[pyo3(signature = (network, arguments, *, threads, command))]
pub(crate) fn compare(
    py: Python<'_>,
    network: Option<&Network>,
    arguments: Arguments<'_>,
    threads: Option<WholeNumber>,
    command: String,
) -> PyResult<Comparison> {
    let calls = OwnCalls::default();
    let request = Request::of(network, arguments, &calls)?;
    let outcome = interruptible(py, interruptible::threads(threads)?, move |stop| {
        let comparison = request.comparison(u32::MAX, stop)?;
        let warnings = comparison.warnings().collect();
        let study = comparison.run(command, stop, &Bars)?;
        Ok::<_, Error>(Comparison { study, warnings })
    })?;
    let mut comparison = calls.answered(outcome)?;
    for warning in calls.warnings() {
        warn(py, &warning)?;
        comparison.warnings.push(warning);
    }
    Ok(comparison)
}
