//! The features of a GeoJSON file as rows: properties are columns, and the geometry comes with them.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::path::Path;

use geojson::feature::Id;
use geojson::{Feature, FeatureCollection, GeometryValue, JsonValue, LineStringType, Position};
use vertifleet_core::read_at_most;

use crate::Error;
use crate::cell::Cell;
use crate::error::shortened;
use crate::globe::Place;
use crate::row::{Column, Positions, Row};
use crate::table::{LONGEST, text, without_mark};

/// Whether a file is GeoJSON, by its name or, where the name does not say, by its first character.
pub(crate) fn is_geojson(path: &Path) -> Result<bool, Error> {
    let extension = path.extension().map(OsStr::to_ascii_lowercase);
    match extension.as_ref().and_then(|extension| extension.to_str()) {
        Some("geojson" | "json") => Ok(true),
        Some("csv" | "parquet") => Ok(false),
        _ => {
            let bytes = read_at_most(path, LONGEST)?;
            Ok(without_mark(&bytes).trim_ascii_start().starts_with(b"{"))
        }
    }
}

/// A feature: its properties as a row, and its geometry.
pub(crate) struct Shape<'a> {
    pub(crate) row: Row<'a>,
    geometry: Option<&'a GeometryValue>,
}

/// The edge of a polygon or of a hole in one.
pub(crate) struct Ring {
    pub(crate) edge: Vec<Place>,
    pub(crate) is_hole: bool,
}

/// Calls `each` with every feature of a file. A column named `id` is also the feature's own `id`, if no property has
/// this name.
pub(crate) fn shapes(
    path: &Path,
    columns: &[Column],
    mut each: impl FnMut(&Shape<'_>) -> Result<(), Error>,
) -> Result<usize, Error> {
    let origin = path.display().to_string();
    let bytes = read_at_most(path, LONGEST)?;
    let kind = "a GeoJSON FeatureCollection";
    let collection: FeatureCollection = serde_json::from_slice(text(&bytes, kind, &origin)?)
        .map_err(|error| {
            let problem = shortened(&error.to_string(), 300);
            Error::NotParsed { origin: origin.clone(), kind, problem }
        })?;
    for (feature, position) in collection.features.iter().zip(1..) {
        let values: Vec<Option<Cow<'_, str>>> =
            columns.iter().map(|column| value(feature, column)).collect();
        let texts = values.iter().map(|value| value.as_ref().map(|value| value.as_bytes()));
        let cells: Vec<Cell<'_>> =
            texts.map(|text| text.map_or(Cell::Missing, Cell::text)).collect();
        let positions = Positions::Features;
        let row = Row { origin: &origin, positions, position, columns, cells: &cells };
        let geometry = feature.geometry.as_ref().map(|geometry| &geometry.value);
        each(&Shape { row, geometry })?;
    }
    Ok(collection.features.len())
}

/// The value of the first of the column's names that the feature has.
fn value<'a>(feature: &'a Feature, column: &Column) -> Option<Cow<'a, str>> {
    let property = |name: &&str| match feature.property(name)? {
        JsonValue::Null => None,
        JsonValue::String(text) => Some(Cow::Borrowed(text.as_str())),
        other => Some(Cow::Owned(other.to_string())),
    };
    column.names.iter().find_map(property).or_else(|| {
        let id = feature.id.as_ref().filter(|_| column.names.contains(&"id"))?;
        Some(match id {
            Id::String(text) => Cow::Borrowed(text.as_str()),
            Id::Number(number) => Cow::Owned(number.to_string()),
        })
    })
}

impl Shape<'_> {
    /// The place of a point.
    pub(crate) fn point(&self) -> Result<Place, Error> {
        match self.geometry {
            Some(GeometryValue::Point { coordinates }) => self.place(coordinates),
            _ => Err(self.wrong("a Point")),
        }
    }

    /// The places along a line. A line that is the only one of a set of lines is also a line.
    pub(crate) fn line(&self) -> Result<Vec<Place>, Error> {
        const EXPECTED: &str = "a LineString of at least two positions";
        let line = match self.geometry {
            Some(GeometryValue::LineString { coordinates }) => coordinates,
            Some(GeometryValue::MultiLineString { coordinates }) if coordinates.len() == 1 => {
                &coordinates[0]
            }
            Some(GeometryValue::MultiLineString { coordinates }) => {
                return Err(self.wrong_count(EXPECTED, coordinates.len(), "line"));
            }
            _ => return Err(self.wrong(EXPECTED)),
        };
        match line.len() {
            count @ 0..2 => Err(self.wrong_count(EXPECTED, count, "position")),
            _ => self.places(line),
        }
    }

    /// An error that says how many parts a geometry of the right kind has.
    fn wrong_count(&self, expected: &'static str, count: usize, part: &str) -> Error {
        let kind = self.geometry.map_or("none", GeometryValue::type_name);
        let parts = if count == 1 { part.to_owned() } else { format!("{part}s") };
        Error::WrongGeometry {
            origin: self.row.origin.to_owned(),
            place: self.row.place(),
            expected,
            found: format!("{kind} of {count} {parts}"),
        }
    }

    /// The rings of all polygons; `None` if the geometry is no area.
    pub(crate) fn rings(&self) -> Result<Option<Vec<Ring>>, Error> {
        let polygons = match self.geometry {
            Some(GeometryValue::Polygon { coordinates }) => std::slice::from_ref(coordinates),
            Some(GeometryValue::MultiPolygon { coordinates }) => coordinates.as_slice(),
            _ => return Ok(None),
        };
        let rings = polygons.iter().flat_map(|rings| {
            rings
                .iter()
                .enumerate()
                .map(|(at, ring)| Ok(Ring { edge: self.places(ring)?, is_hole: at > 0 }))
        });
        rings.collect::<Result<_, Error>>().map(Some)
    }

    /// An error that says that the geometry is not the one that is needed.
    pub(crate) fn wrong(&self, expected: &'static str) -> Error {
        Error::WrongGeometry {
            origin: self.row.origin.to_owned(),
            place: self.row.place(),
            expected,
            found: self.geometry.map_or("none", GeometryValue::type_name).to_owned(),
        }
    }

    fn places(&self, line: &LineStringType) -> Result<Vec<Place>, Error> {
        line.iter().map(|position| self.place(position)).collect()
    }

    fn place(&self, position: &Position) -> Result<Place, Error> {
        let place = match *position.as_slice() {
            [longitude, latitude, ..] => Place::new(latitude, longitude),
            _ => None,
        };
        place.ok_or_else(|| Error::WrongGeometry {
            origin: self.row.origin.to_owned(),
            place: self.row.place(),
            expected: "given in longitude from -180 to 180 and latitude from -90 to 90",
            found: format!("{:?}", position.as_slice()),
        })
    }
}
