//! Expected errors as Python exceptions: `vertifleet.Error`, with the code and the hint that the
//! `vertifleet` program prints.

use pyo3::prelude::{PyAnyMethods, PyErr, Python};
use pyo3::sync::PyOnceLock;
use pyo3::{Py, types::PyType};
use vertifleet_core::{Code, Coded};

/// An expected error before it becomes a Python exception. It can be made on any thread, without
/// the GIL.
#[derive(Debug)]
pub(crate) struct Failure {
    code: Code,
    message: String,
    hint: Option<String>,
}

impl Failure {
    /// V451 argument that is not taken. A function of the Python package was called with an
    /// argument that it does not take. The message names the argument and lists those that the
    /// function takes.
    ///
    /// Fix: give one of the listed arguments.
    pub(crate) fn argument(message: String) -> Self {
        Self { code: Code(451), message, hint: None }
    }

    /// with a hint.
    pub(crate) fn hinted(message: String, hint: String) -> Self {
        Self { hint: Some(hint), ..Self::argument(message) }
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

/// The class of expected errors. It is written in Python because the limited API does not allow
/// subclasses of `Exception` in Rust.
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
        // The program's flags are arguments here.
        let hint = error.hint().map(|hint| {
            hint.replace("--model", "models= (or model=)")
                .replace("by --resume", "by resume=True")
                .replace("replace that study with --force", "remove what is there")
        });
        Self { code: error.code(), message: error.to_string(), hint }
    }
}

/// Emits a Python `UserWarning` about something that is allowed but probably not intended.
pub(crate) fn warn(py: Python<'_>, warning: &str) -> pyo3::PyResult<()> {
    py.import("warnings")?.call_method1("warn", (warning,))?;
    Ok(())
}
