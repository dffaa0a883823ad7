//! Corridors of the network file: pairs that may be flown, with the length of the way where it is
//! not straight.

use serde::Deserialize;

use crate::limits::{self, number};
use crate::raw::{Positions, RawRoute, each};
use crate::{FormatError, Matrix, Route};

/// How much shorter than the straight line a corridor may be, as a share: lengths are rounded, and
/// taken from maps.
const ROUNDING: f64 = 0.01;

/// A corridor of the network file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a corridor")]
pub(crate) struct RawCorridor {
    from: String,
    to: String,
    #[serde(default)]
    both_ways: bool,
    length_mi: Option<f64>,
}

/// Checks corridors, and puts the lengths that they state in place of the straight distances.
pub(crate) fn corridors(
    raw: Vec<RawCorridor>,
    places: &Positions,
    distance_mi: &mut Matrix<f64>,
) -> Result<Vec<Route>, FormatError> {
    each(raw, |corridor, at| corridor.check(at, places, distance_mi))
}

impl RawCorridor {
    /// Checks the corridor at a position of the list, and puts its length in place of the straight
    /// distance.
    pub(crate) fn check(
        self,
        at: usize,
        places: &Positions,
        distance_mi: &mut Matrix<f64>,
    ) -> Result<Route, FormatError> {
        let Self { from, to, both_ways, length_mi } = self;
        let member = format!("corridors[{at}]");
        let route = RawRoute { from, to, both_ways }.check(places, &member)?;
        let Some(length_mi) = length_mi.filter(|_| route.from != route.to) else {
            return Ok(route);
        };
        let member = || format!("{member}: length_mi");
        limits::DISTANCE_MI.check(length_mi, member)?;
        let straight_mi = distance_mi[(route.from, route.to)];
        if length_mi < (1.0 - ROUNDING) * straight_mi {
            return Err(FormatError::OutOfRange {
                member: member(),
                rule: format!("at least {straight_mi:.2}, the straight line"),
                found: number(length_mi),
                hint: Some("length_mi is the length of the way along the corridor, in miles"),
            });
        }
        distance_mi[(route.from, route.to)] = length_mi;
        if both_ways {
            distance_mi[(route.to, route.from)] = length_mi;
        }
        Ok(route)
    }
}
