//! The cells of a sweep and its report, both as the program makes them.

use std::collections::HashSet;
use std::fs;
use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use serde::Deserialize;
use serde_json::Value;
use vertifleet_core::check_folder;
use vertifleet_report::folder;
use vertifleet_study::ComparisonRecords;
use vertifleet_study::sweep::{Cell, Design, Factor, Levels, Sweep, SweepReport};

use crate::comparison::Comparison;
use crate::failure::Failure;
use crate::frames::{members, plain};
use crate::network::Network;
use crate::whole_number::WholeNumber;

/// The network of a cell, or the reason why it has none.
#[derive(IntoPyObject)]
pub(crate) enum Varied {
    Network(Network),
    LeftOut(String),
}

/// The cells of a sweep: what is changed in each, and the network with that change, or the reason
/// why there is none. The values of a path are a list, or a text as the program's `--vary` takes
/// it. With `latin`, this many cells are drawn with `seed`; otherwise every combination is one.
#[pyfunction]
#[pyo3(signature = (network, changes, *, latin, seed))]
pub(crate) fn sweep_cells<'py>(
    py: Python<'py>,
    network: &Network,
    changes: &Bound<'py, PyMapping>,
    latin: Option<WholeNumber>,
    seed: WholeNumber,
) -> PyResult<Vec<(Bound<'py, PyDict>, Varied)>> {
    let factors = members("changes", changes)?.into_iter().map(factor);
    let factors = factors.collect::<Result<Vec<Factor>, Failure>>()?;
    let design = match latin {
        Some(cells) => Design::LatinHypercube { cells: cells.of("latin")?, seed: seed.of("seed")? },
        None => Design::Grid,
    };
    let base = &network.network;
    let cells = py.detach(|| Cell::all(base, &factors, design)).map_err(Failure::from)?;
    let mut said = HashSet::new();
    let cell = |Cell { settings, network: varied }: Cell| {
        let changes = PyDict::new(py);
        for (factor, value) in factors.iter().zip(&settings) {
            changes.set_item(&factor.path, plain(py, value)?)?;
        }
        let varied = match varied {
            Ok(varied) => {
                Varied::Network(network.changed_with_warnings(&changes, *varied, &mut said)?)
            }
            Err(reason) => Varied::LeftOut(reason),
        };
        Ok((changes, varied))
    };
    cells.into_iter().map(cell).collect()
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

/// What was varied, and the values of each cell in this order.
#[derive(Deserialize)]
struct Varying {
    paths: Vec<String>,
    values: Vec<Vec<Value>>,
}

/// Writes tables, figures and a report page of a sweep into a folder, and returns the path of the
/// page. `design` is JSON: the `paths` that were varied, and `values` with a list for each of the
/// `comparisons`, which are None where the cell was left out.
#[pyfunction]
#[pyo3(signature = (network, design, comparisons, folder, *, force, command))]
pub(crate) fn sweep_report(
    py: Python<'_>,
    network: &Network,
    design: &str,
    comparisons: Vec<Option<PyRef<'_, Comparison>>>,
    folder: PathBuf,
    force: bool,
    command: String,
) -> PyResult<PathBuf> {
    let Varying { paths, values } = serde_json::from_str(design)
        .map_err(|error| Failure::argument(format!("the design of a sweep: {error}")))?;
    let comparisons = comparisons.iter().map(|one| one.as_ref().map(|one| one.records()));
    let cells: Vec<(Vec<Value>, Option<&ComparisonRecords>)> =
        values.into_iter().zip(comparisons).collect();
    let network = &network.network;
    let write = || {
        check_folder(&folder, &folder::SWEEP, force)?;
        let (sweep, records) = Sweep::of_comparisons(network, &paths, cells)?;
        fs::create_dir_all(&folder).map_err(|cause| vertifleet_study::Error::CannotMakeFolder {
            path: folder.clone(),
            cause,
        })?;
        let records = sweep.records(records, command);
        let summary = SweepReport::of(&records)?;
        records.write_journal(&folder)?;
        let report = vertifleet_report::sweep(&summary, &records);
        folder::write_beside_journal(&report, &folder)
    };
    Ok(py.detach(write).map_err(Failure::from)?)
}
