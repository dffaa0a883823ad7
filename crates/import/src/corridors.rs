//! Corridors from the lines of a map, with their lengths.
//!
//! Lines on maps rarely begin exactly at a vertiport. The length of a corridor is the length of its
//! line and of the gaps at both ends, so that it is never below the straight distance of the
//! vertiports.

use std::collections::HashMap;

use crate::features::{self, Shape};
use crate::globe::{Place, length_mi};
use crate::input_file::InputFile;
use crate::row::{Column, optional, required};
use crate::vertiports::Vertiports;
use crate::{Error, Warning};

/// How far from its vertiports a line may begin and end, miles.
const NEAR_MI: f64 = 1.0;

const FROM: usize = 0;
const TO: usize = 1;
const BOTH_WAYS: usize = 2;
const COLUMNS: [Column; 3] = [required(&["from"]), required(&["to"]), optional(&["both_ways"])];

/// A corridor between two vertiports, by their positions.
#[derive(Debug)]
pub(crate) struct Corridor {
    pub(crate) ends: (usize, usize),
    pub(crate) both_ways: bool,
    /// Length of the way from vertiport to vertiport, miles.
    pub(crate) length_mi: f64,
}

/// Reads a GeoJSON file of lines.
pub(crate) fn read(
    file: &InputFile<'_>,
    vertiports: &Vertiports,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Corridor>, Error> {
    let mut corridors = Vec::new();
    let mut known: HashMap<(usize, usize), usize> = HashMap::new();
    features::shapes(file, &COLUMNS, warnings, |shape| {
        let corridor = corridor(shape, vertiports)?;
        let (from, to) = corridor.ends;
        let routes = [(from, to), (to, from)];
        for route in routes.into_iter().take(1 + usize::from(corridor.both_ways)) {
            if let Some(before) = known.insert(route, shape.row.position) {
                let (from, to) = (&vertiports.list[route.0].id, &vertiports.list[route.1].id);
                let what = format!("the corridor from {from:?} to {to:?}");
                return Err(shape.row.given_twice(what, before));
            }
        }
        corridors.push(corridor);
        Ok(())
    })?;
    if corridors.is_empty() {
        return Err(Error::Nothing { origin: file.origin(), what: "corridors" });
    }
    Ok(corridors)
}

fn corridor(shape: &Shape<'_>, vertiports: &Vertiports) -> Result<Corridor, Error> {
    let ends = shape.row.pair(FROM, TO, vertiports)?;
    let line = shape.line()?;
    let mut way_mi = length_mi(&line);
    for (place, end, vertiport) in [(line.first(), "begin", ends.0), (line.last(), "end", ends.1)] {
        let Some(&place) = place else { continue };
        way_mi += gap_mi(shape, place, end, vertiport, vertiports)?;
    }
    let both_ways = shape.row.optional_flag(BOTH_WAYS)?.unwrap_or(true);
    Ok(Corridor { ends, both_ways, length_mi: way_mi })
}

/// The distance between an end of a line and its vertiport, miles, which must be small.
fn gap_mi(
    shape: &Shape<'_>,
    place: Place,
    end: &'static str,
    vertiport: usize,
    vertiports: &Vertiports,
) -> Result<f64, Error> {
    let vertiport = &vertiports.list[vertiport];
    let found_mi = place.distance_mi(vertiport.place);
    if found_mi <= NEAR_MI {
        return Ok(found_mi);
    }
    let exchanged = Place::new(place.longitude, place.latitude);
    let exchanged = exchanged.is_some_and(|place| place.distance_mi(vertiport.place) <= NEAR_MI);
    Err(Error::CorridorEnd {
        origin: shape.row.origin.to_owned(),
        place: shape.row.place(),
        end,
        vertiport: vertiport.id.clone(),
        limit_mi: NEAR_MI,
        found_mi,
        exchanged,
    })
}
