//! `train`: training with the trainer of the `vertifleet` program, at the same speed.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use serde_json::{Map, Value};
use vertifleet_core::{Outputs, Stop, World};
use vertifleet_learn::{
    Cell, Curve, Error, RunFolder, TrainingRequest, TrainingRun, TrainingSettings, TrainingWatch,
};
use vertifleet_progress::Bar;

use crate::failure::{Failure, warn};
use crate::frames::{Columns, frame, plain};
use crate::interruptible::{self, interruptible};
use crate::model::{Model, borrowed, changes};
use crate::network::Network;
use crate::policy_source::{OwnCalls, Weights};
use crate::whole_number::WholeNumber;

/// The result of a training run: the model, the learning curve, and whether the run is complete.
#[pyclass(frozen, module = "vertifleet")]
pub(crate) struct Training {
    model: Arc<vertifleet_learn::Model>,
    curve: Curve,
    is_done: bool,
}

#[pymethods]
impl Training {
    /// The weights. After PPO, these are the weights that did best on the validation days; after
    /// imitation, the last ones.
    #[getter]
    fn model(&self) -> Model {
        Model { model: Arc::clone(&self.model) }
    }

    /// Whether the run has completed all the training that was requested.
    #[getter]
    fn is_done(&self) -> bool {
        self.is_done
    }

    /// The learning curve as numpy arrays, with the same names as in its CSV file. Entries are NaN
    /// where nothing was measured.
    #[getter]
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = Columns::new(py);
        for (at, name) in self.curve.columns().iter().enumerate() {
            let cells = || self.curve.rows().iter().map(|row| row[at]);
            let count = |cell| if let Cell::Count(count) = cell { Some(count) } else { None };
            if cells().all(|cell| count(cell).is_some()) {
                columns.counts(name, cells().filter_map(count))?;
            } else {
                columns.numbers(name, cells().map(|cell| cell.number().unwrap_or(f64::NAN)))?;
            }
        }
        Ok(columns.into_dict())
    }

    /// The learning curve as a pandas `DataFrame`.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame(&self.columns(py)?, "pandas")
    }

    /// The learning curve as a polars `DataFrame`.
    fn to_polars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame(&self.columns(py)?, "polars")
    }

    fn __repr__(&self) -> String {
        let (kind, steps) = (self.model.kind(), self.curve.steps());
        let state = if self.is_done { "done" } else { "not done" };
        format!("<Training {kind}: {steps} decisions, {state}>")
    }
}

/// The last row of a curve, as a map from column names to values.
fn last_row(curve: &Curve) -> Option<Map<String, Value>> {
    let cells = curve.rows().last()?.iter().map(serde_json::to_value);
    let cells = cells.map(|cell| cell.expect("a number"));
    Some(curve.columns().iter().cloned().zip(cells).collect())
}

/// A network, or the name of networks that are drawn, a new one for each day.
#[derive(FromPyObject)]
pub(crate) enum WorldArgument {
    Drawn(String),
    Network(Network),
}

impl WorldArgument {
    fn world(self) -> Result<World, Failure> {
        match self {
            Self::Drawn(name) => Ok(World::find(&name)?),
            Self::Network(network) => Ok(network.network.into()),
        }
    }
}

/// Trains a policy on a network, or on networks drawn for each day. Ctrl-C
/// ends the run with a checkpoint, from which `resume` continues it.
#[pyfunction]
#[pyo3(signature = (
    network, policy, *, out, preset = "default", settings = None, seed = None, begin_with = None, resume = false,
    force = false, threads = None, watch = None
))]
#[expect(clippy::too_many_arguments, reason = "each has a name in Python")]
pub(crate) fn train(
    py: Python<'_>,
    network: WorldArgument,
    policy: &str,
    out: PathBuf,
    preset: &str,
    settings: Option<&Bound<'_, PyMapping>>,
    seed: Option<WholeNumber>,
    begin_with: Option<Weights<'_>>,
    resume: bool,
    force: bool,
    threads: Option<WholeNumber>,
    watch: Option<Py<PyAny>>,
) -> PyResult<Training> {
    let begun = begin_with.as_ref().map(Weights::model).transpose()?;
    let read = begin_with.as_ref().and_then(Weights::path).map(Path::to_owned);
    let mut policy = vertifleet_learn::sizes(policy, begun.as_deref()).ok_or_else(|| {
        let rule =
            format!("policy must be gcaps, mlp, gcaps-x, gcaps-full or mlp-full, found {policy:?}");
        Failure::argument(rule)
    })?;
    let mut of_run = TrainingSettings::preset(&policy, preset).map_err(Failure::from)?;
    if let Some(settings) = settings {
        let named = changes(settings)?;
        vertifleet_learn::set(&mut policy, &mut of_run, borrowed(&named)).map_err(Failure::from)?;
    }
    let plan = TrainingRequest {
        world: network.world()?,
        policy,
        settings: of_run,
        seed: seed.map_or(Ok(1), |seed| seed.of("seed"))?,
        begin_with: begun.as_deref().cloned(),
        commit: format!("python {}", env!("CARGO_PKG_VERSION")),
    };
    let threads = interruptible::threads(threads)?;
    let calls = OwnCalls::default();
    let of_watch = calls.clone();
    let outcome = interruptible(py, threads, move |stop| {
        let mut outputs = Outputs::new(force);
        if let Some(path) = &read {
            outputs.reads(path);
        }
        let folder = RunFolder::of(&plan.policy, &out);
        let mut run = folder.begin(plan, resume, &mut outputs)?;
        let work = run.work();
        let bar = Bar::new(work.total, work.units);
        bar.already_done(work.done);
        folder.train(
            run.as_mut(),
            stop,
            &Shown { bar, watch, calls: of_watch, stop: stop.clone() },
        )?;
        Ok::<_, Error>(training_of(run.as_ref()))
    })?;
    match calls.raised() {
        Some(error) => Err(error),
        None => Ok(outcome.map_err(Failure::from)?),
    }
}

fn training_of(run: &dyn TrainingRun) -> Training {
    Training { model: Arc::new(run.model()), curve: run.curve(), is_done: run.is_done() }
}

/// Shows the progress of a run, with a bar if there is a terminal, and by calling the caller's
/// function if there is one.
struct Shown {
    bar: Bar,
    watch: Option<Py<PyAny>>,
    calls: OwnCalls,
    stop: Stop,
}

impl TrainingWatch for Shown {
    fn has_worked(&self, units: u64) {
        self.bar.advance(units);
    }

    fn has_learned(&self, curve: &Curve, steps_per_second: f64) {
        self.bar.show_message(format!("{steps_per_second:.0} decisions/s"));
        let (Some(watch), Some(row)) = (&self.watch, last_row(curve)) else { return };
        let called = Python::attach(|py| watch.call1(py, (plain(py, &row)?,)).map(|_| ()));
        if let Err(error) = called {
            self.calls.raise(error);
            self.stop.request();
        }
    }

    fn could_not_write(&self, error: &Error) {
        let warning = format!("{error}; the training goes on");
        // If the warning itself raises an exception, the training still goes on.
        let _ = Python::attach(|py| warn(py, &warning));
    }
}
