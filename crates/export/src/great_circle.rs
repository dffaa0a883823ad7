//! Great circles: the shortest way between two places on the globe, which a straight flight
//! follows.
//!
//! The globe is a sphere here. Trigonometry comes from `libm`, because the operating system's own
//! functions may differ in the last bit, and the same day is to give the same file everywhere.

use vertifleet_core::{Degrees, EARTH_RADIUS_MI};

/// Below this distance from 0 or 180 degrees, in radians, two places do not determine which great
/// circle leads from one to the other.
const TOO_NARROW: f64 = 1e-9;

/// The way from one place to another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GreatCircle {
    from: Degrees,
    to: Degrees,
    /// Both places as points of the unit sphere.
    ends: [[f64; 3]; 2],
    /// The angle between the places, radians.
    angle: f64,
}

impl GreatCircle {
    /// The way between two places.
    pub(crate) fn between(from: Degrees, to: Degrees) -> Self {
        let ends = [point(from), point(to)];
        let [[ax, ay, az], [bx, by, bz]] = ends;
        let cross = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
        let [x, y, z] = cross;
        let angle = libm::atan2((x * x + y * y + z * z).sqrt(), ax * bx + ay * by + az * bz);
        let to = Degrees { longitude: near(to.longitude, from.longitude), ..to };
        Self { from, to, ends, angle }
    }

    /// The length of the way, miles.
    pub(crate) fn length_mi(&self) -> f64 {
        EARTH_RADIUS_MI * self.angle
    }

    /// The place after a share of the way, from 0 to 1, to the nearest 1e-7 degrees, which is about
    /// a centimetre; the ends are exact. Longitudes continue past 180 degrees rather than leap to
    /// -180, so that no line crosses the whole map.
    pub(crate) fn at(&self, share: f64) -> Degrees {
        if share <= 0.0 {
            return self.from;
        }
        if share >= 1.0 {
            return self.to;
        }
        let place = self.spherical(share).unwrap_or_else(|| self.linear(share));
        Degrees { latitude: rounded(place.latitude), longitude: rounded(place.longitude) }
    }

    /// Spherical linear interpolation.
    fn spherical(&self, share: f64) -> Option<Degrees> {
        let sine = libm::sin(self.angle);
        if sine < TOO_NARROW {
            return None;
        }
        let weights =
            [libm::sin((1.0 - share) * self.angle) / sine, libm::sin(share * self.angle) / sine];
        let [start, end] = self.ends;
        let along = |axis: usize| weights[0] * start[axis] + weights[1] * end[axis];
        let [x, y, z] = [along(0), along(1), along(2)];
        let latitude = libm::atan2(z, (x * x + y * y).sqrt()).to_degrees();
        let longitude = libm::atan2(y, x).to_degrees();
        Some(Degrees { latitude, longitude: near(longitude, self.from.longitude) })
    }

    /// For places that are the same or opposite.
    fn linear(&self, share: f64) -> Degrees {
        let between = |from: f64, to: f64| from + share * (to - from);
        Degrees {
            latitude: between(self.from.latitude, self.to.latitude),
            longitude: between(self.from.longitude, self.to.longitude),
        }
    }
}

fn point(place: Degrees) -> [f64; 3] {
    let (latitude, longitude) = (place.latitude.to_radians(), place.longitude.to_radians());
    let radius = libm::cos(latitude);
    [radius * libm::cos(longitude), radius * libm::sin(longitude), libm::sin(latitude)]
}

/// The longitude of the same meridian that lies within 180 degrees of another longitude.
fn near(longitude: f64, other: f64) -> f64 {
    if longitude - other > 180.0 {
        longitude - 360.0
    } else if longitude - other < -180.0 {
        longitude + 360.0
    } else {
        longitude
    }
}

fn rounded(degrees: f64) -> f64 {
    (degrees * 1e7).round() / 1e7
}

#[cfg(test)]
mod tests {
    use vertifleet_core::Degrees;

    use super::GreatCircle;

    fn place(latitude: f64, longitude: f64) -> Degrees {
        Degrees { latitude, longitude }
    }

    #[test]
    fn a_degree_of_the_equator_is_69_miles_long() {
        let way = GreatCircle::between(place(0.0, 10.0), place(0.0, 11.0));
        assert!((way.length_mi() - 69.0935).abs() < 1e-3, "{}", way.length_mi());
        assert_eq!(way.at(0.5), place(0.0, 10.5));
    }

    #[test]
    fn the_way_leads_north_of_a_parallel() {
        let way = GreatCircle::between(place(60.0, 0.0), place(60.0, 90.0));
        let middle = way.at(0.5);
        assert!((middle.longitude - 45.0).abs() < 1e-6);
        // tan(latitude) = tan(60) / cos(45) in the middle.
        assert!((middle.latitude - 67.792_345_7).abs() < 1e-6, "{}", middle.latitude);
    }

    #[test]
    fn the_ends_are_exact() {
        let (from, to) = (place(40.712_345_678_9, -74.0), place(40.8, -73.912_345_678_9));
        let way = GreatCircle::between(from, to);
        assert_eq!((way.at(0.0), way.at(1.0)), (from, to));
    }

    #[test]
    fn longitudes_go_on_past_the_date_line() {
        let east = GreatCircle::between(place(-17.0, 179.0), place(-17.0, -179.0));
        assert_eq!(east.at(1.0).longitude, 181.0);
        assert!((east.at(0.75).longitude - 180.5).abs() < 1e-3);
        let west = GreatCircle::between(place(-17.0, -179.0), place(-17.0, 179.0));
        assert_eq!(west.at(1.0).longitude, -181.0);
        assert!(west.length_mi() < 140.0);
    }

    #[test]
    fn the_same_place_and_the_opposite_place_have_a_way_too() {
        let here = place(10.0, 20.0);
        assert_eq!(GreatCircle::between(here, here).at(0.5), here);
        let opposite = GreatCircle::between(here, place(-10.0, -160.0));
        assert_eq!(opposite.at(0.5), place(0.0, -70.0));
    }
}
