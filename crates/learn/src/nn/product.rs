//! Matrix products over checked slices. This is the only module that calls the matrix-product
//! crate, and therefore the only one with `unsafe` code.
//!
//! `gemm-f32` chooses its kernel by the CPU at run time, so one build runs everywhere, and a given
//! machine always computes the same bits. `gemm` forwards to it, and also builds kernels for
//! complex and double numbers. `faer`, which needs no `unsafe`, was 3 to 15 % slower on the largest
//! products here.

#![expect(
    unsafe_code,
    reason = "gemm takes pointers; the matrices below have checked their slices"
)]

use gemm_common::Parallelism;
use gemm_f32::gemm::f32::get_gemm_fn;

/// A matrix in a slice: entry (i, j) lies at `i * row_step + j * column_step`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Matrix<'a> {
    // Invariant: the largest index of an entry is inside the slice.
    entries: &'a [f32],
    rows: usize,
    columns: usize,
    row_step: usize,
    column_step: usize,
}

/// A matrix to write to, whose rows follow one another, `row_step` apart.
#[derive(Debug)]
pub(crate) struct MatrixMut<'a> {
    // Invariant: the largest index of an entry is inside the slice, and `columns <= row_step`, so
    // no two entries share a place.
    entries: &'a mut [f32],
    rows: usize,
    columns: usize,
    row_step: usize,
}

/// How a product is written to a matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Write {
    /// The product replaces the matrix.
    Set,
    /// The product is added to the matrix.
    Add,
    /// The product is subtracted from the matrix.
    Subtract,
}

impl<'a> Matrix<'a> {
    /// A row-major matrix that fills its slice.
    ///
    /// # Panics
    /// Panics if the slice has another length.
    pub(crate) fn new(entries: &'a [f32], rows: usize, columns: usize) -> Self {
        assert_eq!(entries.len(), rows * columns, "entries of a {rows} x {columns} matrix");
        Self { entries, rows, columns, row_step: columns, column_step: 1 }
    }

    pub(crate) fn transposed(self) -> Self {
        Self {
            entries: self.entries,
            rows: self.columns,
            columns: self.rows,
            row_step: self.column_step,
            column_step: self.row_step,
        }
    }

    /// The block of `count` columns from `first` on.
    ///
    /// # Panics
    /// Panics if there are fewer columns.
    pub(crate) fn columns(self, first: usize, count: usize) -> Self {
        assert!(first + count <= self.columns, "columns of a matrix with {}", self.columns);
        let skipped = (first * self.column_step).min(self.entries.len());
        Self { entries: &self.entries[skipped..], columns: count, ..self }
    }
}

impl<'a> MatrixMut<'a> {
    /// A row-major matrix that fills its slice.
    ///
    /// # Panics
    /// Panics if the slice has another length.
    pub(crate) fn new(entries: &'a mut [f32], rows: usize, columns: usize) -> Self {
        assert_eq!(entries.len(), rows * columns, "entries of a {rows} x {columns} matrix");
        Self { entries, rows, columns, row_step: columns }
    }

    /// The block of `count` columns from `first` on.
    ///
    /// # Panics
    /// Panics if there are fewer columns.
    pub(crate) fn columns(self, first: usize, count: usize) -> Self {
        assert!(first + count <= self.columns, "columns of a matrix with {}", self.columns);
        let skipped = first.min(self.entries.len());
        Self { entries: &mut self.entries[skipped..], columns: count, ..self }
    }
}

/// Writes `left * right` to `to`, as `write` specifies.
///
/// # Panics
/// Panics if the sizes do not agree.
pub(crate) fn multiply(to: MatrixMut<'_>, write: Write, left: Matrix<'_>, right: Matrix<'_>) {
    let MatrixMut { entries, rows, columns, row_step } = to;
    let inner = left.columns;
    assert_eq!((left.rows, right.columns), (rows, columns), "sizes of a product and its factors");
    assert_eq!(inner, right.rows, "inner sizes of a product");
    let factor = if write == Write::Subtract { -1.0 } else { 1.0 };
    // The kernels write columns. A matrix with more than one column therefore is written as its
    // transpose, which is the product of the transposed factors in the other order.
    let (rows, columns, steps, left, right) = if row_step > 1 {
        (columns, rows, (row_step, 1), right.transposed(), left.transposed())
    } else {
        (rows, columns, (1, row_step), left, right)
    };
    // A slice is at most isize::MAX bytes long, and a step that is used is shorter than its slice.
    let step = |step: usize| isize::try_from(step).expect("a step inside a slice");
    // SAFETY: the two readable matrices and the writable one have their largest index inside their
    // slices (checked by the constructors), the writable one is borrowed exclusively and its
    // entries do not overlap, and the sizes agree.
    unsafe {
        get_gemm_fn()(
            rows,
            columns,
            inner,
            entries.as_mut_ptr(),
            step(steps.0),
            step(steps.1),
            write != Write::Set,
            left.entries.as_ptr(),
            step(left.column_step),
            step(left.row_step),
            right.entries.as_ptr(),
            step(right.column_step),
            step(right.row_step),
            1.0,
            factor,
            false,
            false,
            false,
            Parallelism::None,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::{Matrix, MatrixMut, Write, multiply};
    use proptest::prelude::{ProptestConfig, any, proptest};

    fn entry(matrix: Matrix<'_>, row: usize, column: usize) -> f64 {
        f64::from(matrix.entries[row * matrix.row_step + column * matrix.column_step])
    }

    fn wave(len: usize, pace: f32) -> Vec<f32> {
        (0..len).map(|at| (at as f32 * pace).sin()).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn products_are_sums_over_the_inner_index(
            rows in 1_usize..20, inner in 1_usize..70, columns in 1_usize..40,
            left_transposed: bool, right_transposed: bool,
            margin in 0_usize..5, how in any::<proptest::sample::Index>(),
        ) {
            let write = [Write::Set, Write::Add, Write::Subtract][how.index(3)];
            let left = wave(rows * (inner + margin), 0.7);
            let left = if left_transposed {
                Matrix::new(&left[..rows * inner], inner, rows).transposed()
            } else {
                Matrix::new(&left, rows, inner + margin).columns(margin, inner)
            };
            let right = wave(inner * (columns + margin), 1.3);
            let right = if right_transposed {
                Matrix::new(&right[..inner * columns], columns, inner).transposed()
            } else {
                Matrix::new(&right, inner, columns + margin).columns(margin / 2, columns)
            };
            let before = wave(rows * (columns + margin), 0.3);
            let mut after = before.clone();
            let to = MatrixMut::new(&mut after, rows, columns + margin).columns(margin, columns);
            multiply(to, write, left, right);
            for (at, (&after, &before)) in after.iter().zip(&before).enumerate() {
                let (row, place) = (at / (columns + margin), at % (columns + margin));
                let Some(column) = place.checked_sub(margin) else {
                    assert_eq!(after.to_bits(), before.to_bits(), "what is next to the block stays");
                    continue;
                };
                let sum: f64 = (0..inner).map(|k| entry(left, row, k) * entry(right, k, column)).sum();
                let expected = match write {
                    Write::Set => sum,
                    Write::Add => f64::from(before) + sum,
                    Write::Subtract => f64::from(before) - sum,
                };
                assert!((f64::from(after) - expected).abs() < 1e-4, "{after} is not {expected}");
            }
        }
    }

    #[test]
    #[should_panic(expected = "inner sizes")]
    fn sizes_that_do_not_agree_are_refused() {
        let entries = [0.0; 6];
        let mut to = [0.0; 4];
        let left = Matrix::new(&entries, 2, 3);
        multiply(MatrixMut::new(&mut to, 2, 2), Write::Set, left, Matrix::new(&entries[..4], 2, 2));
    }
}
