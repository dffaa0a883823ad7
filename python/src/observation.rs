//! The observation of a decision (§IV.A of the paper), written into arrays: the features of learned policies, the pairs
//! of vertiports that can be flown, and the mask.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vertifleet_core::{TypeIx, VertiportIx};
use vertifleet_learn::{Scales, shape};
use vertifleet_sim::{Decision, VertiportSet, View};

/// The aircraft that an observation is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Observer {
    /// The aircraft whose decision it is.
    Deciding,
    /// An aircraft that does not decide now. Only hold is feasible.
    Waiting,
    /// The aircraft that decided last, on a day that is over. No time is left, and only hold is feasible.
    Finished,
}

impl Observer {
    /// The choices that are feasible for this observer.
    pub(crate) fn feasible(self, decision: &Decision, view: View<'_>) -> VertiportSet {
        if self == Self::Deciding {
            return view.feasible(decision);
        }
        let mut hold = VertiportSet::default();
        hold.insert(decision.at);
        hold
    }
}

/// The arrays that one observation is written to.
pub(crate) struct ObservationRow<'a> {
    /// [N x F].
    pub(crate) nodes: &'a mut [f32],
    /// [G].
    pub(crate) aircraft: &'a mut [f32],
    pub(crate) clock: &'a mut f32,
    /// [N x N].
    pub(crate) adjacency: &'a mut [f32],
    /// [N].
    pub(crate) mask: &'a mut [f32],
    /// [N], the same mask as whole numbers.
    pub(crate) mask_i8: &'a mut [i8],
}

impl ObservationRow<'_> {
    /// Writes the observation of a decision.
    pub(crate) fn fill(
        self,
        decision: &Decision,
        view: View<'_>,
        scales: &Scales,
        observer: Observer,
    ) {
        let left = scales.write(self.nodes, self.aircraft, decision, view);
        *self.clock = if observer == Observer::Finished { 0.0 } else { left };
        fill_adjacency(view, view.kind(decision.aircraft), self.adjacency);
        self.mask.fill(0.0);
        self.mask_i8.fill(0);
        for vertiport in observer.feasible(decision, view).iter() {
            self.mask[vertiport.at()] = 1.0;
            self.mask_i8[vertiport.at()] = 1;
        }
    }
}

/// Writes 1 for each pair of vertiports that aircraft of a type can fly now, and 0 for the others. A pair can be flown
/// if there is a corridor, the range with a full battery is long enough, and the route is not closed.
fn fill_adjacency(view: View<'_>, kind: TypeIx, adjacency: &mut [f32]) {
    adjacency.fill(0.0);
    for (from, row) in adjacency.chunks_exact_mut(view.vertiports()).enumerate() {
        let from = VertiportIx::new(from);
        for to in view.within_range(kind, from).without(&view.closed(from)).iter() {
            row[to.at()] = 1.0;
        }
    }
}

/// An observation as a dict of arrays by name, and its mask as int8.
pub(crate) type Observation<'py> = (Bound<'py, PyDict>, Bound<'py, PyArray1<i8>>);

/// Newly allocated arrays with the observation of one decision.
pub(crate) struct Arrays<'py> {
    nodes: Bound<'py, PyArray1<f32>>,
    aircraft: Bound<'py, PyArray1<f32>>,
    clock: Bound<'py, PyArray1<f32>>,
    adjacency: Bound<'py, PyArray1<f32>>,
    mask: Bound<'py, PyArray1<f32>>,
    mask_i8: Bound<'py, PyArray1<i8>>,
}

impl<'py> Arrays<'py> {
    pub(crate) fn of(
        py: Python<'py>,
        decision: &Decision,
        view: View<'_>,
        scales: &Scales,
        observer: Observer,
    ) -> PyResult<Self> {
        let shape = shape(view.vertiports());
        let size = shape.vertiports;
        let numbers = |len| PyArray1::zeros(py, len, false);
        let arrays = Self {
            nodes: numbers(size * shape.node_features),
            aircraft: numbers(shape.aircraft_features),
            clock: numbers(1),
            adjacency: numbers(size * size),
            mask: numbers(size),
            mask_i8: PyArray1::zeros(py, size, false),
        };
        ObservationRow {
            nodes: arrays.nodes.readwrite().as_slice_mut()?,
            aircraft: arrays.aircraft.readwrite().as_slice_mut()?,
            clock: &mut arrays.clock.readwrite().as_slice_mut()?[0],
            adjacency: arrays.adjacency.readwrite().as_slice_mut()?,
            mask: arrays.mask.readwrite().as_slice_mut()?,
            mask_i8: arrays.mask_i8.readwrite().as_slice_mut()?,
        }
        .fill(decision, view, scales, observer);
        Ok(arrays)
    }

    /// The observation as the environment returns it, and its mask as int8.
    pub(crate) fn into_observation(self, py: Python<'py>) -> PyResult<Observation<'py>> {
        let observation = PyDict::new(py);
        observation.set_item("nodes", self.nodes)?;
        observation.set_item("aircraft", self.aircraft)?;
        observation.set_item("clock", self.clock)?;
        observation.set_item("adjacency", self.adjacency)?;
        observation.set_item("action_mask", self.mask)?;
        Ok((observation, self.mask_i8))
    }
}
