//! Tables for Python: a dict of numpy arrays, and pandas and polars frames if these libraries are
//! installed.

use numpy::ndarray::IntoDimension;
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyList, PyMapping};
use serde::Serialize;
use vertifleet_sim::DayNumber;

use crate::failure::Failure;

/// Columns by name, in their order.
pub(crate) struct Columns<'py>(Bound<'py, PyDict>);

impl<'py> Columns<'py> {
    pub(crate) fn new(py: Python<'py>) -> Self {
        Self(PyDict::new(py))
    }

    /// A column of whole numbers. They are signed, so that the difference of two columns can be
    /// negative and does not wrap around.
    pub(crate) fn counts<T: TryInto<i64>>(
        &self,
        name: &str,
        values: impl IntoIterator<Item = T>,
    ) -> PyResult<()> {
        self.numbers(name, values.into_iter().map(count))
    }

    /// A column of numbers.
    pub(crate) fn numbers<T: Element>(
        &self,
        name: &str,
        values: impl IntoIterator<Item = T>,
    ) -> PyResult<()> {
        self.0.set_item(name, PyArray1::from_iter(self.0.py(), values))
    }

    /// A column with one of the results of each day.
    pub(crate) fn day_numbers(
        &self,
        name: &str,
        values: impl Iterator<Item = DayNumber>,
    ) -> PyResult<()> {
        let (mut amounts, mut counts) = (Vec::new(), Vec::new());
        for value in values {
            match value {
                DayNumber::Amount(amount) => amounts.push(amount),
                DayNumber::Count(count) => counts.push(count),
            }
        }
        if counts.is_empty() { self.numbers(name, amounts) } else { self.counts(name, counts) }
    }

    /// A column of strings, as a numpy array with a string dtype.
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

/// A whole number in the type of this library's arrays.
pub(crate) fn count(value: impl TryInto<i64>) -> i64 {
    value.try_into().unwrap_or(i64::MAX)
}

/// Makes an array read-only. The array is a copy, so writing to it would not change the original.
pub(crate) fn read_only<T>(array: Bound<'_, T>) -> PyResult<Bound<'_, PyAny>> {
    let array = array.into_any();
    array.call_method("setflags", (), Some(&[("write", false)].into_py_dict(array.py())?))?;
    Ok(array)
}

/// The columns as a `library.DataFrame`. If the library is not installed, Python's
/// `ModuleNotFoundError` names it.
pub(crate) fn frame<'py>(
    columns: &Bound<'py, PyDict>,
    library: &str,
) -> PyResult<Bound<'py, PyAny>> {
    columns.py().import(library)?.call_method1("DataFrame", (columns,))
}

/// An array of the given shape, filled row by row with the given entries.
pub(crate) fn table<T: Element>(
    py: Python<'_>,
    entries: impl IntoIterator<Item = T>,
    shape: impl IntoDimension,
) -> PyResult<Bound<'_, PyAny>> {
    Ok(PyArray1::from_iter(py, entries).reshape(shape)?.into_any())
}

/// Plain data as Python's dicts, lists and numbers.
pub(crate) fn plain<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    loads(py, &serde_json::to_string(value).expect("it is plain data"))
}

/// JSON as Python's dicts, lists and numbers.
pub(crate) fn loads<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (json,))
}

/// The members of a mapping as JSON values, in the order of the mapping. `name` is the name of the
/// mapping in messages.
pub(crate) fn members(
    name: &str,
    mapping: &Bound<'_, PyMapping>,
) -> PyResult<Vec<(String, serde_json::Value)>> {
    let py = mapping.py();
    // `json` does not accept the number types of numpy. Their `item` method returns a Python
    // number, which it does accept.
    let item = py.import("operator")?.call_method1("methodcaller", ("item",))?;
    let named = [("default", item)].into_py_dict(py)?;
    let refused = |rule: String| Failure::argument(format!("{name}: {rule}"));
    let json = py.import("json")?.call_method("dumps", (mapping.items()?,), Some(&named));
    let json = json.map_err(|error| refused(error.value(py).to_string()))?;
    // Python writes NaN and infinity, which are not valid JSON.
    let members = serde_json::from_str(&json.extract::<String>()?);
    Ok(members.map_err(|_| refused("names must be texts, and numbers finite".to_owned()))?)
}
