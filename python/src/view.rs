//! `View`: a decision and a policy's view of the day.

use std::sync::{Arc, Mutex, PoisonError};

use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use vertifleet_core::{AircraftIx, CurvePoint, VertiportIx};
use vertifleet_observe::{Observer, Part, Scene, write_in_units};
use vertifleet_sim::{Decision, Snapshot};

use crate::frames::read_only;
use crate::layout::Layout;
use crate::observation::{Shown, scene, show, shown};

/// Name, seats, speed, battery, energy a mile, charging power, self-discharge, reserve, turnaround,
/// and points of the charging curve of a type of aircraft.
type TypeFields = (String, u16, f64, f64, f64, f64, f64, f64, u32, Option<Vec<(f64, f64)>>);

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

    /// Start of each demand period, seconds since midnight.
    #[getter]
    fn period_starts_s(&self) -> Vec<u32> {
        self.snapshot.view().period_starts().iter().map(|start| start.seconds()).collect()
    }

    /// Duration of a hold, seconds.
    #[getter]
    fn hold_s(&self) -> u32 {
        self.snapshot.view().hold_s()
    }

    /// Seconds for which passengers who were not carried wait into the next demand period.
    #[getter]
    fn passenger_wait_s(&self) -> u32 {
        self.snapshot.view().passenger_wait_s()
    }

    /// The fixed cost of the day, dollars: that of its fleet, stands and chargers.
    #[getter]
    fn fixed_cost_usd(&self) -> f64 {
        self.snapshot.view().fixed_cost_usd()
    }

    /// Whether aircraft decide before they are full.
    #[getter]
    fn charges_as_needed(&self) -> bool {
        self.snapshot.view().charges_as_needed()
    }

    /// The times of known closures over the whole day: origin, destination, and the seconds since
    /// midnight at which each begins and ends.
    #[getter]
    fn known_closures(&self) -> Vec<(u16, u16, u32, u32)> {
        let view = self.snapshot.view();
        let all = || VertiportIx::all(view.vertiports());
        let pairs = all().flat_map(|from| all().map(move |to| (from, to)));
        let spans = pairs.flat_map(|(from, to)| {
            let spans = view.known_closures().spans(from, to).iter();
            spans.map(move |span| (from.0, to.0, span.start.seconds(), span.end.seconds()))
        });
        spans.collect()
    }

    /// The properties of each type of aircraft: name, seats, speed, battery, energy a mile,
    /// charging power, self-discharge an hour, reserve, turnaround, and the points of its curve.
    #[getter]
    fn types(&self) -> Vec<TypeFields> {
        let types = self.snapshot.view().aircraft_types().iter().map(|kind| {
            let curve = kind.charge_curve.as_ref();
            let points = |point: &CurvePoint| (point.charge, point.kw);
            (
                kind.id.clone(),
                kind.seats,
                kind.speed_mph,
                kind.battery_kwh,
                kind.energy_kwh_per_mi,
                kind.charge_kw,
                kind.self_discharge_per_h,
                kind.reserve_kwh,
                kind.turnaround_s,
                curve.map(|curve| curve.points().iter().map(points).collect()),
            )
        });
        types.collect()
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
