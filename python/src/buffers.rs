//! The arrays of a batch: allocated once by numpy, filled in place from many threads, row by row.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadwriteArray1, PyReadwriteArray2};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::observation::ObservationRow;

/// Arrays for one observation of every day of a batch.
pub(crate) struct Observations {
    nodes: Py<PyArray2<f32>>,
    aircraft: Py<PyArray2<f32>>,
    clock: Py<PyArray2<f32>>,
    adjacency: Py<PyArray2<f32>>,
    mask: Py<PyArray2<f32>>,
    mask_i8: Py<PyArray2<i8>>,
}

/// Arrays for one step's outcome of every day of a batch.
pub(crate) struct Outcomes {
    rewards: Py<PyArray1<f64>>,
    over: Py<PyArray1<bool>>,
    invalid: Py<PyArray1<bool>>,
    begun: Py<PyArray1<bool>>,
}

/// The right to write to [`Observations`]; Python holds the arrays meanwhile, and numpy refuses to lend them twice.
pub(crate) struct ObservationsLent<'py> {
    nodes: PyReadwriteArray2<'py, f32>,
    aircraft: PyReadwriteArray2<'py, f32>,
    clock: PyReadwriteArray2<'py, f32>,
    adjacency: PyReadwriteArray2<'py, f32>,
    mask: PyReadwriteArray2<'py, f32>,
    mask_i8: PyReadwriteArray2<'py, i8>,
}

/// The right to write to [`Outcomes`].
pub(crate) struct OutcomesLent<'py> {
    rewards: PyReadwriteArray1<'py, f64>,
    over: PyReadwriteArray1<'py, bool>,
    invalid: PyReadwriteArray1<'py, bool>,
    begun: PyReadwriteArray1<'py, bool>,
}

/// Rows of observations.
pub(crate) struct ObservationRows<'a> {
    nodes: &'a mut [f32],
    aircraft: &'a mut [f32],
    clock: &'a mut [f32],
    adjacency: &'a mut [f32],
    mask: &'a mut [f32],
    mask_i8: &'a mut [i8],
}

/// Rows of outcomes.
pub(crate) struct OutcomeRows<'a> {
    pub(crate) rewards: &'a mut [f64],
    pub(crate) over: &'a mut [bool],
    pub(crate) invalid: &'a mut [bool],
    /// Whether a new day has begun.
    pub(crate) begun: &'a mut [bool],
}

impl Observations {
    pub(crate) fn new(py: Python<'_>, rows: usize, vertiports: usize) -> Self {
        let shape = vertifleet_learn::shape(vertiports);
        let numbers = |width| PyArray2::zeros(py, [rows, width], false).unbind();
        Self {
            nodes: numbers(vertiports * shape.node_features),
            aircraft: numbers(shape.aircraft_features),
            clock: numbers(1),
            adjacency: numbers(vertiports * vertiports),
            mask: numbers(vertiports),
            mask_i8: PyArray2::zeros(py, [rows, vertiports], false).unbind(),
        }
    }

    /// Nodes, aircraft, clock, adjacency, mask, and the mask as int8.
    pub(crate) fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let Self { nodes, aircraft, clock, adjacency, mask, mask_i8 } = self;
        (nodes, aircraft, clock, adjacency, mask, mask_i8).into_pyobject(py)
    }

    /// An error if an array was made read-only.
    pub(crate) fn lend<'py>(&self, py: Python<'py>) -> PyResult<ObservationsLent<'py>> {
        Ok(ObservationsLent {
            nodes: self.nodes.bind(py).try_readwrite()?,
            aircraft: self.aircraft.bind(py).try_readwrite()?,
            clock: self.clock.bind(py).try_readwrite()?,
            adjacency: self.adjacency.bind(py).try_readwrite()?,
            mask: self.mask.bind(py).try_readwrite()?,
            mask_i8: self.mask_i8.bind(py).try_readwrite()?,
        })
    }
}

impl Outcomes {
    pub(crate) fn new(py: Python<'_>, rows: usize) -> Self {
        let flags = || PyArray1::zeros(py, rows, false).unbind();
        Self {
            rewards: PyArray1::zeros(py, rows, false).unbind(),
            over: flags(),
            invalid: flags(),
            begun: flags(),
        }
    }

    /// Rewards, whether days are over, whether actions were infeasible, whether new days have begun.
    pub(crate) fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let Self { rewards, over, invalid, begun } = self;
        (rewards, over, invalid, begun).into_pyobject(py)
    }

    /// An error if an array was made read-only.
    pub(crate) fn lend<'py>(&self, py: Python<'py>) -> PyResult<OutcomesLent<'py>> {
        Ok(OutcomesLent {
            rewards: self.rewards.bind(py).try_readwrite()?,
            over: self.over.bind(py).try_readwrite()?,
            invalid: self.invalid.bind(py).try_readwrite()?,
            begun: self.begun.bind(py).try_readwrite()?,
        })
    }
}

impl ObservationsLent<'_> {
    pub(crate) fn rows(&mut self) -> PyResult<ObservationRows<'_>> {
        Ok(ObservationRows {
            nodes: self.nodes.as_slice_mut()?,
            aircraft: self.aircraft.as_slice_mut()?,
            clock: self.clock.as_slice_mut()?,
            adjacency: self.adjacency.as_slice_mut()?,
            mask: self.mask.as_slice_mut()?,
            mask_i8: self.mask_i8.as_slice_mut()?,
        })
    }
}

impl OutcomesLent<'_> {
    pub(crate) fn rows(&mut self) -> PyResult<OutcomeRows<'_>> {
        Ok(OutcomeRows {
            rewards: self.rewards.as_slice_mut()?,
            over: self.over.as_slice_mut()?,
            invalid: self.invalid.as_slice_mut()?,
            begun: self.begun.as_slice_mut()?,
        })
    }
}

impl ObservationRows<'_> {
    /// Room for what row `row` shows.
    pub(crate) fn row(&mut self, row: usize) -> ObservationRow<'_> {
        let rows = self.clock.len();
        ObservationRow {
            nodes: one_of(self.nodes, row, rows),
            aircraft: one_of(self.aircraft, row, rows),
            clock: &mut self.clock[row],
            adjacency: one_of(self.adjacency, row, rows),
            mask: one_of(self.mask, row, rows),
            mask_i8: one_of(self.mask_i8, row, rows),
        }
    }

    /// The rows before `first`, and the others.
    pub(crate) fn split(self, first: usize) -> (Self, Self) {
        let rows = self.clock.len();
        let (nodes, more_nodes) = parted(self.nodes, first, rows);
        let (aircraft, more_aircraft) = parted(self.aircraft, first, rows);
        let (clock, more_clock) = self.clock.split_at_mut(first);
        let (adjacency, more_adjacency) = parted(self.adjacency, first, rows);
        let (mask, more_mask) = parted(self.mask, first, rows);
        let (mask_i8, more_mask_i8) = parted(self.mask_i8, first, rows);
        let others = Self {
            nodes: more_nodes,
            aircraft: more_aircraft,
            clock: more_clock,
            adjacency: more_adjacency,
            mask: more_mask,
            mask_i8: more_mask_i8,
        };
        (Self { nodes, aircraft, clock, adjacency, mask, mask_i8 }, others)
    }
}

impl OutcomeRows<'_> {
    /// The rows before `first`, and the others.
    pub(crate) fn split(self, first: usize) -> (Self, Self) {
        let (rewards, more_rewards) = self.rewards.split_at_mut(first);
        let (over, more_over) = self.over.split_at_mut(first);
        let (invalid, more_invalid) = self.invalid.split_at_mut(first);
        let (begun, more_begun) = self.begun.split_at_mut(first);
        let others = Self {
            rewards: more_rewards,
            over: more_over,
            invalid: more_invalid,
            begun: more_begun,
        };
        (Self { rewards, over, invalid, begun }, others)
    }
}

/// One row of a table of so many rows.
fn one_of<T>(table: &mut [T], row: usize, rows: usize) -> &mut [T] {
    let width = table.len() / rows;
    &mut table[row * width..][..width]
}

/// A table of so many rows, parted before row `first`.
fn parted<T>(table: &mut [T], first: usize, rows: usize) -> (&mut [T], &mut [T]) {
    let width = table.len() / rows;
    table.split_at_mut(first * width)
}
