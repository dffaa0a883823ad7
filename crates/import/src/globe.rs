//! Distances on the globe, and the middle of areas.
//!
//! Distances are those of a network, so that an import has the distances that the network has.

use vertifleet_core::great_circle_mi;

/// A place on the globe, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    pub(crate) latitude: f64,
    pub(crate) longitude: f64,
}

impl Place {
    /// The place of these degrees, if they are degrees.
    #[inline]
    pub(crate) fn new(latitude: f64, longitude: f64) -> Option<Self> {
        let degrees = latitude.abs() <= 90.0 && longitude.abs() <= 180.0;
        degrees.then_some(Self { latitude, longitude })
    }

    /// The great-circle distance by the haversine formula, miles.
    #[inline]
    pub(crate) fn distance_mi(self, to: Self) -> f64 {
        great_circle_mi((self.latitude, self.longitude), (to.latitude, to.longitude))
    }
}

/// The length of a line, miles.
pub(crate) fn length_mi(line: &[Place]) -> f64 {
    line.windows(2).map(|ends| ends[0].distance_mi(ends[1])).sum()
}

/// The area of a surface and where its middle is. Parts are added up before the middle is taken.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Area {
    /// Square degrees.
    size: f64,
    /// Size times the middle's latitude, and its longitude east of `origin`.
    moment: (f64, f64),
    /// The longitude of the first place, from which others are measured the shorter way round, also
    /// across the antimeridian.
    origin: Option<f64>,
}

/// By how much a longitude lies east of another, the shorter way round, degrees.
fn east_of(origin: f64, longitude: f64) -> f64 {
    (longitude - origin + 540.0).rem_euclid(360.0) - 180.0
}

impl Area {
    /// Adds the area within a ring of places, or takes away that of a hole.
    ///
    /// The shoelace formula in degrees: a degree of longitude is shorter than one of latitude,
    /// which changes the area but not where its middle is.
    pub(crate) fn add_ring(&mut self, ring: &[Place], hole: bool) {
        let Some(&origin) = ring.first() else { return };
        let first = *self.origin.get_or_insert(origin.longitude);
        let (mut double, mut north, mut east) = (0.0, 0.0, 0.0);
        for ends in ring.windows(2) {
            let from_origin = |place: Place| {
                (place.latitude - origin.latitude, east_of(origin.longitude, place.longitude))
            };
            let ((ay, ax), (by, bx)) = (from_origin(ends[0]), from_origin(ends[1]));
            let cross = ax * by - bx * ay;
            double += cross;
            north += (ay + by) * cross;
            east += (ax + bx) * cross;
        }
        if double == 0.0 {
            return;
        }
        let size = double.abs() / 2.0 * if hole { -1.0 } else { 1.0 };
        self.size += size;
        self.moment.0 += size * (origin.latitude + north / (3.0 * double));
        self.moment.1 += size * (east_of(first, origin.longitude) + east / (3.0 * double));
    }

    /// The middle of the area, if it has a size.
    pub(crate) fn middle(self) -> Option<Place> {
        if self.size <= 0.0 {
            return None;
        }
        let longitude = east_of(0.0, self.origin? + self.moment.1 / self.size);
        Place::new(self.moment.0 / self.size, longitude)
    }
}

#[cfg(test)]
mod tests {
    use super::{Area, Place, length_mi};

    fn places(degrees: &[(f64, f64)]) -> Vec<Place> {
        degrees.iter().map(|&(latitude, longitude)| Place { latitude, longitude }).collect()
    }

    #[test]
    fn a_degree_of_latitude_is_sixty_nine_miles_and_lengths_add_up() {
        let line = places(&[(40.0, -74.0), (41.0, -74.0), (40.0, -74.0)]);
        assert!((length_mi(&line) - 2.0 * 69.094).abs() < 2e-3);
        assert_eq!(length_mi(&line[..1]), 0.0);
    }

    #[test]
    fn the_middle_of_a_square_with_a_hole_moves_away_from_the_hole() {
        let mut area = Area::default();
        let square = |s: f64, w: f64, side: f64| {
            places(&[(s, w), (s, w + side), (s + side, w + side), (s + side, w), (s, w)])
        };
        area.add_ring(&square(40.0, -74.0, 2.0), false);
        let middle = area.middle().expect("it has a size");
        assert!((middle.latitude - 41.0).abs() < 1e-9 && (middle.longitude + 73.0).abs() < 1e-9);
        let mut reversed = square(40.0, -74.0, 1.0);
        reversed.reverse();
        area.add_ring(&reversed, true);
        let middle = area.middle().expect("it has a size");
        // (4 x 41 - 40.5) / 3 and (4 x -73 + 73.5) / 3.
        assert!((middle.latitude - 123.5 / 3.0).abs() < 1e-9, "{middle:?}");
        assert!((middle.longitude + 218.5 / 3.0).abs() < 1e-9, "{middle:?}");
    }

    #[test]
    fn an_area_across_the_antimeridian_has_its_middle_there() {
        let mut area = Area::default();
        area.add_ring(
            &places(&[(10.0, 179.0), (10.0, -177.0), (12.0, -177.0), (12.0, 179.0), (10.0, 179.0)]),
            false,
        );
        // A second part, as maps have where they cut areas at the antimeridian.
        area.add_ring(
            &places(&[
                (10.0, -177.0),
                (10.0, -173.0),
                (12.0, -173.0),
                (12.0, -177.0),
                (10.0, -177.0),
            ]),
            false,
        );
        let middle = area.middle().expect("it has a size");
        assert!((middle.latitude - 11.0).abs() < 1e-9 && (middle.longitude + 177.0).abs() < 1e-9);
    }

    #[test]
    fn a_ring_without_a_surface_has_no_middle() {
        let mut area = Area::default();
        area.add_ring(&places(&[(40.0, -74.0), (41.0, -74.0), (40.0, -74.0)]), false);
        assert_eq!(area.middle(), None);
    }
}
