//! The report of a sweep, in the same form as the program's.

use std::fs;
use std::path::PathBuf;

use pyo3::prelude::*;
use serde_json::Value;
use vertifleet_study::ComparisonRecords;
use vertifleet_study::sweep::Sweep;

use crate::comparison::Comparison;
use crate::failure::Failure;
use crate::network::Network;

/// Writes tables, figures and a report page of a sweep into a folder, and returns the path of the page. `values` is a JSON
/// list with a list for each of the `comparisons`: the value of each of the `paths`.
#[pyfunction]
#[pyo3(signature = (network, paths, values, comparisons, folder, *, force, command))]
pub(crate) fn sweep_report(
    py: Python<'_>,
    network: &Network,
    paths: Vec<String>,
    values: &str,
    comparisons: Vec<PyRef<'_, Comparison>>,
    folder: PathBuf,
    force: bool,
    command: String,
) -> PyResult<PathBuf> {
    let values: Vec<Vec<Value>> = serde_json::from_str(values)
        .map_err(|error| Failure::argument(format!("values of a sweep: {error}")))?;
    let comparisons = comparisons.iter().map(|one| one.records());
    let cells: Vec<(Vec<Value>, &ComparisonRecords)> =
        values.into_iter().zip(comparisons).collect();
    let network = &network.network;
    let write = || {
        Sweep::check_folder(&folder, force)?;
        let (sweep, records) = Sweep::of_comparisons(network, &paths, cells)?;
        fs::create_dir_all(&folder).map_err(|cause| vertifleet_study::Error::CannotMakeFolder {
            path: folder.clone(),
            cause,
        })?;
        sweep.records(records, command).write(&folder)
    };
    py.detach(write).map_err(Failure::from)?;
    Ok(folder.join("report.html"))
}
