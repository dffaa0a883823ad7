//! `board`: the methods behind result files, with their training runs as the unit.

use std::path::PathBuf;

use pyo3::prelude::*;
use vertifleet_report::folder;
use vertifleet_study::BoardReport;

use crate::failure::{Failure, warn};
use crate::frames::loads;
use crate::interruptible::{self, interruptible};

/// The methods behind result files, suite by suite: by what they see, then by share of the
/// certified bound, with intervals over training runs and days.
#[pyclass(frozen, module = "vertifleet")]
pub(crate) struct Board {
    summary: BoardReport,
    command: String,
}

#[pymethods]
impl Board {
    /// All numbers, as `vertifleet board --json` prints them.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        loads(py, &self.summary.to_json())
    }

    /// Writes a page with tables and figures, and the same page in Markdown, into a folder, and
    /// returns the path of the page. An earlier report in the folder is replaced, but a read-only
    /// one only with `force`. A folder that holds anything else is refused, or, with `force`, kept
    /// under another name.
    #[pyo3(signature = (folder, *, force = false))]
    fn report(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<PathBuf> {
        let written = py.detach(|| -> Result<_, Failure> {
            let report = vertifleet_report::board(&self.summary, &self.command);
            Ok(folder::write(&report, &folder, force)?)
        })?;
        if let Some(kept) = &written.kept {
            warn(py, &format!("what was there before is now {}", kept.display()))?;
        }
        Ok(written.page)
    }

    fn _repr_html_(&self) -> String {
        vertifleet_report::board(&self.summary, &self.command).tables_html()
    }

    fn __str__(&self) -> String {
        vertifleet_report::board(&self.summary, &self.command).text()
    }

    fn __repr__(&self) -> String {
        let suites: Vec<&str> = self.summary.suites.iter().map(|suite| &*suite.suite).collect();
        format!("<Board on {}>", suites.join(", "))
    }
}

/// Reads and verifies result files; `command` is the call that reports show.
#[pyfunction]
pub(crate) fn board(py: Python<'_>, paths: Vec<PathBuf>, command: String) -> PyResult<Board> {
    let outcome = interruptible(py, interruptible::threads(None)?, move |stop| {
        BoardReport::read(&paths, stop)
    })?;
    Ok(Board { summary: outcome.map_err(Failure::from)?, command })
}
