//! The hops as the backward pass looks at them: from four vertiports at a time, in the order of
//! their destinations.
//!
//! The values of a destination are then read once for the hops from four vertiports, and the four
//! comparisons do not wait for each other. A vertiport of a quad may have no hop to a destination
//! that another one has; its gain there stays minus infinity, so it is never the best.

use vertifleet_core::{TypeIx, VertiportIx};

use super::hops::Stay;
use super::levels::Level;

/// Number of vertiports whose hops are looked at together.
pub(super) const QUAD: usize = 4;

/// The hops of all types, from all vertiports.
#[derive(Debug, Clone)]
pub(super) struct Quads {
    all: Vec<QuadHops>,
    /// The position in `all` at which the hops of each type and quad begin, and at the end the
    /// number of all.
    begins: Vec<usize>,
    /// By type: the least number of slots that a hop takes, and the first boundary from which any
    /// ends past the end of operations.
    shortest: Vec<usize>,
    first_late: Vec<f64>,
}

/// The hops from the vertiports of a quad to one destination.
#[derive(Debug, Clone, Copy)]
pub(super) struct QuadHops {
    pub(super) arrivals: [Arrival; QUAD],
    pub(super) to: u64,
}

/// When a hop arrives, in slots from its decision until the aircraft is ready again.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arrival {
    pub(super) share: f64,
    /// The first boundary from which it is past the end of operations.
    pub(super) first_late: f64,
    /// The first boundary from which the hop would take off past the end of operations.
    pub(super) first_closed: f64,
    /// The slots, and before them the rows of the levels above the one that it arrives at.
    pub(super) offset: u32,
}

impl Arrival {
    /// In place of the arrival of a hop that there is not.
    const NONE: Self =
        Self { share: 0.0, first_late: f64::INFINITY, first_closed: f64::INFINITY, offset: 0 };

    fn of((stay, level): (Stay, Level), stride: usize) -> Self {
        let offset = usize::from(level) * stride + stay.slots;
        let offset = u32::try_from(offset).expect("a day has few slots and levels");
        Self {
            share: stay.share,
            first_late: stay.first_late as f64,
            first_closed: stay.first_closed.map_or(f64::INFINITY, |first| first as f64),
            offset,
        }
    }
}

/// The hops of one type.
#[derive(Debug, Clone, Copy)]
pub(super) struct QuadsOfKind<'a> {
    all: &'a [QuadHops],
    begins: &'a [usize],
    pub(super) shortest: usize,
    pub(super) first_late: f64,
}

impl Quads {
    /// Lays out hops, given as the stay of each type from one row, which is a vertiport and a level
    /// of charge, to another vertiport where there is a hop, with the level at which it ends.
    /// `stride` is the distance from row to row in the tables of worth.
    pub(super) fn of(
        (kinds, vertiports, levels): (usize, usize, usize),
        stride: usize,
        stay: impl Fn(TypeIx, usize, VertiportIx) -> Option<(Stay, Level)>,
    ) -> Self {
        let rows = vertiports * levels;
        let mut quads =
            Self { all: Vec::new(), begins: vec![0], shortest: Vec::new(), first_late: Vec::new() };
        for kind in TypeIx::all(kinds) {
            let (mut shortest, mut first_late) = (usize::MAX, f64::INFINITY);
            for first in (0..rows).step_by(QUAD) {
                for to in VertiportIx::all(vertiports) {
                    let arrivals = std::array::from_fn(|number| {
                        let row = first + number;
                        let stay = (row < rows).then(|| stay(kind, row, to))??;
                        shortest = shortest.min(stay.0.slots);
                        first_late = first_late.min(stay.0.first_late as f64);
                        Some(Arrival::of(stay, stride))
                    });
                    quads.add(to, arrivals);
                }
                quads.begins.push(quads.all.len());
            }
            let has_hops = shortest < usize::MAX;
            quads.shortest.push(if has_hops { shortest } else { 1 });
            quads.first_late.push(if has_hops { first_late } else { 0.0 });
        }
        quads
    }

    /// Adds the hops from a quad to a destination, if there are any.
    fn add(&mut self, to: VertiportIx, arrivals: [Option<Arrival>; QUAD]) {
        if arrivals.iter().any(Option::is_some) {
            let arrivals = arrivals.map(|arrival| arrival.unwrap_or(Arrival::NONE));
            self.all.push(QuadHops { arrivals, to: to.at() as u64 });
        }
    }

    /// Number of gains that the hops of an interval have.
    pub(super) fn gains(&self) -> usize {
        QUAD * self.all.len()
    }

    /// The position of the gain of the hop of a type from one of `rows` rows to a vertiport among
    /// the gains of an interval. The hop must exist.
    pub(super) fn gain_at(
        &self,
        kind: TypeIx,
        rows: usize,
        (row, to): (usize, VertiportIx),
    ) -> usize {
        let quad = kind.at() * rows.div_ceil(QUAD) + row / QUAD;
        let hops = &self.all[self.begins[quad]..self.begins[quad + 1]];
        let at = hops.partition_point(|hops| hops.to < to.at() as u64);
        QUAD * (self.begins[quad] + at) + row % QUAD
    }

    /// The hops of one type.
    pub(super) fn of_kind(&self, kind: TypeIx) -> QuadsOfKind<'_> {
        let quads = (self.begins.len() - 1) / self.shortest.len();
        QuadsOfKind {
            all: &self.all,
            begins: &self.begins[kind.at() * quads..=(kind.at() + 1) * quads],
            shortest: self.shortest[kind.at()],
            first_late: self.first_late[kind.at()],
        }
    }
}

impl<'a> QuadsOfKind<'a> {
    /// Number of quads.
    pub(super) fn count(&self) -> usize {
        self.begins.len() - 1
    }

    /// The hops of a quad.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it is called where the vectors' width is known")]
    pub(super) fn hops(&self, quad: usize) -> &'a [QuadHops] {
        &self.all[self.begins[quad]..self.begins[quad + 1]]
    }

    /// The gains of the hops of a quad, from those of all hops in an interval.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it is called where the vectors' width is known")]
    pub(super) fn gains_usd<'g>(&self, quad: usize, gains_usd: &'g [f64]) -> &'g [[f64; QUAD]] {
        gains_usd[QUAD * self.begins[quad]..QUAD * self.begins[quad + 1]].as_chunks().0
    }
}
