//! One observation in separate arrays.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use vertifleet_observe::{Layout, Observer, Scene};
use vertifleet_sim::{Decision, View};

/// The numbers of an observation, in the order of its layout, and its mask.
pub(crate) type Shown<'py> = (Bound<'py, PyArray1<f32>>, Bound<'py, PyArray1<i8>>);

/// A pending decision, or, if the day is over, the last one.
pub(crate) fn scene<'a>(view: View<'a>, over: bool, decision: &'a Decision) -> Scene<'a> {
    if over { Scene::over(view, decision) } else { Scene::of(view, decision) }
}

/// Writes an observation into a row, and its mask.
pub(crate) fn show(
    layout: &Layout,
    scene: &Scene<'_>,
    observer: &mut Observer,
    row: &mut [f32],
    mask: &mut [i8],
) {
    layout.write(row, scene, observer);
    mask.fill(0);
    for vertiport in scene.feasible().iter() {
        mask[vertiport.at()] = 1;
    }
}

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
