//! `sweep`: many policies on the same days under many settings of a network.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use serde_json::Value;
use vertifleet_core::check_folder;
use vertifleet_progress::Bar;
use vertifleet_report::folder;
use vertifleet_study::Error;
use vertifleet_study::sweep::{self, CellRecord, Factor, Levels, SweepReport};

use crate::comparison::{Comparison, Request};
use crate::failure::{Failure, warn};
use crate::frames::{members, plain};
use crate::interruptible::{self, interruptible};
use crate::network::Network;
use crate::policy_source::OwnCalls;
use crate::whole_number::WholeNumber;

/// The cells of a sweep, and the results of those that are finished. The values of a path in
/// `changes` are a list, or a text as the program's `--vary` takes it. With `latin`, this many
/// cells are drawn with the seed of the days; otherwise every combination is one. Finished cells
/// are kept in the file `journal`, and those that it holds are not played again.
#[pyclass(frozen, module = "vertifleet._native")]
pub(crate) struct Sweep {
    study: Arc<sweep::Sweep>,
    calls: OwnCalls,
    made_from: MadeFrom,
}

/// What a sweep was made from: network, changes, arguments and the number of cells of a Latin
/// hypercube.
type MadeFrom = (Network, Py<PyMapping>, Py<PyMapping>, Option<usize>);

#[pymethods]
impl Sweep {
    #[new]
    #[pyo3(signature = (network, changes, arguments, latin = None, journal = None))]
    fn new(
        py: Python<'_>,
        network: &Network,
        changes: &Bound<'_, PyMapping>,
        arguments: &Bound<'_, PyMapping>,
        latin: Option<WholeNumber>,
        journal: Option<PathBuf>,
    ) -> PyResult<Self> {
        let calls = OwnCalls::default();
        let factors = members("changes", changes)?.into_iter().map(factor);
        let factors = factors.collect::<Result<Vec<Factor>, Failure>>()?;
        let latin: Option<usize> = latin.map(|number| number.of("latin")).transpose()?;
        let made_from =
            (network.clone(), changes.clone().unbind(), arguments.clone().unbind(), latin);
        let request = Request::of(Some(network), arguments.extract()?, &calls)?;
        let made = interruptible(py, interruptible::threads(None)?, move |stop| {
            let mut sweep = request.sweep(factors, latin, stop)?;
            if let Some(journal) = journal {
                sweep.keep_in(&journal, false)?;
            }
            Ok(sweep)
        })?;
        let study = Arc::new(calls.answered(made)?);
        Ok(Self { study, calls, made_from })
    }

    /// What is changed in each cell, and the reason if it is left out.
    fn cells<'py>(
        &'py self,
        py: Python<'py>,
    ) -> PyResult<Vec<(Bound<'py, PyDict>, Option<&'py str>)>> {
        let changed = |cell: &'py sweep::Cell| {
            let changes = PyDict::new(py);
            for (path, value) in self.study.paths().zip(&cell.settings) {
                changes.set_item(path, plain(py, value)?)?;
            }
            Ok((changes, cell.network.as_ref().err().map(String::as_str)))
        };
        self.study.cells().iter().map(changed).collect()
    }

    /// The network of a cell that is not left out.
    fn network(&self, cell: usize) -> PyResult<Network> {
        let network = self.study.cells()[cell].network.clone().map_err(Failure::argument)?;
        Ok(Network::of(*network, format!("cell {cell}")))
    }

    /// Warnings about what is allowed but probably not intended, each once.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        let mut texts = self.study.warnings().to_vec();
        let networks = self.study.cells().iter().filter_map(|cell| cell.network.as_ref().ok());
        for warning in networks.flat_map(|network| network.warnings()) {
            let text = format!("[{}] {warning}", warning.code());
            if !texts.contains(&text) {
                texts.push(text);
            }
        }
        texts
    }

    /// The numbers of the cells that are still to be played.
    fn missing(&self) -> Vec<usize> {
        self.study.missing()
    }

    /// Plays the cells that are missing.
    #[pyo3(signature = (*, threads))]
    fn run(&self, py: Python<'_>, threads: Option<WholeNumber>) -> PyResult<()> {
        let study = Arc::clone(&self.study);
        let outcome = interruptible(py, interruptible::threads(threads)?, move |stop| {
            let (all, missing) = (study.playable(), study.missing().len());
            let bar = Bar::new(all as u64, "cells");
            bar.already_done((all - missing) as u64);
            study.run(stop, &|| bar.advance(1))
        })?;
        self.calls.answered(outcome)?;
        self.calls.warnings().iter().try_for_each(|warning| warn(py, warning))
    }

    /// Adds a cell that was played elsewhere.
    fn add(&self, py: Python<'_>, cell: usize, comparison: &Comparison) -> PyResult<()> {
        let record = CellRecord::of(cell, &comparison.records().policies);
        Ok(py.detach(|| self.study.add(record)).map_err(Failure::from)?)
    }

    /// The comparison in each cell, which records its command; None for a cell that is not
    /// finished.
    fn comparisons(
        &self,
        py: Python<'_>,
        commands: Vec<String>,
    ) -> PyResult<Vec<Option<Comparison>>> {
        let study = Arc::clone(&self.study);
        let outcome = interruptible(py, interruptible::threads(None)?, move |stop| {
            let comparison = |(cell, command): (usize, String)| {
                let found = study.comparison(cell, command, stop)?;
                Ok(found.map(|(records, warnings)| Comparison::new(records, warnings)))
            };
            commands.into_iter().enumerate().map(comparison).collect()
        })?;
        self.calls.answered(outcome)
    }

    /// Writes tables, figures and a report page of the finished cells into a folder, and returns
    /// the path of the page.
    #[pyo3(signature = (folder, *, force, command))]
    fn report(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        force: bool,
        command: String,
    ) -> PyResult<PathBuf> {
        let write = || {
            check_folder(&folder, &folder::SWEEP, force)?;
            let summary = SweepReport::of(&self.study, command)?;
            self.study.write_journal(&folder)?;
            folder::write_beside_journal(&vertifleet_report::sweep(&summary, &self.study), &folder)
        };
        Ok(py.detach(write).map_err(|error: Error| Failure::from(error))?)
    }

    fn __getnewargs__(&self, py: Python<'_>) -> MadeFrom {
        let (network, changes, arguments, latin) = &self.made_from;
        (network.clone(), changes.clone_ref(py), arguments.clone_ref(py), *latin)
    }

    fn __getstate__(&self) -> String {
        let finished: Vec<&CellRecord> = self.study.finished().collect();
        serde_json::to_string(&finished).expect("records are plain data")
    }

    fn __setstate__(&self, finished: &str) -> Result<(), Failure> {
        let finished: Vec<CellRecord> = serde_json::from_str(finished)
            .map_err(|error| Failure::argument(format!("no sweep: {error}")))?;
        Ok(finished.into_iter().try_for_each(|record| self.study.add(record))?)
    }
}

fn factor((path, values): (String, Value)) -> Result<Factor, Failure> {
    match values {
        Value::Array(values) => Ok(Factor { path, levels: Levels::List(values) }),
        Value::String(text) => Ok(Factor::parse(&format!("{path}={text}"))?),
        other => Err(Failure::argument(format!(
            "changes: {path} must have a list of values, found {other}"
        ))),
    }
}
