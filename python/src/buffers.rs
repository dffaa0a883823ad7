//! The arrays of a batch. Numpy allocates them once, and many threads fill them in place, row by
//! row.

use numpy::{
    PyArray1, PyArray2, PyArrayMethods, PyReadwriteArray1, PyReadwriteArray2, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// Arrays with one observation for each day of a batch, in the order of its layout, and their
/// masks.
pub(crate) struct Observations {
    rows: Py<PyArray2<f32>>,
    masks: Py<PyArray2<i8>>,
}

/// Arrays with the outcome of one step for each day of a batch.
pub(crate) struct Outcomes {
    rewards: Py<PyArray1<f64>>,
    over: Py<PyArray1<bool>>,
    invalid: Py<PyArray1<bool>>,
    begun: Py<PyArray1<bool>>,
}

/// Write access to [`Observations`]. Python keeps the arrays during this time, and numpy refuses to
/// lend them twice.
pub(crate) struct ObservationsLent<'py> {
    rows: PyReadwriteArray2<'py, f32>,
    masks: PyReadwriteArray2<'py, i8>,
    width: usize,
    vertiports: usize,
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
    rows: &'a mut [f32],
    masks: &'a mut [i8],
    width: usize,
    vertiports: usize,
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
    pub(crate) fn new(py: Python<'_>, days: usize, width: usize, vertiports: usize) -> Self {
        Self {
            rows: PyArray2::zeros(py, [days, width], false).unbind(),
            masks: PyArray2::zeros(py, [days, vertiports], false).unbind(),
        }
    }

    /// The arrays of rows and masks.
    pub(crate) fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (&self.rows, &self.masks).into_pyobject(py)
    }

    /// Lends the arrays for writing, and fails if one of them was made read-only.
    pub(crate) fn lend<'py>(&self, py: Python<'py>) -> PyResult<ObservationsLent<'py>> {
        let (rows, masks) = (self.rows.bind(py), self.masks.bind(py));
        let (width, vertiports) = (rows.shape()[1], masks.shape()[1]);
        let (rows, masks) = (rows.try_readwrite()?, masks.try_readwrite()?);
        Ok(ObservationsLent { rows, masks, width, vertiports })
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

    /// The rewards, whether days are over, whether actions were infeasible, and whether new days
    /// have begun.
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
        Ok(ObservationRows {
            rows: self.rows.as_slice_mut()?,
            masks: self.masks.as_slice_mut()?,
            width: self.width,
            vertiports: self.vertiports,
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
    /// The numbers and the mask of a day.
    pub(crate) fn row(&mut self, day: usize) -> (&mut [f32], &mut [i8]) {
        let Self { width, vertiports, .. } = *self;
        let numbers = &mut self.rows[day * width..][..width];
        (numbers, &mut self.masks[day * vertiports..][..vertiports])
    }

    /// Splits into the rows before row `first` and the rest.
    pub(crate) fn split(self, first: usize) -> (Self, Self) {
        let Self { width, vertiports, .. } = self;
        let (rows, other_rows) = self.rows.split_at_mut(first * width);
        let (masks, other_masks) = self.masks.split_at_mut(first * vertiports);
        let others = Self { rows: other_rows, masks: other_masks, width, vertiports };
        (Self { rows, masks, width, vertiports }, others)
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
