//! The map: vertiports at their places, and lines between them.

use vertifleet_core::{Scenario, Vertiport, VertiportIx};

use crate::canvas::{Anchor, Canvas, Lettering, Look, Point, Stroke};
use crate::palette::Paint;

/// Share of the map's shorter side that is left free around the vertiports.
const MARGIN: f64 = 0.1;
/// With more vertiports, only small marks fit.
const MOST_NAMED: usize = 24;

/// A rectangle of a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Area {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Area {
    pub(crate) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// The aircraft that a vertiport has room for: its stands, and its chargers where they are counted
/// apart.
pub(crate) fn room(vertiport: &Vertiport) -> u32 {
    u32::from(vertiport.stands) + u32::from(vertiport.chargers.unwrap_or(0))
}

/// The position of two vertiports in the upper triangle of a table, whichever of them comes first.
pub(crate) fn pair(size: usize, one: usize, other: usize) -> usize {
    one.min(other) * size + one.max(other)
}

/// The vertiports of a day in an area of a picture, north up and to scale.
pub(crate) struct Map {
    places: Vec<Point>,
}

impl Map {
    pub(crate) fn of(day: &Scenario, area: Area) -> Self {
        let span = |value: fn(&Vertiport) -> f64| {
            let values = day.vertiports.iter().map(value);
            let low = values.clone().fold(f64::INFINITY, f64::min);
            (low, values.fold(f64::NEG_INFINITY, f64::max) - low)
        };
        let ((west, width_mi), (south, height_mi)) = (span(|one| one.x_mi), span(|one| one.y_mi));
        let margin = MARGIN * area.width.min(area.height);
        let room = (area.width - 2.0 * margin, area.height - 2.0 * margin);
        let scale = (room.0 / width_mi.max(1e-9)).min(room.1 / height_mi.max(1e-9));
        let left = area.left + (area.width - scale * width_mi) / 2.0;
        let bottom = area.bottom() - (area.height - scale * height_mi) / 2.0;
        let place = |one: &Vertiport| {
            (left + scale * (one.x_mi - west), bottom - scale * (one.y_mi - south))
        };
        Self { places: day.vertiports.iter().map(place).collect() }
    }

    pub(crate) fn at(&self, vertiport: VertiportIx) -> Point {
        self.places[vertiport.at()]
    }

    /// The point that this share of the way from one vertiport to another leads to.
    pub(crate) fn between(&self, from: VertiportIx, to: VertiportIx, share: f64) -> Point {
        let ((x, y), (to_x, to_y)) = (self.at(from), self.at(to));
        (x + share * (to_x - x), y + share * (to_y - y))
    }

    /// Whether there is room for names and numbers at the vertiports.
    pub(crate) fn is_named(&self) -> bool {
        self.places.len() <= MOST_NAMED
    }

    /// A triangle that points along the way from one vertiport to another.
    pub(crate) fn arrow(
        &self,
        canvas: &mut Canvas,
        (from, to, share): (VertiportIx, VertiportIx, f64),
        size: f64,
        look: Look,
    ) {
        let ((x, y), (to_x, to_y)) = (self.at(from), self.at(to));
        let length = (to_x - x).hypot(to_y - y).max(1e-9);
        let (east, south) = ((to_x - x) / length, (to_y - y) / length);
        let (tip_x, tip_y) = self.between(from, to, share);
        let corner = |along: f64, across: f64| {
            (
                tip_x + size * (along * east - across * south),
                tip_y + size * (along * south + across * east),
            )
        };
        canvas.polyline(&[corner(1.0, 0.0), corner(-0.8, 0.62), corner(-0.8, -0.62)], true, look);
    }

    /// A vertiport as a disc, of which `share` is filled from the bottom up.
    pub(crate) fn disc(&self, canvas: &mut Canvas, at: VertiportIx, radius: f64, share: f64) {
        let (x, y) = self.at(at);
        let ring = Stroke::solid(Paint::Ink, 1.4);
        canvas.circle(
            (x, y),
            radius,
            Look { fill: Some((Paint::Ground, 1.0)), stroke: Some(ring) },
        );
        if share > 0.0 {
            canvas.circle(
                (x, y),
                (radius - 1.4) * share.min(1.0).sqrt(),
                Look::filled(Paint::Series(2)),
            );
        }
    }

    /// How names of vertiports are written.
    pub(crate) const NAME: Lettering = Lettering { size: 12.0, ..Lettering::LABEL.bold() };

    /// The id of a vertiport, shortened to 12 characters.
    pub(crate) fn short_name(day: &Scenario, at: VertiportIx) -> String {
        crate::canvas::shortened(&day.vertiports[at.at()].id, 12)
    }

    /// The name of a vertiport above its disc.
    pub(crate) fn name(&self, canvas: &mut Canvas, day: &Scenario, at: VertiportIx, radius: f64) {
        if self.is_named() {
            let (x, y) = self.at(at);
            let (above, name) = ((x, y - radius - 5.0), Self::short_name(day, at));
            canvas.text_on_lines(above, Self::NAME.anchored(Anchor::Middle), &name);
        }
    }
}
