//! Zones, by which many trip records name the places where a trip began and ended: where the middle
//! of each zone is.

use std::collections::HashMap;
use std::path::Path;

use crate::cell::{Cell, composed};
use crate::features::{self, Shape};
use crate::globe::{Area, Place};
use crate::input_file::InputFile;
use crate::row::{Column, Row, required};
use crate::table;
use crate::trips::nearby::Nearby;
use crate::vertiports::{LATITUDES, LONGITUDES, Vertiports};
use crate::{Error, Warning};

/// Files of New York's taxi zones have a `zone`, which is a name, next to the `LocationID` that
/// trips give, so names of numbers come first.
const ZONE: &[&str] = &["LocationID", "location_id", "zone_id", "zone"];
const COLUMNS: [Column; 3] = [required(ZONE), required(LATITUDES), required(LONGITUDES)];
const PROPERTIES: [Column; 1] = [required(ZONE)];
/// Zones that are nearer to a vertiport than this are of the same region, miles.
const REGION_MI: f64 = 100.0;

/// Zones with the places of their middles. Ids that are whole numbers are compared as numbers,
/// since tables write 132 also as `132.0`.
#[derive(Debug, Default)]
pub(crate) struct Zones {
    by_number: HashMap<i64, usize>,
    by_text: HashMap<Box<[u8]>, usize>,
    pub(crate) middles: Vec<Place>,
}

/// A zone that is being read: a point, or areas that are added up.
struct Draft {
    position: usize,
    point: Option<Place>,
    area: Area,
}

impl Zones {
    /// Reads a CSV table, or a GeoJSON file of areas or points.
    pub(crate) fn read(file: &InputFile<'_>, warnings: &mut Vec<Warning>) -> Result<Self, Error> {
        let mut zones = Self::default();
        let mut drafts: Vec<Draft> = Vec::new();
        if features::is_geojson(file)? {
            features::shapes(file, &PROPERTIES, warnings, |shape| {
                zones.add_shape(shape, &mut drafts)
            })?;
        } else {
            table::rows(file, &COLUMNS, warnings, |row| {
                zones.add_point(row, row.degrees(1, 2, 90.0)?, &mut drafts)
            })?;
        }
        let origin = || file.origin();
        if drafts.is_empty() {
            return Err(Error::Nothing { origin: origin(), what: "zones" });
        }
        for draft in drafts {
            let middle = draft.point.or_else(|| draft.area.middle());
            zones.middles.push(middle.ok_or_else(|| Error::WrongGeometry {
                origin: origin(),
                place: format!("feature {}", draft.position),
                expected: "an area",
                found: "one without a surface".to_owned(),
            })?);
        }
        Ok(zones)
    }

    /// The warning that more zones would be in the region of the vertiports if latitude and
    /// longitude were exchanged than are as they stand.
    pub(crate) fn exchanged(&self, path: &Path, vertiports: &Vertiports) -> Option<Warning> {
        let places = vertiports.list.iter().map(|vertiport| vertiport.place).collect();
        let region = Nearby::new(places, REGION_MI);
        let within = |place: &Place| region.of(*place).is_some();
        let other_way = self.middles.iter().filter_map(|at| Place::new(at.longitude, at.latitude));
        let exchanged = other_way.filter(within).count();
        let near = self.middles.iter().filter(|place| within(place)).count();
        (exchanged > near).then(|| Warning::Trips {
            origin: path.display().to_string(),
            problem: format!(
                "{exchanged} zones would be within {REGION_MI} miles of a vertiport if their latitudes and longitudes were \
                 exchanged, and {near} are as they stand: in GeoJSON the longitude comes first"
            ),
        })
    }

    /// The position of the zone that a cell names.
    #[inline]
    pub(crate) fn find(&self, cell: Cell<'_>) -> Option<usize> {
        match cell.whole() {
            Some(number) => self.by_number.get(&number).copied(),
            None => match cell {
                Cell::Text(text) if text.is_ascii() => self.by_text.get(text).copied(),
                Cell::Text(_) => self.by_text.get(composed(cell.shown()).as_bytes()).copied(),
                _ => None,
            },
        }
    }

    /// Adds an area or a point. Several areas with the same id are parts of one zone, as in the
    /// files of New York's taxi zones.
    fn add_shape(&mut self, shape: &Shape<'_>, drafts: &mut Vec<Draft>) -> Result<(), Error> {
        let Some(rings) = shape.rings()? else {
            let point = shape.point().map_err(|_| shape.wrong("a Polygon, MultiPolygon or Point"));
            return self.add_point(&shape.row, point?, drafts);
        };
        let at = match self.find(shape.row.cells[0]) {
            Some(at) if drafts[at].point.is_none() => at,
            Some(at) => return Err(twice(&shape.row, drafts[at].position)),
            None => self.add(&shape.row, None, drafts)?,
        };
        for ring in &rings {
            drafts[at].area.add_ring(&ring.edge, ring.is_hole);
        }
        Ok(())
    }

    fn add_point(
        &mut self,
        row: &Row<'_>,
        point: Place,
        drafts: &mut Vec<Draft>,
    ) -> Result<(), Error> {
        match self.find(row.cells[0]) {
            Some(at) => Err(twice(row, drafts[at].position)),
            None => self.add(row, Some(point), drafts).map(|_| ()),
        }
    }

    fn add(
        &mut self,
        row: &Row<'_>,
        point: Option<Place>,
        drafts: &mut Vec<Draft>,
    ) -> Result<usize, Error> {
        let text = row.text(0)?;
        let at = drafts.len();
        match row.cells[0].whole() {
            Some(number) => self.by_number.insert(number, at),
            None => self.by_text.insert(text.as_bytes().into(), at),
        };
        drafts.push(Draft { position: row.position, point, area: Area::default() });
        Ok(at)
    }
}

fn twice(row: &Row<'_>, before: usize) -> Error {
    row.given_twice(format!("zone {:?}", row.cells[0].shown()), before)
}
