//! Tables with a row for each vertiport of departure and a column for each destination.

use vertifleet_core::VertiportIx;
use vertifleet_sim::VertiportSet;

/// The layout of a table of pairs in its array.
pub(crate) struct Pairs {
    /// Number of vertiports of the day.
    pub(crate) vertiports: usize,
    /// Number of entries from one row to the next, at least `count`.
    pub(crate) stride: usize,
    /// The factor that numbers are multiplied by.
    pub(crate) factor: f64,
}

impl Pairs {
    /// The row of a vertiport.
    pub(crate) fn row<'a>(&self, to: &'a mut [f32], from: VertiportIx) -> &'a mut [f32] {
        &mut to[from.at() * self.stride..][..self.vertiports]
    }

    /// Writes rows of numbers.
    pub(crate) fn rows<'a>(&self, to: &mut [f32], row: impl Fn(VertiportIx) -> &'a [f64]) {
        for from in VertiportIx::all(self.vertiports) {
            for (to, number) in self.row(to, from).iter_mut().zip(row(from)) {
                *to = (number * self.factor) as f32;
            }
        }
    }

    /// Writes counts, given row by row.
    pub(crate) fn counts(&self, to: &mut [f32], counts: &[u32]) {
        let factor = self.factor as f32;
        let rows = counts.chunks_exact(self.vertiports);
        for (from, counts) in VertiportIx::all(self.vertiports).zip(rows) {
            for (to, &count) in self.row(to, from).iter_mut().zip(counts) {
                *to = count as f32 * factor;
            }
        }
    }

    /// Writes 1 for each vertiport in the set of a row.
    pub(crate) fn sets(&self, to: &mut [f32], set: impl Fn(VertiportIx) -> VertiportSet) {
        for from in VertiportIx::all(self.vertiports) {
            let row = self.row(to, from);
            for at in set(from).iter() {
                row[at.at()] = 1.0;
            }
        }
    }
}
