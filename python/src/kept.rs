//! The file that the finished parts of a sweep are kept in.

use std::path::PathBuf;

use pyo3::prelude::*;
use vertifleet_study::{KeptComparison, KeptComparisons};

use crate::comparison::Comparison;
use crate::failure::Failure;

/// A part of a study: the number of its network, the seed of its first day, its number of days, and
/// the comparison.
type Part = (usize, u64, usize, Comparison);

/// A file that finished comparisons are added to.
#[pyclass(frozen, module = "vertifleet._native")]
pub(crate) struct KeptParts(KeptComparisons);

#[pymethods]
impl KeptParts {
    /// Opens the file at `path`, or begins it, and returns it with the parts that it holds: the
    /// number of the network, the seed of the first day, the number of days, and the comparison.
    /// `depends_on` is JSON that names everything that the results depend on.
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf, depends_on: &str) -> PyResult<(Self, Vec<Part>)> {
        let depends_on = serde_json::from_str(depends_on)
            .map_err(|error| Failure::argument(format!("what a study depends on: {error}")))?;
        let opened = py.detach(|| KeptComparisons::open(&path, &depends_on));
        let (file, kept) = opened.map_err(Failure::from)?;
        let part = |KeptComparison { point, warnings, records }| {
            let (first, days) = (records.seed.unwrap_or_default(), records.days);
            (point, first, days, Comparison::new(records, warnings))
        };
        Ok((Self(file), kept.into_iter().map(part).collect()))
    }

    /// Adds a comparison on the days of a network. It is on the disk when this returns.
    fn add(&self, py: Python<'_>, point: usize, comparison: &Comparison) -> PyResult<()> {
        let records = comparison.records().clone();
        let kept = KeptComparison { point, warnings: comparison.warnings(), records };
        Ok(py.detach(|| self.0.add(&kept)).map_err(Failure::from)?)
    }
}
