//! Whole numbers from Python, which may have any size. They are checked when their required type is
//! known.

use pyo3::prelude::*;
use pyo3::{Borrowed, PyErr};

use crate::failure::Failure;

/// A whole number. A number that is too large for `i128` becomes `i128::MAX`, and one that is too
/// small becomes `i128::MIN`; no argument accepts a number of that size in any case.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WholeNumber(i128);

impl<'py> FromPyObject<'_, 'py> for WholeNumber {
    type Error = PyErr;

    fn extract(number: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        // `operator.index` also accepts the whole numbers of numpy, but no fractions.
        let number = number.py().import("operator")?.call_method1("index", (number,))?;
        let beyond = if number.lt(0)? { i128::MIN } else { i128::MAX };
        Ok(Self(number.extract().unwrap_or(beyond)))
    }
}

impl From<i32> for WholeNumber {
    fn from(number: i32) -> Self {
        Self(number.into())
    }
}

impl WholeNumber {
    /// Converts the number to the type that the argument with this name needs.
    pub(crate) fn of<T: TryFrom<i128>>(self, name: &str) -> Result<T, Failure> {
        T::try_from(self.0).map_err(|_| {
            let bits = 8 * size_of::<T>();
            let found = match self.0 {
                i128::MAX => "more".to_owned(),
                i128::MIN => "less".to_owned(),
                number => number.to_string(),
            };
            Failure::argument(format!("{name} must be from 0 to 2^{bits} - 1, found {found}"))
        })
    }
}
