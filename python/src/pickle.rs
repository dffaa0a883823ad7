//! Pickling: an object is pickled as a function that restores it, and the arguments of that
//! function.

use pyo3::prelude::*;
use pyo3::type_object::PyTypeInfo;

/// The result of `__reduce__`: a function of the class, and its arguments.
pub(crate) type Reduced<'py, A> = PyResult<(Bound<'py, PyAny>, A)>;

/// Pickles an object as a call of the function `maker` of its class.
pub(crate) fn reduced<'py, T: PyTypeInfo, A>(
    py: Python<'py>,
    maker: &str,
    arguments: A,
) -> Reduced<'py, A> {
    Ok((py.get_type::<T>().getattr(maker)?, arguments))
}
