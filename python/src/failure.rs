//! Expected errors as Python exceptions: `vertifleet.Error` with the code and the hint that the program prints.

use pyo3::prelude::{PyAnyMethods, PyErr, Python};
use pyo3::sync::PyOnceLock;
use pyo3::{Py, types::PyType};
use vertifleet_core::{Code, Coded};

/// What went wrong, before Python hears of it: made without Python's lock, on any thread.
#[derive(Debug)]
pub(crate) struct Failure {
    code: Code,
    message: String,
    hint: Option<String>,
}

impl Failure {
    /// V451: an argument that is none of those that are taken. Cause and fix are in the message.
    pub(crate) fn argument(message: String) -> Self {
        Self { code: Code(451), message, hint: None }
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        Python::attach(|py| match class(py) {
            Ok(class) => {
                let arguments = (failure.code.to_string(), failure.message, failure.hint);
                Self::from_type(class.clone(), arguments)
            }
            Err(error) => error,
        })
    }
}

/// The class of expected errors. It is written in Python, as subclasses of `Exception` cannot be in the limited API.
fn class(py: Python<'_>) -> Result<&pyo3::Bound<'_, PyType>, PyErr> {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let class = CLASS.get_or_try_init(py, || {
        let class = py.import("vertifleet._errors")?.getattr("Error")?;
        Ok::<_, PyErr>(class.cast_into::<PyType>()?.unbind())
    })?;
    Ok(class.bind(py))
}

impl<E: Coded> From<E> for Failure {
    fn from(error: E) -> Self {
        let hint = error.hint().map(str::to_owned);
        Self { code: error.code(), message: error.to_string(), hint }
    }
}

/// Says what is allowed but hardly meant, as Python's `UserWarning`.
pub(crate) fn warn(py: Python<'_>, warning: &str) -> pyo3::PyResult<()> {
    py.import("warnings")?.call_method1("warn", (warning,))?;
    Ok(())
}
