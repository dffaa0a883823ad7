//! The arrays of a batch. Numpy allocates them once, and many threads fill them in place, row by row.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadwriteArray1, PyReadwriteArray2};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use vertifleet_learn::nn::Shape;

use crate::observation::ObservationRow;

/// Number of float arrays in an observation, which are, in this order: nodes, aircraft, clock, adjacency, mask.
const FLOATS: usize = 5;

/// Arrays with one observation for each day of a batch: the [`FLOATS`] float arrays, and the mask again as whole
/// numbers.
pub(crate) struct Observations {
    floats: [Py<PyArray2<f32>>; FLOATS],
    mask_i8: Py<PyArray2<i8>>,
}

/// Arrays with the outcome of one step for each day of a batch.
pub(crate) struct Outcomes {
    rewards: Py<PyArray1<f64>>,
    over: Py<PyArray1<bool>>,
    invalid: Py<PyArray1<bool>>,
    begun: Py<PyArray1<bool>>,
}

/// Write access to [`Observations`]. Python keeps the arrays during this time, and numpy refuses to lend them twice.
pub(crate) struct ObservationsLent<'py> {
    floats: [PyReadwriteArray2<'py, f32>; FLOATS],
    mask_i8: PyReadwriteArray2<'py, i8>,
}

/// Write access to [`Outcomes`].
pub(crate) struct OutcomesLent<'py> {
    rewards: PyReadwriteArray1<'py, f64>,
    over: PyReadwriteArray1<'py, bool>,
    invalid: PyReadwriteArray1<'py, bool>,
    begun: PyReadwriteArray1<'py, bool>,
}

/// Rows of observations.
pub(crate) struct ObservationRows<'a> {
    floats: [&'a mut [f32]; FLOATS],
    mask_i8: &'a mut [i8],
    rows: usize,
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
        let Shape { node_features, aircraft_features, .. } = vertifleet_learn::shape(vertiports);
        let pairs = vertiports * vertiports;
        let widths = [vertiports * node_features, aircraft_features, 1, pairs, vertiports];
        Self {
            floats: widths.map(|width| PyArray2::zeros(py, [rows, width], false).unbind()),
            mask_i8: PyArray2::zeros(py, [rows, vertiports], false).unbind(),
        }
    }

    /// The arrays of nodes, aircraft, clock, adjacency and mask, and the mask as int8.
    pub(crate) fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let [nodes, aircraft, clock, adjacency, mask] = &self.floats;
        (nodes, aircraft, clock, adjacency, mask, &self.mask_i8).into_pyobject(py)
    }

    /// Lends the arrays for writing, and fails if one of them was made read-only.
    pub(crate) fn lend<'py>(&self, py: Python<'py>) -> PyResult<ObservationsLent<'py>> {
        let [nodes, aircraft, clock, adjacency, mask] =
            self.floats.each_ref().map(|array| array.bind(py).try_readwrite());
        Ok(ObservationsLent {
            floats: [nodes?, aircraft?, clock?, adjacency?, mask?],
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

    /// The rewards, whether days are over, whether actions were infeasible, and whether new days have begun.
    pub(crate) fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let Self { rewards, over, invalid, begun } = self;
        (rewards, over, invalid, begun).into_pyobject(py)
    }

    /// Lends the arrays for writing, and fails if one of them was made read-only.
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
        let [nodes, aircraft, clock, adjacency, mask] =
            self.floats.each_mut().map(|array| array.as_slice_mut());
        let clock = clock?;
        let rows = clock.len();
        Ok(ObservationRows {
            floats: [nodes?, aircraft?, clock, adjacency?, mask?],
            mask_i8: self.mask_i8.as_slice_mut()?,
            rows,
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
    /// The arrays of the observation in row `row`.
    pub(crate) fn row(&mut self, row: usize) -> ObservationRow<'_> {
        let [nodes, aircraft, clock, adjacency, mask] =
            self.floats.each_mut().map(|table| one_of(table, row, self.rows));
        let mask_i8 = one_of(self.mask_i8, row, self.rows);
        ObservationRow { nodes, aircraft, clock: &mut clock[0], adjacency, mask, mask_i8 }
    }

    /// Splits into the rows before row `first` and the rest.
    pub(crate) fn split(self, first: usize) -> (Self, Self) {
        let rows = self.rows;
        let [nodes, aircraft, clock, adjacency, mask] =
            self.floats.map(|table| parted(table, first, rows));
        let (mask_i8, others_i8) = parted(self.mask_i8, first, rows);
        let others = Self {
            floats: [nodes.1, aircraft.1, clock.1, adjacency.1, mask.1],
            mask_i8: others_i8,
            rows: rows - first,
        };
        let floats = [nodes.0, aircraft.0, clock.0, adjacency.0, mask.0];
        (Self { floats, mask_i8, rows: first }, others)
    }
}

impl OutcomeRows<'_> {
    /// Splits into the rows before row `first` and the rest.
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

/// Row number `row` of a table with `rows` rows.
fn one_of<T>(table: &mut [T], row: usize, rows: usize) -> &mut [T] {
    let width = table.len() / rows;
    &mut table[row * width..][..width]
}

/// A table with `rows` rows, split before row `first`.
fn parted<T>(table: &mut [T], first: usize, rows: usize) -> (&mut [T], &mut [T]) {
    let width = table.len() / rows;
    table.split_at_mut(first * width)
}
