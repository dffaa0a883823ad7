//! WholeNumber numbers as Python has them: of any size, until it is known what they are for.

use pyo3::prelude::*;
use pyo3::{Borrowed, PyErr};

use crate::failure::Failure;

/// A whole number; one that is far beyond all that is taken anywhere is as good as any other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WholeNumber(i128);

impl<'py> FromPyObject<'_, 'py> for WholeNumber {
    type Error = PyErr;

    fn extract(number: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        // NumPy's whole numbers are Python's by this; fractions are not.
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
    /// The number as one that an argument of this name takes.
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
