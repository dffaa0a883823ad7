//! Parts side by side in one row of numbers.

use crate::priced::PricedDecision;
use crate::write::Writer;
use crate::{Observer, Part, Scene, Sizes};

/// The parts of an observation with their places in a row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    sizes: Sizes,
    parts: Vec<Placed>,
    width: usize,
    is_priced: bool,
    is_of_the_full: bool,
}

/// A part and its place in a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Placed {
    /// The part.
    pub part: Part,
    /// Position of its first entry.
    pub first: usize,
    /// Number of its entries.
    pub len: usize,
}

impl Layout {
    /// Lays parts out in their order, in shapes of these sizes.
    pub fn new(parts: Vec<Part>, sizes: Sizes) -> Self {
        let mut width = 0;
        let place = |part: Part| {
            let (first, len) = (width, part.len(sizes));
            width += len;
            Placed { part, first, len }
        };
        let parts: Vec<Placed> = parts.into_iter().map(place).collect();
        let has = |kind: fn(Part) -> bool| parts.iter().any(|placed| kind(placed.part));
        let (is_priced, is_of_the_full) = (has(Part::is_priced), has(Part::is_of_the_full));
        Self { sizes, parts, width, is_priced, is_of_the_full }
    }

    /// Number of entries of a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The sizes that the shapes are computed from.
    pub fn sizes(&self) -> Sizes {
        self.sizes
    }

    /// The parts in their order.
    pub fn parts(&self) -> &[Placed] {
        &self.parts
    }

    /// Writes a decision into a row. Entries without a meaning on this day, such as padding, are 0.
    /// `observer` belongs to the day.
    ///
    /// # Panics
    /// If the row has another width, or the day is larger than the layout's sizes.
    pub fn write(&self, row: &mut [f32], scene: &Scene<'_>, observer: &mut Observer) {
        assert_eq!(row.len(), self.width, "a row has the layout's width");
        row.fill(0.0);
        let Observer { scales, prices, shortlist, priced, full } = observer;
        let Scene { view, decision, feasible, over } = *scene;
        // Prices are undefined on a finished day, and nothing is left to decide.
        let priced = (self.is_priced && !over).then(|| {
            let prices = prices.at(view, decision);
            let listed = shortlist.rank(prices, view, decision);
            priced.look(PricedDecision::of(view, decision, prices), listed)
        });
        let full = (self.is_of_the_full && !over).then(|| full.look(view, decision, feasible));
        let writer = Writer { scene, sizes: self.sizes, scales, priced, full, natural: false };
        for &Placed { part, first, len } in &self.parts {
            writer.write(part, &mut row[first..first + len]);
        }
    }
}

/// Writes a part in its unit instead of divided by its scale, into an array of the day's sizes.
///
/// # Panics
/// If the array has another length, or if views do not have the part.
pub fn write_in_units(part: Part, to: &mut [f32], scene: &Scene<'_>, observer: &Observer) {
    assert!(part.info().in_views.is_some(), "views have the part");
    let sizes = scene.sizes();
    assert_eq!(to.len(), part.len(sizes), "the array has the part's length");
    to.fill(0.0);
    let scales = &observer.scales;
    let writer = Writer { scene, sizes, scales, priced: None, full: None, natural: true };
    writer.write(part, to);
}
