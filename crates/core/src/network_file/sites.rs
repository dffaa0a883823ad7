//! The positions of vertiports and the distances between them, in the plane or on the globe.
//!
//! A network file places its vertiports either in miles on a plane or by latitude and longitude.
//! With the latter, distances are great circles (haversine), and the plane is an equirectangular
//! projection about the vertiports' middle; it is good enough for maps of a region and used for
//! nothing else. Angles go through the `libm` crate, because the results of the system's library
//! depend on the machine.

use serde::Deserialize;

use super::tariffs::SiteCosts;
use crate::limits::{self, Limits};
use crate::raw::{chargers, each};
use crate::{Degrees, FormatError, Matrix, Vertiport, check};

/// Mean radius of the Earth (IUGG), miles.
pub const EARTH_RADIUS_MI: f64 = 3_958.761_3;

/// The vertiports with the distances between them.
pub(crate) struct Sites {
    pub(crate) vertiports: Vec<Vertiport>,
    /// d_ij, miles.
    pub(crate) distance_mi: Matrix<f64>,
}

/// A vertiport of the network file.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a vertiport")]
pub(crate) struct RawSite {
    id: String,
    x_mi: Option<f64>,
    y_mi: Option<f64>,
    latitude: Option<f64>,
    longitude: Option<f64>,
    stands: f64,
    chargers: Option<f64>,
    charger_kw: Option<f64>,
    busy: bool,
    stand_cost_usd_per_day: Option<f64>,
    charger_cost_usd_per_day: Option<f64>,
}

/// A position, given in one of two ways.
#[derive(Clone, Copy)]
pub(crate) enum Position {
    /// Miles east and north.
    Plane(f64, f64),
    Globe(Degrees),
}

impl Sites {
    /// Checks the vertiports. `costs` are those of stands and chargers at vertiports that name
    /// none.
    pub(crate) fn of(raw: Vec<RawSite>, costs: SiteCosts) -> Result<Self, FormatError> {
        let sites = each(raw, |raw, at| raw.check(at, costs))?;
        let on_globe =
            |(_, position): &&(Vertiport, Position)| matches!(position, Position::Globe(..));
        match sites.iter().filter(on_globe).count() {
            0 => Ok(Self::in_plane(sites.into_iter().map(|(vertiport, _)| vertiport).collect())),
            all if all == sites.len() => Ok(Self::on_globe(sites)),
            some => Err(FormatError::NotOneOf {
                member: "vertiports".to_owned(),
                choices: "exactly one of x_mi with y_mi (all of them) and latitude with longitude (all of them)",
                found: 1 + usize::from(some > 0),
            }),
        }
    }

    /// Distances are straight lines. Products, sum and root are exact to the last bit on every
    /// machine, which `hypot` is not.
    fn in_plane(vertiports: Vec<Vertiport>) -> Self {
        let distance_mi = Matrix::from_fn(vertiports.len(), |from, to| {
            let (from, to) = (&vertiports[from.at()], &vertiports[to.at()]);
            let (east, north) = (to.x_mi - from.x_mi, to.y_mi - from.y_mi);
            (east * east + north * north).sqrt()
        });
        Self { vertiports, distance_mi }
    }

    /// Distances are great circles.
    fn on_globe(sites: Vec<(Vertiport, Position)>) -> Self {
        let degrees = |position| match position {
            Position::Plane(x_mi, y_mi) => (y_mi, x_mi),
            Position::Globe(degrees) => (degrees.latitude, degrees.longitude),
        };
        let mut places: Vec<(f64, f64)> =
            sites.iter().map(|&(_, position)| degrees(position)).collect();
        let distance_mi = Matrix::from_fn(places.len(), |from, to| {
            great_circle_mi(places[from.at()], places[to.at()])
        });
        count_past_antimeridian(&mut places);
        let count = places.len() as f64;
        let middle = (
            places.iter().map(|place| place.0).sum::<f64>() / count,
            places.iter().map(|place| place.1).sum::<f64>() / count,
        );
        let vertiports = sites.into_iter().zip(&places).map(|((vertiport, _), &place)| {
            let (x_mi, y_mi) = projected_mi(middle, place);
            Vertiport { x_mi, y_mi, ..vertiport }
        });
        Self { vertiports: vertiports.collect(), distance_mi }
    }
}

/// Where places lie on both sides of the antimeridian, counts longitudes in the east on past 180
/// degrees, so that neighbours are next to each other in the plane. Others are left as they are, to
/// the bit.
fn count_past_antimeridian(places: &mut [(f64, f64)]) {
    let longitudes = || places.iter().map(|place| place.1);
    let west = longitudes().fold(f64::INFINITY, f64::min);
    let east = longitudes().fold(f64::NEG_INFINITY, f64::max);
    if east - west > 180.0 {
        for (_, longitude) in places.iter_mut().filter(|place| place.1 < 0.0) {
            *longitude += 360.0;
        }
    }
}

impl RawSite {
    pub(crate) fn id(&self) -> &str {
        &self.id
    }

    /// Checks the vertiport at a position of the list.
    pub(crate) fn check(
        self,
        at: usize,
        costs: SiteCosts,
    ) -> Result<(Vertiport, Position), FormatError> {
        check::id(|| format!("vertiports[{at}]: id"), &self.id)?;
        let number = |value: f64, limits: &Limits, member: &str| {
            limits.check(value, || format!("vertiport {:?}: {member}", self.id))
        };
        let position = match (self.x_mi, self.y_mi, self.latitude, self.longitude) {
            (Some(x_mi), Some(y_mi), None, None) => Position::Plane(x_mi, y_mi),
            (None, None, Some(latitude), Some(longitude)) => {
                number(latitude, &limits::LATITUDE, "latitude")?;
                number(longitude, &limits::LONGITUDE, "longitude")?;
                Position::Globe(Degrees { latitude, longitude })
            }
            (x_mi, y_mi, latitude, longitude) => {
                let plane = x_mi.is_some() && y_mi.is_some();
                let globe = latitude.is_some() && longitude.is_some();
                return Err(FormatError::NotOneOf {
                    member: format!("vertiport {:?}", self.id),
                    choices: "exactly one of x_mi with y_mi and latitude with longitude, and nothing of the other",
                    found: usize::from(plane) + usize::from(globe),
                });
            }
        };
        let (x_mi, y_mi, degrees) = match position {
            Position::Plane(x_mi, y_mi) => (x_mi, y_mi, None),
            Position::Globe(degrees) => (0.0, 0.0, Some(degrees)),
        };
        let member = || format!("vertiport {:?}: stands", self.id);
        let stands = limits::STANDS.whole_number(self.stands, member)?;
        let chargers = chargers(&self.id, self.chargers)?;
        let cost = |own: Option<f64>, usual_usd: f64, member: &str| {
            let cost_usd = own.unwrap_or(usual_usd);
            number(cost_usd, &limits::MONEY_USD, member).map(|()| cost_usd)
        };
        let stand_cost_usd =
            cost(self.stand_cost_usd_per_day, costs.stand_usd, "stand_cost_usd_per_day")?;
        let charger_cost_usd =
            cost(self.charger_cost_usd_per_day, costs.charger_usd, "charger_cost_usd_per_day")?;
        let vertiport = Vertiport {
            x_mi,
            y_mi,
            stands,
            chargers,
            charger_kw: self.charger_kw,
            busy: self.busy,
            degrees,
            stand_cost_usd,
            charger_cost_usd,
            id: self.id,
        };
        Ok((vertiport, position))
    }
}

/// The great-circle distance by the haversine formula, miles; places are latitude and longitude in
/// degrees.
pub fn great_circle_mi(from: (f64, f64), to: (f64, f64)) -> f64 {
    let (from_north, to_north) = (from.0.to_radians(), to.0.to_radians());
    let half_north = libm::sin((to_north - from_north) / 2.0);
    let half_east = libm::sin((to.1 - from.1).to_radians() / 2.0);
    let haversine = half_north * half_north
        + libm::cos(from_north) * libm::cos(to_north) * half_east * half_east;
    2.0 * EARTH_RADIUS_MI * libm::asin(haversine.sqrt().min(1.0))
}

/// Miles east and north of the middle: x = R cos(middle latitude) Δlongitude, y = R Δlatitude.
fn projected_mi(middle: (f64, f64), place: (f64, f64)) -> (f64, f64) {
    let shrunk = libm::cos(middle.0.to_radians());
    let mile = |degrees: f64| EARTH_RADIUS_MI * degrees.to_radians();
    (mile(place.1 - middle.1) * shrunk, mile(place.0 - middle.0))
}

#[cfg(test)]
mod tests {
    use super::{count_past_antimeridian, great_circle_mi, projected_mi};

    #[test]
    fn a_degree_of_latitude_is_sixty_nine_miles_and_a_quarter_of_the_globe_ninety_times_that() {
        let degree = great_circle_mi((40.0, -74.0), (41.0, -74.0));
        assert!((degree - 69.094).abs() < 1e-3, "{degree}");
        let quarter = great_circle_mi((0.0, 0.0), (0.0, 90.0));
        assert!((quarter - 90.0 * degree).abs() < 1e-6, "{quarter}");
        assert_eq!(great_circle_mi((40.7, -74.0), (40.7, -74.0)), 0.0);
    }

    #[test]
    fn places_on_both_sides_of_the_antimeridian_are_neighbours_in_the_plane() {
        let mut places = [(-17.0, 179.5), (-16.5, -179.5)];
        let apart_mi = great_circle_mi(places[0], places[1]);
        count_past_antimeridian(&mut places);
        let middle = (-16.75, 180.0);
        let (a, b) = (projected_mi(middle, places[0]), projected_mi(middle, places[1]));
        assert!(a.0 < 0.0 && b.0 > 0.0, "the second lies east of the first");
        assert!(((a.0 - b.0).hypot(a.1 - b.1) - apart_mi).abs() < 0.1);
        let mut others = [(40.0, -74.0), (48.0, 2.0)];
        count_past_antimeridian(&mut others);
        assert_eq!(others, [(40.0, -74.0), (48.0, 2.0)]);
    }

    #[test]
    fn within_a_region_the_plane_agrees_with_the_globe() {
        let (one, other) = ((40.63993, -73.77869), (41.06695, -73.70757));
        let middle = (40.8, -73.9);
        let (a, b) = (projected_mi(middle, one), projected_mi(middle, other));
        let straight = (a.0 - b.0).hypot(a.1 - b.1);
        assert!((straight - great_circle_mi(one, other)).abs() < 0.05, "{straight}");
    }
}
