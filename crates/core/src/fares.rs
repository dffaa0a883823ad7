//! P_ij: the fare of a passenger, the same all day or by demand period.

use crate::Matrix;

/// Fares, dollars a passenger, `[from][to]`: one table for the whole day, or one for each demand
/// period.
#[derive(Debug, Clone, PartialEq)]
pub struct Fares {
    first: Matrix<f64>,
    /// The tables of the second period and later ones; empty if the first table holds all day.
    later: Vec<Matrix<f64>>,
}

impl Fares {
    /// Fares that change with the demand period in which a flight is decided, one table for each
    /// period.
    ///
    /// # Panics
    /// If `tables` is empty.
    pub fn by_period(tables: Vec<Matrix<f64>>) -> Self {
        let mut tables = tables.into_iter();
        let first = tables.next().expect("a day has a period");
        Self { first, later: tables.collect() }
    }

    /// The table of a demand period.
    #[inline]
    pub fn in_period(&self, period: usize) -> &Matrix<f64> {
        self.later.get(period.wrapping_sub(1)).unwrap_or(&self.first)
    }

    /// The one table, or the tables of all demand periods in order.
    pub fn tables(&self) -> impl Iterator<Item = &Matrix<f64>> + Clone {
        std::iter::once(&self.first).chain(&self.later)
    }
}

impl From<Matrix<f64>> for Fares {
    /// Fares that are the same all day.
    fn from(first: Matrix<f64>) -> Self {
        Self { first, later: Vec::new() }
    }
}
