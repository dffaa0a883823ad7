//! The places of a network's tensors in its flat vector of weights.

use crate::nn::init::Init;
use crate::nn::product::{Matrix, MatrixMut};

/// A named tensor of a network's weights.
#[derive(Debug, Clone, PartialEq)]
pub struct Tensor {
    /// Its name in weight files.
    pub name: String,
    /// Its sizes, the slowest index first. A matrix W has shape [inputs, outputs] and is used as
    /// `x W`.
    pub shape: Vec<usize>,
    /// Index of its first entry in the flat vector.
    pub offset: usize,
    pub(crate) init: Init,
}

impl Tensor {
    /// Number of entries.
    pub fn len(&self) -> usize {
        self.shape.iter().product()
    }

    /// Whether it has no entries, which is never the case for a tensor of a network.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The tensors of a network, one after the other in one flat vector.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    tensors: Vec<Tensor>,
    start: usize,
    end: usize,
}

/// The place of one tensor, the only part of the layout that the layers keep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Slot {
    pub(crate) offset: usize,
    /// Number of rows, 1 for vectors.
    pub(crate) rows: usize,
    pub(crate) columns: usize,
}

/// The numbers that slots refer to: the weights, followed by the products derived from them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tensors<'a> {
    pub(crate) params: &'a [f32],
    pub(crate) derived: &'a [f32],
}

impl Layout {
    /// A layout without tensors; the first one will start at `start`.
    pub(crate) fn starting_at(start: usize) -> Self {
        Self { tensors: Vec::new(), start, end: start }
    }

    /// The tensors in their order.
    pub fn tensors(&self) -> &[Tensor] {
        &self.tensors
    }

    /// Total number of entries of all tensors.
    pub fn len(&self) -> usize {
        self.end - self.start
    }

    /// Whether there are no tensors.
    pub fn is_empty(&self) -> bool {
        self.tensors.is_empty()
    }

    /// Index after the last entry.
    pub(crate) fn end(&self) -> usize {
        self.end
    }

    /// Adds a matrix at the end.
    pub(crate) fn matrix(
        &mut self,
        name: &str,
        (rows, columns): (usize, usize),
        init: Init,
    ) -> Slot {
        self.push(name, vec![rows, columns], init);
        Slot { offset: self.end - rows * columns, rows, columns }
    }

    /// Adds a vector at the end.
    pub(crate) fn vector(&mut self, name: &str, len: usize, init: Init) -> Slot {
        self.push(name, vec![len], init);
        Slot { offset: self.end - len, rows: 1, columns: len }
    }

    fn push(&mut self, name: &str, shape: Vec<usize>, init: Init) {
        let tensor = Tensor { name: name.to_owned(), shape, offset: self.end, init };
        self.end += tensor.len();
        self.tensors.push(tensor);
    }
}

impl Slot {
    fn len(self) -> usize {
        self.rows * self.columns
    }

    /// The block of `count` rows from `first` on.
    pub(crate) fn rows(self, first: usize, count: usize) -> Self {
        assert!(first + count <= self.rows, "rows of a tensor with {}", self.rows);
        Self { offset: self.offset + first * self.columns, rows: count, ..self }
    }

    /// The same tensor in the vector that lacks the first `skipped` entries.
    pub(crate) fn counted_from(self, skipped: usize) -> Self {
        Self { offset: self.offset - skipped, ..self }
    }

    /// The tensor's part of a flat vector, as a matrix.
    pub(crate) fn part(self, flat: &[f32]) -> &[f32] {
        &flat[self.offset..][..self.len()]
    }

    /// The tensor's part of a flat vector, as a matrix to write to.
    pub(crate) fn part_mut(self, flat: &mut [f32]) -> &mut [f32] {
        &mut flat[self.offset..][..self.len()]
    }

    /// The tensor's part of a flat vector, as a matrix.
    pub(crate) fn matrix(self, flat: &[f32]) -> Matrix<'_> {
        Matrix::new(self.part(flat), self.rows, self.columns)
    }

    /// The tensor's part of a flat vector, as a matrix to write to.
    pub(crate) fn matrix_mut(self, flat: &mut [f32]) -> MatrixMut<'_> {
        MatrixMut::new(self.part_mut(flat), self.rows, self.columns)
    }
}

impl<'a> Tensors<'a> {
    /// A tensor's entries.
    pub(crate) fn part(self, slot: Slot) -> &'a [f32] {
        let weights = self.params.len();
        if slot.offset < weights {
            slot.part(self.params)
        } else {
            slot.counted_from(weights).part(self.derived)
        }
    }

    /// A tensor as a matrix.
    pub(crate) fn matrix(self, slot: Slot) -> Matrix<'a> {
        Matrix::new(self.part(slot), slot.rows, slot.columns)
    }
}
