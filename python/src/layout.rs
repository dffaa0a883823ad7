//! `Layout`: the parts of an observation and their places in its row of numbers.

use pyo3::prelude::*;
use pyo3::types::PyType;
use vertifleet_observe::{self as observe, Part, Sizes};

use crate::failure::Failure;

/// Numbers of vertiports, aircraft, types of aircraft and demand periods.
pub(crate) type SizesTuple = (usize, usize, usize, usize);

/// The parts of an observation in one row of numbers.
#[pyclass(frozen, module = "vertifleet._native")]
#[derive(Clone)]
pub(crate) struct Layout {
    pub(crate) layout: observe::Layout,
}

#[pymethods]
impl Layout {
    /// Lays parts out by their names, for days of up to these numbers of vertiports, aircraft,
    /// types and periods.
    #[new]
    fn new(parts: Vec<String>, sizes: SizesTuple) -> Result<Self, Failure> {
        let part = |name: &String| {
            Part::named(name).ok_or_else(|| {
                let known: Vec<&str> = Part::all().map(|part| part.info().name).collect();
                let rule = format!("an observation has no part {name:?}");
                Failure::hinted(rule, format!("its parts are {}", known.join(", ")))
            })
        };
        let parts = parts.iter().map(part).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { layout: observe::Layout::new(parts, sizes_of(sizes)) })
    }

    /// The parts of a preset by name, or `None` if there is no such preset.
    #[staticmethod]
    fn preset(name: &str) -> Option<Vec<&'static str>> {
        let parts = observe::preset(name)?;
        Some(parts.into_iter().map(|part| part.info().name).collect())
    }

    /// Name, position of the first number, shape, and least and greatest number of each part.
    #[getter]
    fn parts(&self) -> Vec<(&'static str, usize, Vec<usize>, f32, f32)> {
        let parts = self.layout.parts().iter().map(|placed| {
            let info = placed.part.info();
            let shape = placed.part.shape(self.layout.sizes());
            (info.name, placed.first, shape, info.bounds.0, info.bounds.1)
        });
        parts.collect()
    }

    /// Number of numbers in a row.
    #[getter]
    fn width(&self) -> usize {
        self.layout.width()
    }

    /// Whether all parts describe the present alone, without forecasts or announcements.
    #[getter]
    fn shows_present_only(&self) -> bool {
        !self.layout.parts().iter().any(|placed| placed.part.is_ahead())
    }

    /// Pickles the layout as a call of its class.
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> (Bound<'py, PyType>, (Vec<&'static str>, SizesTuple)) {
        let parts = self.layout.parts().iter().map(|placed| placed.part.info().name).collect();
        let Sizes { vertiports, aircraft, types, periods } = self.layout.sizes();
        (py.get_type::<Self>(), (parts, (vertiports, aircraft, types, periods)))
    }
}

pub(crate) fn sizes_of((vertiports, aircraft, types, periods): SizesTuple) -> Sizes {
    Sizes { vertiports, aircraft, types, periods }
}
