//! The columns of trip records: how planners name them, and how they are guessed.

use crate::Error;
use crate::table::missing;

/// The names of the columns of trip records. A name that is absent is guessed from names that are in use, such as those
/// of New York's taxi records; capitals and small letters are the same.
///
/// Places are read from the four columns of coordinates if these are there, and else from the two columns of zones. If
/// only columns of zones are named, places are read from these. Where no column of passengers is there, each record is
/// one passenger.
#[derive(Debug, Clone, Copy, Default)]
pub struct TripColumns<'a> {
    /// When the trip began.
    pub pickup_time: Option<&'a str>,
    /// Where it began, degrees.
    pub pickup_latitude: Option<&'a str>,
    /// Where it began, degrees.
    pub pickup_longitude: Option<&'a str>,
    /// Where it ended, degrees.
    pub dropoff_latitude: Option<&'a str>,
    /// Where it ended, degrees.
    pub dropoff_longitude: Option<&'a str>,
    /// The zone where it began.
    pub pickup_zone: Option<&'a str>,
    /// The zone where it ended.
    pub dropoff_zone: Option<&'a str>,
    /// Number of passengers.
    pub passengers: Option<&'a str>,
}

const TIME: &[&str] = &[
    "tpep_pickup_datetime",
    "lpep_pickup_datetime",
    "pickup_datetime",
    "trip_pickup_datetime",
    "pickup_time",
];
const PASSENGERS: &[&str] = &["passenger_count", "passengers"];
const PICKUP_LATITUDE: &[&str] = &["pickup_latitude", "start_lat", "start_latitude"];
const PICKUP_LONGITUDE: &[&str] =
    &["pickup_longitude", "start_lon", "start_lng", "start_longitude"];
const DROPOFF_LATITUDE: &[&str] = &["dropoff_latitude", "end_lat", "end_latitude"];
const DROPOFF_LONGITUDE: &[&str] = &["dropoff_longitude", "end_lon", "end_lng", "end_longitude"];
const PICKUP_ZONE: &[&str] = &["PULocationID", "pickup_zone", "pickup_location_id"];
const DROPOFF_ZONE: &[&str] = &["DOLocationID", "dropoff_zone", "dropoff_location_id"];

/// Where the values of a record stand among the columns of one file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    pub(super) time: usize,
    pub(super) passengers: Option<usize>,
    pub(super) places: Places,
}

/// The columns of pick-up and drop-off.
#[derive(Debug, Clone, Copy)]
pub(super) enum Places {
    /// Latitude and longitude of pick-up, and then of drop-off.
    Coordinates([usize; 4]),
    /// The zones of pick-up and drop-off.
    Zones([usize; 2]),
}

impl Layout {
    /// Finds the columns of a file.
    pub(super) fn find(
        columns: &TripColumns<'_>,
        found: &[String],
        origin: &str,
    ) -> Result<Self, Error> {
        let finder = Finder { found, origin };
        let time = finder.find(columns.pickup_time, TIME)?;
        let passengers = finder.find(columns.passengers, PASSENGERS)?;
        let coordinates = [
            finder.find(columns.pickup_latitude, PICKUP_LATITUDE)?,
            finder.find(columns.pickup_longitude, PICKUP_LONGITUDE)?,
            finder.find(columns.dropoff_latitude, DROPOFF_LATITUDE)?,
            finder.find(columns.dropoff_longitude, DROPOFF_LONGITUDE)?,
        ];
        let zones = [
            finder.find(columns.pickup_zone, PICKUP_ZONE)?,
            finder.find(columns.dropoff_zone, DROPOFF_ZONE)?,
        ];
        let named_zones = columns.pickup_zone.or(columns.dropoff_zone).is_some();
        let named_coordinates = [
            columns.pickup_latitude,
            columns.pickup_longitude,
            columns.dropoff_latitude,
            columns.dropoff_longitude,
        ];
        let prefer_zones = named_zones && named_coordinates.iter().all(Option::is_none);
        let places = match (coordinates, zones) {
            (_, [Some(from), Some(to)]) if prefer_zones => Places::Zones([from, to]),
            ([Some(a), Some(b), Some(c), Some(d)], _) => Places::Coordinates([a, b, c, d]),
            (_, [Some(from), Some(to)]) => Places::Zones([from, to]),
            _ => {
                let names =
                    [PICKUP_LATITUDE, PICKUP_LONGITUDE, DROPOFF_LATITUDE, DROPOFF_LONGITUDE];
                let absent = coordinates.iter().zip(names).find(|(at, _)| at.is_none());
                let column = absent.map_or("pickup_latitude", |(_, names)| names[0]);
                return Err(finder.missing(
                    &format!("{column} (or {} and {})", PICKUP_ZONE[0], DROPOFF_ZONE[0]),
                    column,
                ));
            }
        };
        let time = time.ok_or_else(|| {
            finder.missing("with the time of pick-up, such as pickup_datetime", "pickup_datetime")
        })?;
        Ok(Self { time, passengers, places })
    }
}

/// The columns of one file, among which names are looked up.
struct Finder<'a> {
    found: &'a [String],
    origin: &'a str,
}

impl Finder<'_> {
    /// The position of the column of this name, which must be there; or of the first of the usual names that is there.
    fn find(&self, name: Option<&str>, usual: &[&str]) -> Result<Option<usize>, Error> {
        let position = |name: &str| {
            self.found.iter().position(|found| found.eq_ignore_ascii_case(name.trim()))
        };
        match name {
            Some(name) => match position(name) {
                Some(at) => Ok(Some(at)),
                None => Err(self.missing(&format!("{name:?}"), name)),
            },
            None => Ok(usual.iter().find_map(|name| position(name))),
        }
    }

    /// An error that says what is missing; `like` is the name to which similar ones are looked for.
    fn missing(&self, what: &str, like: &str) -> Error {
        match missing(like, self.found, self.origin) {
            Error::MissingColumn { origin, found, meant, .. } => {
                Error::MissingColumn { origin, column: what.to_owned(), found, meant }
            }
            other => other,
        }
    }
}
