//! `View`: a decision and a policy's view of the day.

use std::sync::{Arc, Mutex, PoisonError};

use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use vertifleet_core::AircraftIx;
use vertifleet_observe::{Observer, Part, Scene, write_in_units};
use vertifleet_sim::{Decision, Snapshot};

use crate::frames::read_only;
use crate::layout::Layout;
use crate::observation::{Shown, scene, show, shown};

/// A decision, and the policy's view of the day at that moment.
#[pyclass(frozen, module = "vertifleet._native")]
pub(crate) struct View {
    snapshot: Snapshot,
    decision: Decision,
    over: bool,
    /// The state that the views of a day share, so that its bid prices are computed once.
    observer: Arc<Mutex<Observer>>,
}

#[pymethods]
impl View {
    /// The array of a part in its unit, read-only; it belongs to the caller.
    fn array<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let Some(part) = Part::of_view(name) else {
            return Err(PyAttributeError::new_err(format!("a view has no {name:?}")));
        };
        let scene = self.scene();
        let shape = part.shape(scene.sizes());
        let array = PyArray1::zeros(py, part.len(scene.sizes()), false);
        let observer = self.observer.lock().unwrap_or_else(PoisonError::into_inner);
        write_in_units(part, array.readwrite().as_slice_mut()?, &scene, &observer);
        drop(observer);
        read_only(array.reshape(shape)?.into_any())
    }

    /// The numbers of an observation, and its mask.
    fn observe<'py>(&self, py: Python<'py>, layout: &Layout) -> PyResult<Shown<'py>> {
        let (layout, scene) = (&layout.layout, self.scene());
        shown(py, layout.width(), layout.sizes().vertiports, |row, mask| {
            let mut observer = self.observer.lock().unwrap_or_else(PoisonError::into_inner);
            show(layout, &scene, &mut observer, row, mask);
        })
    }

    /// Position of the aircraft that decides, or, when the day is over, of the aircraft that
    /// decided last.
    #[getter]
    fn aircraft(&self) -> u16 {
        self.decision.aircraft.0
    }

    /// Position of that aircraft's type.
    #[getter]
    fn aircraft_type(&self) -> usize {
        self.snapshot.view().kind(self.decision.aircraft).at()
    }

    /// Position of the vertiport where that aircraft stands.
    #[getter]
    fn place(&self) -> u16 {
        self.decision.at.0
    }

    /// Number of seats of that aircraft.
    #[getter]
    fn seats(&self) -> u16 {
        let view = self.snapshot.view();
        view.aircraft_type(view.kind(self.decision.aircraft)).seats
    }

    /// What the battery of that aircraft holds, kWh; its capacity on a day that charges to full.
    #[getter]
    fn charge_kwh(&self) -> f64 {
        self.snapshot.view().charge_kwh(self.decision.aircraft)
    }

    /// Number of decisions taken before this one today.
    #[getter]
    fn index(&self) -> u32 {
        self.decision.index
    }

    /// Time of the decision, seconds since midnight.
    #[getter]
    fn time_s(&self) -> u32 {
        self.decision.time.seconds()
    }

    /// Start of operations, seconds since midnight.
    #[getter]
    fn day_start_s(&self) -> u32 {
        self.snapshot.view().day_start().seconds()
    }

    /// The last instant at which decisions are taken, seconds since midnight.
    #[getter]
    fn day_end_s(&self) -> u32 {
        self.snapshot.view().day_end().seconds()
    }

    /// Position of the demand period.
    #[getter]
    fn period(&self) -> usize {
        self.snapshot.view().period()
    }

    /// Whether the day is over.
    #[getter]
    fn is_over(&self) -> bool {
        self.over
    }

    /// Number of vertiports.
    #[getter]
    fn vertiports(&self) -> usize {
        self.snapshot.view().vertiports()
    }

    /// Position of the vertiport where each aircraft stands or will land.
    #[getter]
    fn fleet_places(&self) -> Vec<u16> {
        self.snapshot.view().places().iter().map(|place| place.0).collect()
    }

    /// Position of the type of each aircraft.
    #[getter]
    fn fleet_types(&self) -> Vec<usize> {
        let view = self.snapshot.view();
        AircraftIx::all(view.places().len()).map(|at| view.kind(at).at()).collect()
    }
}

impl View {
    pub(crate) fn of(scene: &Scene<'_>, observer: &Arc<Mutex<Observer>>) -> Self {
        Self {
            snapshot: scene.view().snapshot(),
            decision: *scene.decision(),
            over: scene.is_over(),
            observer: Arc::clone(observer),
        }
    }

    /// The decision with the view of the day.
    pub(crate) fn scene(&self) -> Scene<'_> {
        scene(self.snapshot.view(), self.over, &self.decision)
    }
}
