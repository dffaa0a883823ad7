//! The hops as the backward pass looks at them: from four vertiports at a time, in the order of
//! their destinations.
//!
//! The values of a destination are then read once for the hops from four vertiports, and the four
//! comparisons do not wait for each other. A vertiport of a quad may have no hop to a destination
//! that another one has; its gain there stays minus infinity, so it is never the best.

use vertifleet_core::{TypeIx, VertiportIx};

use super::hops::Stay;

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
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Arrival {
    pub(super) share: f64,
    /// The first boundary from which it is past the end of operations.
    pub(super) first_late: f64,
    pub(super) slots: u32,
}

impl Arrival {
    /// In place of the arrival of a hop that there is not.
    const NONE: Self = Self { share: 0.0, first_late: f64::INFINITY, slots: 0 };

    fn of(stay: Stay) -> Self {
        let slots = u32::try_from(stay.slots).expect("a day has few slots");
        Self { share: stay.share, first_late: stay.first_late as f64, slots }
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
    /// Lays out hops, given as the stay of each type from one vertiport to another where there is a
    /// hop.
    pub(super) fn of(
        (kinds, vertiports): (usize, usize),
        stay: impl Fn(TypeIx, VertiportIx, VertiportIx) -> Option<Stay>,
    ) -> Self {
        let mut quads =
            Self { all: Vec::new(), begins: vec![0], shortest: Vec::new(), first_late: Vec::new() };
        for kind in TypeIx::all(kinds) {
            let before = quads.all.len();
            for first in (0..vertiports).step_by(QUAD) {
                for to in VertiportIx::all(vertiports) {
                    let arrivals = std::array::from_fn(|number| {
                        let from = first + number;
                        let exists = from < vertiports;
                        let stay = exists.then(|| stay(kind, VertiportIx::new(from), to))?;
                        stay.map(Arrival::of)
                    });
                    quads.add(to, arrivals);
                }
                quads.begins.push(quads.all.len());
            }
            let hops = quads.all[before..].iter().flat_map(|hops| hops.arrivals);
            let hops: Vec<Arrival> = hops.filter(|arrival| *arrival != Arrival::NONE).collect();
            let shortest = hops.iter().map(|arrival| arrival.slots).min();
            let first_late = hops.iter().map(|arrival| arrival.first_late).min_by(f64::total_cmp);
            quads.shortest.push(shortest.map_or(1, |slots| slots as usize));
            quads.first_late.push(first_late.unwrap_or(0.0));
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

    /// The position of the gain of the hop of a type from one vertiport to another among the gains
    /// of an interval. The hop must exist.
    pub(super) fn gain_at(
        &self,
        kind: TypeIx,
        vertiports: usize,
        (from, to): (VertiportIx, VertiportIx),
    ) -> usize {
        let quad = kind.at() * vertiports.div_ceil(QUAD) + from.at() / QUAD;
        let hops = &self.all[self.begins[quad]..self.begins[quad + 1]];
        let at = hops.partition_point(|hops| hops.to < to.at() as u64);
        QUAD * (self.begins[quad] + at) + from.at() % QUAD
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
