//! Pickling: the function that makes an object again, and its arguments.

use pyo3::prelude::*;
use pyo3::type_object::PyTypeInfo;

/// A function of the class, and its arguments.
pub(crate) type Reduced<'py, A> = PyResult<(Bound<'py, PyAny>, A)>;

/// That the function `maker` of the class makes it again.
pub(crate) fn reduced<'py, T: PyTypeInfo, A>(
    py: Python<'py>,
    maker: &str,
    arguments: A,
) -> Reduced<'py, A> {
    Ok((py.get_type::<T>().getattr(maker)?, arguments))
}
