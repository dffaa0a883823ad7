//! Columns as Python likes them: a dict of numpy arrays, and frames of pandas and polars where those are installed.

use numpy::ndarray::IntoDimension;
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyList, PyMapping};
use serde::Serialize;

use crate::failure::Failure;

/// Columns by name, in their order.
pub(crate) struct Columns<'py>(Bound<'py, PyDict>);

impl<'py> Columns<'py> {
    pub(crate) fn new(py: Python<'py>) -> Self {
        Self(PyDict::new(py))
    }

    /// A column of numbers.
    pub(crate) fn numbers<T: Element>(
        &self,
        name: &str,
        values: impl IntoIterator<Item = T>,
    ) -> PyResult<()> {
        self.0.set_item(name, PyArray1::from_iter(self.0.py(), values))
    }

    /// A column of texts, as a numpy array of strings.
    pub(crate) fn texts<'a>(
        &self,
        name: &str,
        values: impl IntoIterator<Item = &'a str>,
    ) -> PyResult<()> {
        let py = self.0.py();
        let list = PyList::empty(py);
        for value in values {
            list.append(value)?;
        }
        self.0.set_item(name, py.import("numpy")?.call_method1("array", (list, "U"))?)
    }

    pub(crate) fn into_dict(self) -> Bound<'py, PyDict> {
        self.0
    }
}

/// The columns as `library.DataFrame`; without the library, Python's own `ModuleNotFoundError` says what to install.
pub(crate) fn frame<'py>(
    columns: &Bound<'py, PyDict>,
    library: &str,
) -> PyResult<Bound<'py, PyAny>> {
    columns.py().import(library)?.call_method1("DataFrame", (columns,))
}

/// An array of this shape with these entries, row by row.
pub(crate) fn table<T: Element>(
    py: Python<'_>,
    entries: impl IntoIterator<Item = T>,
    shape: impl IntoDimension,
) -> PyResult<Bound<'_, PyAny>> {
    Ok(PyArray1::from_iter(py, entries).reshape(shape)?.into_any())
}

/// Plain data as Python's own dicts, lists and numbers.
pub(crate) fn plain<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    loads(py, &serde_json::to_string(value).expect("it is plain data"))
}

/// JSON as Python's own dicts, lists and numbers.
pub(crate) fn loads<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (json,))
}

/// A mapping as the members of a JSON object; `name` is what messages call it.
pub(crate) fn members(
    name: &str,
    mapping: &Bound<'_, PyMapping>,
) -> PyResult<serde_json::Map<String, serde_json::Value>> {
    let py = mapping.py();
    // NumPy's numbers are none of JSON's; their item is.
    let item = py.import("operator")?.call_method1("methodcaller", ("item",))?;
    let named = [("default", item)].into_py_dict(py)?;
    let mapping = py.get_type::<PyDict>().call1((mapping,))?;
    let json = py.import("json")?.call_method("dumps", (mapping,), Some(&named))?;
    let members = serde_json::from_str(&json.extract::<String>()?);
    Ok(members.map_err(|error| Failure::argument(format!("{name}: {error}")))?)
}
