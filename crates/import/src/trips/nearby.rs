//! The nearest vertiport within a radius of a place.
//!
//! The decision is the haversine distance's. It costs four sines and cosines, so it is taken only
//! of vertiports around which a box of latitudes and longitudes holds the place. The box is the
//! smallest that holds the circle of the radius.

use vertifleet_core::EARTH_RADIUS_MI;

use crate::globe::Place;

/// The vertiport near a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Near {
    /// Its position in file order.
    pub(super) vertiport: usize,
    pub(super) distance_mi: f64,
}

/// Vertiports in the order of their latitudes.
pub(crate) struct Nearby {
    boxes: Vec<Box>,
    radius_mi: f64,
    /// Half the height of every box, degrees.
    half_height: f64,
    vertiports: usize,
}

/// A box around a vertiport.
struct Box {
    place: Place,
    vertiport: usize,
    /// Half its width, degrees.
    half_width: f64,
}

impl Nearby {
    pub(crate) fn new(places: Vec<Place>, radius_mi: f64) -> Self {
        // Boxes are a little larger than need be, so that no rounding leaves out a place at the
        // edge of the circle.
        const ROOM: f64 = 1.0 + 1e-9;
        let angle = radius_mi / EARTH_RADIUS_MI;
        let vertiports = places.len();
        let around = |(vertiport, place): (usize, Place)| {
            // Where a circle about latitude f is widest, sin(half width) = sin(angle) / cos(f). A
            // circle that reaches a pole has all longitudes.
            let sine = libm::sin(angle) / libm::cos(place.latitude.to_radians());
            let reaches_pole = place.latitude.abs() + angle.to_degrees() >= 90.0;
            let half_width =
                if reaches_pole { 360.0 } else { libm::asin(sine.min(1.0)).to_degrees() };
            Box { place, vertiport, half_width: half_width * ROOM }
        };
        let mut boxes: Vec<Box> = places.into_iter().enumerate().map(around).collect();
        boxes.sort_by(|one, other| one.place.latitude.total_cmp(&other.place.latitude));
        Self { boxes, radius_mi, half_height: angle.to_degrees() * ROOM, vertiports }
    }

    /// Number of vertiports.
    pub(super) fn vertiports(&self) -> usize {
        self.vertiports
    }

    /// The nearest vertiport within the radius of a place; of two that are equally near, the first
    /// in file order.
    #[inline]
    pub(crate) fn of(&self, place: Place) -> Option<Near> {
        let lowest = place.latitude - self.half_height;
        let highest = place.latitude + self.half_height;
        let first = self.boxes.partition_point(|other| other.place.latitude < lowest);
        let mut nearest: Option<Near> = None;
        for other in self.boxes[first..].iter().take_while(|other| other.place.latitude <= highest)
        {
            let apart = (place.longitude - other.place.longitude).abs();
            if apart.min(360.0 - apart) > other.half_width {
                continue;
            }
            let distance_mi = place.distance_mi(other.place);
            let nearer =
                |than: Near| (distance_mi, other.vertiport) < (than.distance_mi, than.vertiport);
            if distance_mi <= self.radius_mi && nearest.is_none_or(nearer) {
                nearest = Some(Near { vertiport: other.vertiport, distance_mi });
            }
        }
        nearest
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::{prop, proptest};

    use super::{Near, Nearby};
    use crate::globe::Place;

    /// Looks at every vertiport.
    fn nearest_of_all(places: &[Place], place: Place, radius_mi: f64) -> Option<Near> {
        let distances = places.iter().map(|other| place.distance_mi(*other)).enumerate();
        let near = distances.filter(|(_, distance_mi)| *distance_mi <= radius_mi);
        near.min_by(|one, other| one.1.total_cmp(&other.1))
            .map(|(vertiport, distance_mi)| Near { vertiport, distance_mi })
    }

    fn places(degrees: &[(f64, f64)]) -> Vec<Place> {
        degrees.iter().map(|&(latitude, longitude)| Place { latitude, longitude }).collect()
    }

    proptest! {
        #[test]
        fn boxes_change_no_decision_in_a_region(
            vertiports in prop::collection::vec((40.0..41.0_f64, -74.5..-73.0_f64), 1..40),
            place in (39.9..41.1_f64, -74.6..-72.9_f64),
            radius_mi in 0.1..40.0_f64,
        ) {
            let (vertiports, place) = (places(&vertiports), places(&[place])[0]);
            let nearby = Nearby::new(vertiports.clone(), radius_mi);
            assert_eq!(nearby.of(place), nearest_of_all(&vertiports, place, radius_mi));
        }

        #[test]
        fn boxes_change_no_decision_on_the_globe(
            vertiports in prop::collection::vec((-89.0..89.0_f64, -180.0..180.0_f64), 1..60),
            place in (-90.0..90.0_f64, -180.0..180.0_f64),
            radius_mi in 0.1..500.0_f64,
        ) {
            let (vertiports, place) = (places(&vertiports), places(&[place])[0]);
            let nearby = Nearby::new(vertiports.clone(), radius_mi);
            assert_eq!(nearby.of(place), nearest_of_all(&vertiports, place, radius_mi));
        }
    }

    #[test]
    fn places_across_the_date_line_are_near_and_ties_go_to_the_first_in_the_file() {
        let nearby = Nearby::new(places(&[(10.0, 179.99), (10.2, 0.0), (10.1, 0.0)]), 20.0);
        let near = nearby.of(places(&[(10.0, -179.99)])[0]).expect("1.4 miles away");
        assert_eq!(near.vertiport, 0);
        let between = Nearby::new(places(&[(0.1, 0.0), (-0.1, 0.0)]), 20.0);
        assert_eq!(between.of(places(&[(0.0, 0.0)])[0]).expect("7 miles away").vertiport, 0);
    }
}
