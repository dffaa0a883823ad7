//! P_ij: what a passenger pays, the same all day or by demand period.

use crate::Matrix;

/// Fares, dollars a passenger, `[from][to]`: one table for the whole day, or one for each demand period.
#[derive(Debug, Clone, PartialEq)]
pub struct Fares {
    tables: Vec<Matrix<f64>>,
}

impl Fares {
    /// Fares that change with the demand period in which a flight is decided: a table for each.
    pub fn by_period(tables: Vec<Matrix<f64>>) -> Self {
        Self { tables }
    }

    /// The table of a demand period.
    #[inline]
    pub fn in_period(&self, period: usize) -> &Matrix<f64> {
        &self.tables[if self.tables.len() == 1 { 0 } else { period }]
    }

    /// One table, or one for each demand period.
    pub fn tables(&self) -> &[Matrix<f64>] {
        &self.tables
    }
}

impl From<Matrix<f64>> for Fares {
    /// The same fares all day.
    fn from(table: Matrix<f64>) -> Self {
        Self { tables: vec![table] }
    }
}
