//! The features of a GeoJSON file as rows: properties are columns, and the geometry comes with
//! them.

use std::borrow::Cow;

use geojson::feature::Id;
use geojson::{
    Feature, FeatureCollection, GeometryValue, JsonObject, JsonValue, LineStringType, Position,
};

use crate::cell::Cell;
use crate::error::shortened;
use crate::globe::Place;
use crate::header::{Header, Named};
use crate::input_file::InputFile;
use crate::row::{Column, Need, Positions, Row};
use crate::source::{GENERAL, other_json, read_whole};
use crate::table::{text, without_mark};
use crate::{Error, Warning, strict_json};

/// Whether a file is GeoJSON, by its name or, where the name does not show it, by its first
/// character.
pub(crate) fn is_geojson(file: &InputFile<'_>) -> Result<bool, Error> {
    match file.extension().as_deref() {
        Some("geojson" | "json") => Ok(true),
        Some("csv" | "parquet") => Ok(false),
        _ => Ok(without_mark(&read_whole(file)?).trim_ascii_start().starts_with(b"{")),
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

/// Calls `each` with every feature of a file. A column named `id` is also the feature's own `id`,
/// if no property has this name. `warnings` has properties that are not read and look like one that
/// is.
pub(crate) fn shapes(
    file: &InputFile<'_>,
    columns: &[Column],
    warnings: &mut Vec<Warning>,
    mut each: impl FnMut(&Shape<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let origin = file.origin();
    let bytes = read_whole(file)?;
    let kind = "a GeoJSON FeatureCollection";
    let wrong = |problem: String| Error::NotParsed { origin: origin.clone(), kind, problem };
    let text = text(&bytes, kind, &origin)?;
    let collection: FeatureCollection =
        strict_json::check(text).and_then(|()| serde_json::from_slice(text)).map_err(|error| {
            match other_json(text).filter(|problem| !is_collection(text) && !is_general(problem)) {
                Some(problem) => wrong(problem.to_owned()),
                None => wrong(shortened(&error.to_string(), 300)),
            }
        })?;
    if let Some(system) = other_system(&collection) {
        return Err(wrong(format!(
            "its positions are in {}: export it in longitude and latitude (WGS 84, EPSG:4326)",
            shortened(&system, 80)
        )));
    }
    let names = property_names(&collection);
    let has_ids = collection.features.iter().any(|feature| feature.id.is_some());
    let wanted: Vec<Column> = columns
        .iter()
        .map(|column| {
            let is_id = has_ids && column.names.contains(&"id");
            Column { need: if is_id { Need::Optional } else { column.need }, ..*column }
        })
        .collect();
    if !collection.features.is_empty() {
        Header { origin: &origin, names: &names, of: Named::Properties }.find(&wanted, warnings)?;
    }
    for (feature, position) in collection.features.iter().zip(1..) {
        let mut values: Vec<Option<Cow<'_, str>>> = Vec::with_capacity(columns.len());
        for column in columns {
            let value = value(feature, column).map_err(|twice| Error::GivenTwice {
                origin: origin.clone(),
                place: format!("feature {position}"),
                what: format!("the property {:?}", shortened(twice, 64)),
                before: "the same feature".to_owned(),
                hint: None,
            })?;
            values.push(value);
        }
        let texts = values.iter().map(|value| value.as_ref().map(|value| value.as_bytes()));
        let cells: Vec<Cell<'_>> =
            texts.map(|text| text.map_or(Cell::Missing, Cell::text)).collect();
        let positions = Positions::Features;
        let row = Row { origin: &origin, positions, position, columns, cells: &cells, wide: &[] };
        let geometry = feature.geometry.as_ref().map(|geometry| &geometry.value);
        each(&Shape { row, geometry })?;
    }
    Ok(())
}

/// Whether the parser's message is better than this one.
fn is_general(problem: &str) -> bool {
    GENERAL.into_iter().any(|general| problem.starts_with(general))
}

/// Whether a text begins as a FeatureCollection does, so that an error is one of its features.
fn is_collection(text: &[u8]) -> bool {
    let begin = String::from_utf8_lossy(&text[..text.len().min(1_024)]);
    begin.contains("FeatureCollection")
}

/// The reference system of a map, if it names one in which positions are not longitude and
/// latitude.
fn other_system(collection: &FeatureCollection) -> Option<String> {
    let system = collection.foreign_members.as_ref()?.get("crs")?;
    let name = match system.get("properties").and_then(|properties| properties.get("name")) {
        Some(JsonValue::String(name)) => name.clone(),
        _ if system.is_null() => return None,
        _ => system.to_string(),
    };
    let plain = name.to_ascii_uppercase().replace("::", ":");
    let degrees = ["CRS84", "EPSG:4326", "WGS84", "WGS 84"];
    (!degrees.iter().any(|known| plain.ends_with(known))).then_some(name)
}

/// The names of the properties of all features, each once.
fn property_names(collection: &FeatureCollection) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let properties = collection.features.iter().filter_map(|feature| feature.properties.as_ref());
    for name in properties.flat_map(JsonObject::keys) {
        if !names.iter().any(|known| known.eq_ignore_ascii_case(name)) {
            names.push(name.clone());
        }
    }
    names
}

/// The value of the first of the column's names that the feature has, or a property that it has
/// twice, once in other case.
fn value<'a>(feature: &'a Feature, column: &Column) -> Result<Option<Cow<'a, str>>, &'a str> {
    for name in column.names {
        let same = |(key, _): &(&String, &JsonValue)| key.eq_ignore_ascii_case(name);
        let mut found = feature.properties.iter().flatten().filter(same);
        let first = found.next();
        if let Some((twice, _)) = found.next() {
            return Err(twice);
        }
        match first {
            None | Some((_, JsonValue::Null)) => {}
            Some((_, JsonValue::String(text))) => return Ok(Some(Cow::Borrowed(text.as_str()))),
            Some((_, other)) => return Ok(Some(Cow::Owned(other.to_string()))),
        }
    }
    let id = feature.id.as_ref().filter(|_| column.names.contains(&"id"));
    Ok(id.map(|id| match id {
        Id::String(text) => Cow::Borrowed(text.as_str()),
        Id::Number(number) => Cow::Owned(number.to_string()),
    }))
}

impl Shape<'_> {
    /// The place of a point. A point that is the only one of a set of points is also a point.
    pub(crate) fn point(&self) -> Result<Place, Error> {
        match self.geometry {
            Some(GeometryValue::Point { coordinates }) => self.place(coordinates),
            Some(GeometryValue::MultiPoint { coordinates }) if coordinates.len() == 1 => {
                self.place(&coordinates[0])
            }
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

    /// The error that a geometry of the right kind has this number of parts.
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

    /// The error that the geometry is not the one that is needed.
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
