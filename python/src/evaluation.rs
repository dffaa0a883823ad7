//! `evaluate` and `verify`: policies on frozen suites, and result files.

use std::collections::BTreeMap;
use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vertifleet_core::{self as core, check_output, create_folder};
use vertifleet_progress::Bars;
use vertifleet_study::competitor::Selection;
use vertifleet_study::evaluation::{
    self as study, EvaluationRecords, EvaluationReport, ResultFile, TrainingRun,
};
use vertifleet_study::{DayRecord, Error, PolicyRecord, PolicySource, SUITES, Suite};

use crate::failure::{Failure, warn};
use crate::frames::{Columns, frame, loads, plain};
use crate::interruptible::{self, interruptible};
use crate::network::Network;
use crate::policy_source::{OwnCalls, policy_source};
use crate::scenario::Scenario;
use crate::whole_number::WholeNumber;

/// The seed of the random policy and of the planner's search, the same for everyone.
const SEED: u64 = 1;

/// The results of policies on one or more suites: shares of the certified bounds, and one row for
/// each suite, policy and day.
#[pyclass(frozen, module = "vertifleet")]
pub(crate) struct Evaluation {
    suites: Vec<EvaluationRecords>,
    warnings: Vec<String>,
}

impl Evaluation {
    fn report(&self) -> Result<EvaluationReport, Failure> {
        Ok(EvaluationReport::of(&self.suites)?)
    }
}

#[pymethods]
impl Evaluation {
    /// The mean share of the certified bound, by suite and policy.
    #[getter]
    fn bound_share<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let suites = PyDict::new(py);
        for suite in self.report()?.suites {
            let shares = PyDict::new(py);
            for policy in suite.policies {
                shares.set_item(policy.share.name, policy.share.bound_share.mean)?;
            }
            suites.set_item(suite.suite, shares)?;
        }
        Ok(suites)
    }

    /// The statistics, as `vertifleet evaluate --json` prints them.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        loads(py, &self.report()?.to_json())
    }

    /// A row for each suite, policy and day, as a dict of numpy arrays, one for each column, in
    /// dollars, kWh and counts.
    #[getter]
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = Columns::new(py);
        let rows = || {
            self.suites.iter().flat_map(|suite| {
                let policies = suite.policies.iter();
                policies
                    .flat_map(move |policy| policy.days.iter().map(move |day| (suite, policy, day)))
            })
        };
        let days = || rows().map(|(_, _, day): (_, &PolicyRecord, &DayRecord)| day);
        columns.texts("suite", rows().map(|(suite, _, _)| suite.suite.name.as_ref()))?;
        columns.texts("policy", rows().map(|(_, policy, _)| policy.name.as_str()))?;
        columns.texts("day", days().map(|day| day.day.as_str()))?;
        columns.counts("seed", days().map(|day| day.seed))?;
        let names = days().next().map(|day| day.totals.numbers().map(|(name, _)| name));
        for (at, name) in names.into_iter().flatten().enumerate() {
            columns.day_numbers(name, days().map(|day| day.totals.numbers()[at].1))?;
        }
        columns.numbers("upper_bound_usd", days().filter_map(|day| day.upper_bound_usd))?;
        columns.numbers("bound_share", days().filter_map(DayRecord::bound_share))?;
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

    /// Warnings about what is allowed but probably not intended, such as a policy that cannot play
    /// a suite.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// Writes a result file for each suite and policy into a folder, and returns their paths.
    /// `about` is what you say about the policy, as ``{"training": "none"}``; the protocol lists
    /// what is expected. `runs` names the training run that a policy is, for `board`, as
    /// ``{"mine-2": ("mine", 2)}``: its method and its seed, which may be None where weights of
    /// Vertifleet state it. An existing file that is read-only or not a result is replaced only
    /// with `force`.
    #[pyo3(signature = (folder, *, about = BTreeMap::new(), runs = BTreeMap::new(), force = false))]
    fn save(
        &self,
        folder: PathBuf,
        about: BTreeMap<String, String>,
        runs: BTreeMap<String, (String, Option<u64>)>,
        force: bool,
    ) -> Result<Vec<PathBuf>, Failure> {
        let run =
            |(policy, (method, training_seed))| (policy, TrainingRun { method, training_seed });
        let runs: BTreeMap<String, TrainingRun> = runs.into_iter().map(run).collect();
        let names = self.suites.iter().flat_map(|suite| {
            let left_out = suite.left_out.iter().map(|one| one.policy.as_str());
            suite.policies.iter().map(|policy| policy.name.as_str()).chain(left_out)
        });
        study::check_runs(&runs, &names.collect::<Vec<_>>())?;
        let results = self.suites.iter().map(|suite| suite.results(&about, &runs));
        let results: Vec<ResultFile> =
            results.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect();
        create_folder(&folder)?;
        let path = |result: &ResultFile| {
            folder.join(ResultFile::file_name(&result.suite, &result.policy.name))
        };
        let mut paths: Vec<PathBuf> = Vec::new();
        for result in &results {
            if paths.contains(&path(result)) {
                let rule = format!("two results would be written to {}", path(result).display());
                let hint = "give the policies names that differ in letters and digits".to_owned();
                return Err(Failure::hinted(rule, hint));
            }
            paths.push(path(result));
            check_output(&path(result), &study::RESULT, force)?;
        }
        results
            .iter()
            .map(|result| Ok(result.write(&path(result)).map(|()| path(result))?))
            .collect()
    }

    fn _repr_html_(&self) -> Result<String, Failure> {
        Ok(vertifleet_report::evaluation(&self.report()?).tables_html())
    }

    fn __str__(&self) -> Result<String, Failure> {
        Ok(vertifleet_report::evaluation(&self.report()?).text())
    }

    fn __repr__(&self) -> String {
        let suites: Vec<&str> = self.suites.iter().map(|suite| &*suite.suite.name).collect();
        format!("<Evaluation on {}>", suites.join(", "))
    }
}

/// Plays a suite with policies; the others are measured against the first.
#[pyfunction]
#[pyo3(signature = (suite, policies, models, *, threads, command))]
pub(crate) fn evaluate(
    py: Python<'_>,
    suite: Vec<String>,
    policies: Vec<String>,
    models: BTreeMap<String, Bound<'_, PyAny>>,
    threads: Option<WholeNumber>,
    command: String,
) -> PyResult<Evaluation> {
    let calls = OwnCalls::default();
    let mut asked = Vec::new();
    for name in suite {
        let suite = Suite::find(&name).map_err(Failure::from)?;
        let shipped = suite.network().and_then(core::Network::shipped);
        let network = shipped.map(|shipped| Network::of(shipped, format!("{:?}", suite.name)));
        let sources = models.iter().map(|(name, value)| {
            Ok((name.clone(), policy_source(value, name, network.as_ref(), &calls)?))
        });
        asked.push((suite, sources.collect::<PyResult<Vec<(String, PolicySource)>>>()?));
    }
    let outcome = interruptible(py, interruptible::threads(threads)?, move |stop| {
        let evaluation = |(suite, models): &(Suite, Vec<(String, PolicySource)>)| {
            let selection = Selection { policies: &policies, models, seed: SEED };
            study::Evaluation::new(suite.clone(), &selection, stop)
        };
        // Everything is checked before the first day is played.
        let evaluations: Vec<_> = asked.iter().map(evaluation).collect::<Result<_, _>>()?;
        let play = |evaluation: study::Evaluation| evaluation.run(command.clone(), stop, &Bars);
        evaluations.into_iter().map(play).collect::<Result<Vec<_>, Error>>()
    })?;
    let suites = calls.answered(outcome)?;
    let left_out = suites.iter().flat_map(|suite: &EvaluationRecords| {
        let text = |one: &study::LeftOut| {
            format!("{} is left out of {}: {}", one.policy, suite.suite.name, one.reason)
        };
        suite.left_out.iter().map(text)
    });
    let warnings: Vec<String> = left_out.chain(calls.warnings()).collect();
    for warning in &warnings {
        warn(py, warning)?;
    }
    Ok(Evaluation { suites, warnings })
}

/// Verifies a result file, and returns what was found as plain data.
#[pyfunction]
pub(crate) fn verify(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyAny>> {
    let result = ResultFile::read(&path).map_err(Failure::from)?;
    let outcome =
        interruptible(py, interruptible::threads(None)?, move |stop| study::verify(&result, stop))?;
    plain(py, &outcome.map_err(Failure::from)?)
}

/// The names of all suites.
#[pyfunction]
pub(crate) fn suite_names() -> Vec<String> {
    SUITES.iter().map(|suite| suite.name.to_string()).collect()
}

/// A suite: its description, its network if it has one, its days, their bounds in dollars, and the
/// minutes of the bounds' slices.
#[pyfunction]
#[expect(clippy::type_complexity, reason = "the Python side gives the members names")]
pub(crate) fn find_suite(
    py: Python<'_>,
    name: String,
) -> PyResult<(String, Option<&'static str>, Vec<Scenario>, Vec<f64>, u32)> {
    let suite = Suite::find(&name).map_err(Failure::from)?;
    let drawn = suite.clone();
    let days =
        interruptible(py, interruptible::threads(None)?, move |stop| drawn.draw_with_bounds(stop))?;
    let days = days.map_err(Failure::from)?;
    let bounds = days.iter().filter_map(|day| day.upper_bound_usd).collect();
    let scenarios = days.into_iter().map(|day| Scenario { scenario: day.scenario }).collect();
    let description = suite.description.to_string();
    Ok((description, suite.network(), scenarios, bounds, suite.step_minutes))
}
