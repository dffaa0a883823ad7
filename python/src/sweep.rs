//! The report of a sweep, in the same form as the program's.

use std::fs;
use std::path::PathBuf;

use pyo3::prelude::*;
use serde::Deserialize;
use serde_json::Value;
use vertifleet_study::ComparisonRecords;
use vertifleet_study::sweep::Sweep;

use crate::comparison::Comparison;
use crate::failure::Failure;
use crate::network::Network;

/// What was varied, and the values of each comparison in this order.
#[derive(Deserialize)]
struct Design {
    paths: Vec<String>,
    values: Vec<Vec<Value>>,
}

/// Writes tables, figures and a report page of a sweep into a folder, and returns the path of the page. `design` is JSON:
/// the `paths` that were varied, and `values` with a list for each of the `comparisons`.
#[pyfunction]
#[pyo3(signature = (network, design, comparisons, folder, *, force, command))]
pub(crate) fn sweep_report(
    py: Python<'_>,
    network: &Network,
    design: &str,
    comparisons: Vec<PyRef<'_, Comparison>>,
    folder: PathBuf,
    force: bool,
    command: String,
) -> PyResult<PathBuf> {
    let Design { paths, values } = serde_json::from_str(design)
        .map_err(|error| Failure::argument(format!("the design of a sweep: {error}")))?;
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
