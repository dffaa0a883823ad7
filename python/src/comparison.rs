//! `compare`: many policies on many days.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vertifleet_core::{self as core, DaySeed};
use vertifleet_learn::Scales;
use vertifleet_optimize::Step;
use vertifleet_progress::Bars;
use vertifleet_study::comparison;
use vertifleet_study::entrants::Asked;
use vertifleet_study::policies::Given;
use vertifleet_study::{DayRecord, Error, Study, Summary, report, table};

use crate::failure::Failure;
use crate::frames::{Columns, frame, loads};
use crate::given::{Raised, given};
use crate::interruptible::{self, interruptible};
use crate::network::Network;
use crate::pickle::{Reduced, reduced};
use crate::whole::Whole;

/// Many policies on the same days: every policy's every day, and the statistics of them.
#[pyclass(frozen, module = "vertifleet")]
#[derive(Clone)]
pub(crate) struct Comparison {
    study: Study,
    warnings: Vec<String>,
}

#[pymethods]
impl Comparison {
    /// A row for each policy and day, as numpy arrays by column: dollars, kWh, counts. `upper_bound` and `bound_share` are there where
    /// bounds were asked for.
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
        columns.numbers("profit", days().map(|day| day.profit_usd))?;
        columns.numbers("revenue", days().map(|day| day.revenue_usd))?;
        columns.numbers("passenger_cost", days().map(|day| day.passenger_cost_usd))?;
        columns.numbers("energy_cost", days().map(|day| day.energy_cost_usd))?;
        columns.numbers("energy_kwh", days().map(|day| day.energy_kwh))?;
        columns.numbers("potential", days().map(|day| day.potential_usd))?;
        columns.numbers("reward", days().map(|day| day.reward))?;
        columns.counts("flights", days().map(|day| day.flights))?;
        columns.counts("repositioning_flights", days().map(|day| day.repositioning_flights))?;
        columns.counts("holds", days().map(|day| day.holds))?;
        columns.counts("decisions", days().map(|day| day.decisions))?;
        columns.counts("passengers", days().map(|day| day.passengers))?;
        columns.counts("spilled_passengers", days().map(|day| day.spilled_passengers))?;
        columns.numbers("load_factor", days().map(|day| day.load_factor))?;
        if self.study.bound_step_s.is_some() {
            columns.numbers("upper_bound", days().filter_map(|day| day.upper_bound_usd))?;
            columns.numbers("bound_share", days().filter_map(DayRecord::bound_share))?;
        }
        Ok(columns.into_dict())
    }

    /// What is allowed but hardly meant, such as shipped weights on a changed copy of their network.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// Its rows as a pandas frame.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame(&self.columns(py)?, "pandas")
    }

    /// Its rows as a polars frame.
    fn to_polars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame(&self.columns(py)?, "polars")
    }

    /// The statistics, as `vertifleet compare --json` prints them: means with confidence intervals, paired tests, times per decision.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        loads(py, &Summary::of(&self.study).map_err(Failure::from)?.to_json())
    }

    /// Writes table, figures and a report page into a folder; returns the path of the page.
    fn report(&self, py: Python<'_>, folder: PathBuf) -> Result<PathBuf, Failure> {
        Ok(py.detach(|| report::write(&self.study, &folder))?.report)
    }

    /// All days of some comparisons of the same policies, each of which goes on with the day after the last of the one before it.
    /// Of the times per decision, the highest of the parts' are kept.
    #[staticmethod]
    fn join(parts: Vec<PyRef<'_, Self>>) -> Result<Self, Failure> {
        let studies = parts.iter().map(|part| part.study.clone()).collect();
        let mut warnings: Vec<String> = Vec::new();
        for warning in parts.iter().flat_map(|part| &part.warnings) {
            if !warnings.contains(warning) {
                warnings.push(warning.clone());
            }
        }
        Ok(Self { study: Study::join(studies)?, warnings })
    }

    /// What `pickle` keeps, read back.
    #[staticmethod]
    #[pyo3(signature = (text, warnings = Vec::new()))]
    fn from_json(text: &str, warnings: Vec<String>) -> Result<Self, Failure> {
        let study = serde_json::from_str(text);
        let study = study.map_err(|error| Failure::argument(format!("no comparison: {error}")))?;
        // Whatever is shown of it rests on what statistics check.
        Summary::of(&study)?;
        Ok(Self { study, warnings })
    }

    fn __str__(&self) -> Result<String, Failure> {
        Ok(table::text(&Summary::of(&self.study)?))
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

/// Days that a comparison may have, as in the program.
const DAYS: u32 = 1_000_000;

/// What is asked for, by its names in Python: `policies` as `vertifleet compare` names them; what names stand for in `models`, weight
/// files, `Model`s or functions; `bound` for upper bounds with prices that stay the same for `step` minutes; `policy_seed` of the random
/// policy and of the planner's search.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Wanted<'py> {
    policies: Vec<String>,
    days: Whole,
    seed: Whole,
    models: BTreeMap<String, Bound<'py, PyAny>>,
    bound: bool,
    step: Whole,
    policy_seed: Whole,
}

/// The same in Rust's words, checked one by one.
struct Wish {
    network: Arc<core::Network>,
    policies: Vec<String>,
    days: u32,
    seed: u64,
    models: Vec<(String, Given)>,
    step: Option<Step>,
    policy_seed: u64,
}

impl Wish {
    fn of(network: &Network, wanted: Wanted<'_>, raised: &Raised) -> PyResult<Self> {
        let Wanted { policies, days, seed, models, bound, step, policy_seed } = wanted;
        let days = days.of("days")?;
        if days > DAYS {
            let message = format!("days must be at most {DAYS}, found {days}");
            return Err(Failure::argument(message).into());
        }
        let step = Step::from_minutes(step.of("step")?);
        let scales = Scales::from(network.network.feature_scales());
        let given = |(name, value)| Ok((name, given(&value, scales, raised)?));
        Ok(Self {
            network: Arc::clone(&network.network),
            policies,
            days,
            seed: seed.of("seed")?,
            models: models.into_iter().map(given).collect::<PyResult<_>>()?,
            step: bound.then_some(step).transpose().map_err(Failure::from)?,
            policy_seed: policy_seed.of("policy_seed")?,
        })
    }

    /// The comparison on so many of the days.
    fn on(&self, days: u32, stopped: &AtomicBool) -> Result<comparison::Comparison, Error> {
        let Self { network, policies, seed, models, step, policy_seed, .. } = self;
        let asked = Asked { policies, models, seed: *policy_seed, network: network.name() };
        comparison::Comparison::new(network, &asked, (*seed, days), *step, stopped)
    }
}

/// Looks for all that can be found wrong with a comparison before its days are played; returns what is to be said of it.
#[pyfunction]
#[pyo3(signature = (network, asked))]
pub(crate) fn check_comparison(
    py: Python<'_>,
    network: &Network,
    asked: Wanted<'_>,
) -> PyResult<Vec<String>> {
    let wish = Wish::of(network, asked, &Raised::default())?;
    let warnings = interruptible(py, 1, move |stop| {
        DaySeed::comparison(wish.seed.saturating_add(wish.days.saturating_sub(1).into()))?;
        Ok::<_, Error>(wish.on(wish.days.min(1), stop)?.warnings().collect())
    })?;
    Ok(warnings.map_err(Failure::from)?)
}

/// Plays days of a network, the first of seed `seed`, with every policy; all meet the same days. `command` is what the report says it
/// was made with. What is allowed but hardly meant is told by the result's `warnings`.
#[pyfunction]
#[pyo3(signature = (network, asked, *, threads = None, command = ""))]
pub(crate) fn compare(
    py: Python<'_>,
    network: &Network,
    asked: Wanted<'_>,
    threads: Option<Whole>,
    command: &str,
) -> PyResult<Comparison> {
    let raised = Raised::default();
    let wish = Wish::of(network, asked, &raised)?;
    let (threads, command) = (interruptible::threads(threads)?, command.to_owned());
    let outcome = interruptible(py, threads, move |stop| {
        let comparison = wish.on(wish.days, stop)?;
        let warnings = comparison.warnings().collect();
        let study = comparison.run(command, stop, &Bars)?;
        Ok::<_, Error>(Comparison { study, warnings })
    })?;
    match raised.take() {
        Some(error) => Err(error),
        None => Ok(outcome.map_err(Failure::from)?),
    }
}
