//! Square tables indexed `[from][to]` by vertiport: distances, fares, costs, demand.

use std::ops::{Index, IndexMut};

use crate::VertiportIx;

/// A square table over pairs of vertiports, stored row by row.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Matrix<T> {
    size: usize,
    cells: Vec<T>,
}

impl<T> Matrix<T> {
    /// The table whose cell `(from, to)` is `cell(from, to)`.
    pub fn from_fn(size: usize, mut cell: impl FnMut(VertiportIx, VertiportIx) -> T) -> Self {
        let cells = (0..size * size)
            .map(|at| cell(VertiportIx::new(at / size), VertiportIx::new(at % size)))
            .collect();
        Self { size, cells }
    }

    /// The table with these rows, or `None` if they do not form a square of `size`.
    pub fn from_rows(size: usize, rows: Vec<Vec<T>>) -> Option<Self> {
        if rows.len() != size || rows.iter().any(|row| row.len() != size) {
            return None;
        }
        Some(Self { size, cells: rows.into_iter().flatten().collect() })
    }

    /// Number of rows, which is also the number of columns.
    #[inline]
    pub fn size(&self) -> usize {
        self.size
    }

    /// All cells, row by row.
    #[inline]
    pub fn cells(&self) -> &[T] {
        &self.cells
    }

    /// All cells, row by row, to be changed in place.
    #[inline]
    pub fn cells_mut(&mut self) -> &mut [T] {
        &mut self.cells
    }

    /// The cells from one vertiport to every other.
    #[inline]
    pub fn row(&self, from: VertiportIx) -> &[T] {
        &self.cells[from.at() * self.size..][..self.size]
    }

    /// The rows, in order.
    pub fn rows(&self) -> impl Iterator<Item = &[T]> {
        // An empty table has no rows, and `chunks(0)` would panic.
        self.cells.chunks(self.size.max(1))
    }
}

impl<T> Index<(VertiportIx, VertiportIx)> for Matrix<T> {
    type Output = T;

    #[inline]
    fn index(&self, (from, to): (VertiportIx, VertiportIx)) -> &T {
        debug_assert!(to.at() < self.size, "a column of this table");
        &self.cells[from.at() * self.size + to.at()]
    }
}

impl<T> IndexMut<(VertiportIx, VertiportIx)> for Matrix<T> {
    #[inline]
    fn index_mut(&mut self, (from, to): (VertiportIx, VertiportIx)) -> &mut T {
        debug_assert!(to.at() < self.size, "a column of this table");
        &mut self.cells[from.at() * self.size + to.at()]
    }
}
