//! `Picture`: an SVG that notebooks show, and frames of environments.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use vertifleet_core::{VertiportIx, write_atomically};
use vertifleet_picture::{self as picture, FRAME, Moment};
use vertifleet_sim::{Simulation, TraceRow};

use crate::day::Day;
use crate::failure::Failure;

/// A picture. Notebooks show it; `save` writes it.
#[pyclass(frozen, module = "vertifleet")]
pub(crate) struct Picture {
    pub(crate) text: String,
}

#[pymethods]
impl Picture {
    /// The picture as SVG.
    #[getter]
    fn svg(&self) -> &str {
        &self.text
    }

    /// The picture as PNG, twice as large.
    fn png<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &py.detach(|| picture::png(&self.text)))
    }

    /// Writes the picture into a file, whose name ends in `.svg` or `.png`. An existing file is
    /// replaced.
    fn save(&self, py: Python<'_>, path: PathBuf) -> Result<(), Failure> {
        py.detach(|| {
            let ends_in =
                |end| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(end));
            let bytes = if ends_in("png") {
                picture::png(&self.text)
            } else if ends_in("svg") {
                self.text.clone().into_bytes()
            } else {
                let rule =
                    format!("a picture is written as .svg or .png, not as {}", path.display());
                return Err(Failure::argument(rule));
            };
            Ok(write_atomically(&path, &bytes)?)
        })
    }

    fn _repr_svg_(&self) -> &str {
        &self.text
    }

    fn __repr__(&self) -> String {
        format!("<Picture of {} characters of SVG>", self.text.len())
    }
}

/// A day in progress after these choices, as a frame: [height, width, 3], 0 to 255.
pub(crate) fn frame<'py>(
    py: Python<'py>,
    day: &Day,
    choices: &[u16],
) -> PyResult<Bound<'py, PyAny>> {
    let pixels = py.detach(|| {
        let svg = picture::frame(day.day(), &moment(day, choices), deciding(day));
        picture::rgb(&svg)
    });
    let (width, height) = (FRAME.0 as usize, FRAME.1 as usize);
    Ok(PyArray1::from_vec(py, pixels).reshape([height, width, 3])?.into_any())
}

/// The same as text.
pub(crate) fn text(day: &Day, choices: &[u16]) -> String {
    picture::text(day.day(), &moment(day, choices), deciding(day))
}

/// The vertiport of the aircraft that decides, unless the day is over.
fn deciding(day: &Day) -> Option<VertiportIx> {
    (!day.is_over()).then(|| day.decision().at)
}

/// The fleet after these choices. Playing them again takes less time than painting, and an
/// environment that is never rendered keeps no trace.
fn moment(day: &Day, choices: &[u16]) -> Moment {
    let mut simulation = Simulation::new(Arc::clone(day.simulation().scenario()));
    let mut rows: Vec<TraceRow> = Vec::with_capacity(choices.len());
    for &choice in choices {
        simulation.next_decision().expect("the day took these choices");
        rows.push(simulation.apply(VertiportIx(choice)).expect("the day took these choices"));
    }
    Moment::of(day.day(), &rows, day.decision().time)
}
