//! One observation in arrays of its own.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;

/// The numbers of an observation, laid out as its layout says, and its mask.
pub(crate) type Shown<'py> = (Bound<'py, PyArray1<f32>>, Bound<'py, PyArray1<i8>>);

/// Allocates the arrays of an observation and fills them.
pub(crate) fn shown(
    py: Python<'_>,
    width: usize,
    vertiports: usize,
    fill: impl FnOnce(&mut [f32], &mut [i8]),
) -> PyResult<Shown<'_>> {
    let row = PyArray1::zeros(py, width, false);
    let mask = PyArray1::zeros(py, vertiports, false);
    fill(row.readwrite().as_slice_mut()?, mask.readwrite().as_slice_mut()?);
    Ok((row, mask))
}
