//! The vertiports of a network, from a table or from the points of a map.

use std::collections::HashMap;
use std::path::Path;

use crate::cell::printable;
use crate::features;
use crate::globe::Place;
use crate::input_file::InputFile;
use crate::row::{Column, Row, optional, required};
use crate::table;
use crate::{Error, Warning};

/// The most vertiports that a network takes.
const MOST: usize = 256;
/// Stands of a vertiport for which the file gives none.
pub(crate) const ASSUMED_STANDS: u32 = 4;
/// The farthest from the equator that a vertiport may lie, degrees.
const MOST_LATITUDE: f64 = 89.0;

const ID: usize = 0;
const STANDS: usize = 1;
const CHARGERS: usize = 2;
const CHARGER_KW: usize = 3;
const BUSY: usize = 4;
const NAME: usize = 5;
const LATITUDE: usize = 6;
const LONGITUDE: usize = 7;
/// The names of the columns of a place in a table.
pub(crate) const LATITUDES: &[&str] = &["latitude", "lat"];
pub(crate) const LONGITUDES: &[&str] = &["longitude", "lon", "lng", "long"];
/// The columns of a table, and up to the name the properties of a point.
const COLUMNS: [Column; 8] = [
    required(&["id"]),
    optional(&["stands"]),
    optional(&["chargers"]),
    optional(&["charger_kw"]),
    optional(&["busy"]),
    optional(&["name"]),
    required(LATITUDES),
    required(LONGITUDES),
];

/// A vertiport as the planner's file gives it.
#[derive(Debug)]
pub(crate) struct Vertiport {
    pub(crate) id: String,
    pub(crate) place: Place,
    /// Number of stands, if the file gives it.
    pub(crate) stands: Option<u32>,
    pub(crate) chargers: Option<u32>,
    /// The most power of a charger, if the file gives it, kW.
    pub(crate) charger_kw: Option<f64>,
    pub(crate) busy: bool,
    pub(crate) name: Option<String>,
}

/// The vertiports in file order, found by id.
#[derive(Debug, Default)]
pub(crate) struct Vertiports {
    pub(crate) list: Vec<Vertiport>,
    positions: HashMap<String, usize>,
    /// Those whose ids are whole numbers, also where tables write them with a fraction of zero
    /// (`1.0`); `None` for a number that several ids are.
    by_number: HashMap<i64, Option<usize>>,
}

impl Vertiports {
    /// Reads a CSV table or a GeoJSON file of points.
    pub(crate) fn read(file: &InputFile<'_>, warnings: &mut Vec<Warning>) -> Result<Self, Error> {
        let mut vertiports = Self::default();
        // The position of each vertiport in the file.
        let mut places = Vec::new();
        if features::is_geojson(file)? {
            features::shapes(file, &COLUMNS[..=NAME], warnings, |shape| {
                let place = shape.point()?;
                if place.latitude.abs() > MOST_LATITUDE {
                    return Err(shape.wrong("within 89 degrees of the equator"));
                }
                vertiports.add(&shape.row, place, &mut places)
            })?;
        } else {
            table::rows(file, &COLUMNS, warnings, |row| {
                let place = row.degrees(LATITUDE, LONGITUDE, MOST_LATITUDE)?;
                vertiports.add(row, place, &mut places)
            })?;
        }
        if vertiports.list.is_empty() {
            let origin = file.origin();
            return Err(Error::Nothing { origin, what: "vertiports" });
        }
        Ok(vertiports)
    }

    fn add(&mut self, row: &Row<'_>, place: Place, places: &mut Vec<usize>) -> Result<(), Error> {
        let id = row.id(ID)?;
        let at = self.list.len();
        if let Some(&before) = self.positions.get(&id) {
            return Err(row.given_twice(format!("vertiport {id:?}"), places[before]));
        }
        if at == MOST {
            return Err(Error::TooMany {
                origin: row.origin.to_owned(),
                what: "the number of vertiports",
                most: MOST,
                found: MOST + 1,
            });
        }
        let count = |column| -> Result<Option<u32>, Error> {
            let count = row.optional_whole(column, 1, 10_000)?;
            Ok(count.and_then(|count| u32::try_from(count).ok()))
        };
        self.list.push(Vertiport {
            place,
            stands: count(STANDS)?,
            chargers: count(CHARGERS)?,
            charger_kw: row.optional_number(CHARGER_KW, 1.0, 100_000.0)?,
            busy: row.optional_flag(BUSY)?.unwrap_or(false),
            name: row.has(NAME).then(|| row.text(NAME)).transpose()?.map(|name| printable(&name)),
            id: id.clone(),
        });
        self.positions.insert(id, at);
        if let Some(number) = row.cells[ID].whole() {
            self.by_number
                .entry(number)
                .and_modify(|position| *position = None)
                .or_insert(Some(at));
        }
        places.push(row.position);
        Ok(())
    }

    /// The position of the vertiport of this id, or of this number if the id is one.
    pub(crate) fn find(&self, id: &str, number: Option<i64>) -> Option<usize> {
        let by_number = || *self.by_number.get(&number?)?;
        self.positions.get(id).copied().or_else(by_number)
    }

    /// The ids in file order.
    pub(crate) fn ids(&self) -> impl Iterator<Item = &str> {
        self.list.iter().map(|vertiport| vertiport.id.as_str())
    }
}

/// Vertiports that are nearer to each other than this are at the same place, miles.
const SAME_PLACE_MI: f64 = 0.01;
/// Where all vertiports of a network lie nearer to a pole than this, latitude and longitude are
/// exchanged: no town of some size does, and the longitudes of much of America do. Degrees.
const POLAR_LATITUDE: f64 = 72.0;

impl Vertiports {
    /// Warnings of places that are probably wrong.
    pub(crate) fn warnings(&self, path: &Path) -> Vec<Warning> {
        let warning = |problem| Warning::Places { origin: path.display().to_string(), problem };
        let polar = self.list.iter().all(|one| one.place.latitude.abs() > POLAR_LATITUDE);
        let polar = polar.then(|| {
            let problem = "all vertiports are within 18 degrees of a pole: latitude and longitude may be exchanged";
            warning(problem.to_owned())
        });
        let same = self.at_the_same_place().map(|(one, other)| {
            let (one, other) = (&one.id, &other.id);
            warning(format!("the vertiports {one:?} and {other:?} are at the same place"))
        });
        polar.into_iter().chain(same).collect()
    }

    /// The first two vertiports that are at the same place.
    fn at_the_same_place(&self) -> Option<(&Vertiport, &Vertiport)> {
        let pairs = (1..self.list.len()).flat_map(|to| (0..to).map(move |from| (from, to)));
        let mut pairs = pairs.map(|(from, to)| (&self.list[from], &self.list[to]));
        pairs.find(|(one, other)| one.place.distance_mi(other.place) < SAME_PLACE_MI)
    }
}
