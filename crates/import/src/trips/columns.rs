//! The columns of trip records: how planners name them, and how they are guessed.

use crate::Error;
use crate::header::{Header, Missing, Named};

/// The names of the columns of trip records. A name that is absent is guessed from names that are
/// in use, such as those of the taxi records of New York and Chicago and of bicycles for hire;
/// capitals and small letters are the same, and blanks and underscores too.
///
/// Places are read from the four columns of coordinates if these are there, and else from the two
/// columns of zones. If only columns of zones are named, places are read from these. Where no
/// column of passengers is there, each record is one passenger.
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

/// A value of a record of a trip, whose column a planner may name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "they are the columns of `TripColumns`")]
pub enum TripValue {
    PickupTime,
    PickupLatitude,
    PickupLongitude,
    DropoffLatitude,
    DropoffLongitude,
    PickupZone,
    DropoffZone,
    Passengers,
}

impl TripValue {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::PickupTime,
        Self::PickupLatitude,
        Self::PickupLongitude,
        Self::DropoffLatitude,
        Self::DropoffLongitude,
        Self::PickupZone,
        Self::DropoffZone,
        Self::Passengers,
    ];

    /// Its name, by which a planner asks for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::PickupTime => "pickup_time",
            Self::PickupLatitude => "pickup_latitude",
            Self::PickupLongitude => "pickup_longitude",
            Self::DropoffLatitude => "dropoff_latitude",
            Self::DropoffLongitude => "dropoff_longitude",
            Self::PickupZone => "pickup_zone",
            Self::DropoffZone => "dropoff_zone",
            Self::Passengers => "passengers",
        }
    }

    /// Names of its column that are in use.
    fn usual_names(self) -> &'static [&'static str] {
        match self {
            Self::PickupTime => TIME,
            Self::PickupLatitude => PICKUP_LATITUDE,
            Self::PickupLongitude => PICKUP_LONGITUDE,
            Self::DropoffLatitude => DROPOFF_LATITUDE,
            Self::DropoffLongitude => DROPOFF_LONGITUDE,
            Self::PickupZone => PICKUP_ZONE,
            Self::DropoffZone => DROPOFF_ZONE,
            Self::Passengers => PASSENGERS,
        }
    }
}

impl<'a> TripColumns<'a> {
    /// These columns, with `column` for the one of this value.
    #[must_use]
    pub fn with(mut self, value: TripValue, column: &'a str) -> Self {
        let named = match value {
            TripValue::PickupTime => &mut self.pickup_time,
            TripValue::PickupLatitude => &mut self.pickup_latitude,
            TripValue::PickupLongitude => &mut self.pickup_longitude,
            TripValue::DropoffLatitude => &mut self.dropoff_latitude,
            TripValue::DropoffLongitude => &mut self.dropoff_longitude,
            TripValue::PickupZone => &mut self.pickup_zone,
            TripValue::DropoffZone => &mut self.dropoff_zone,
            TripValue::Passengers => &mut self.passengers,
        };
        *named = Some(column);
        self
    }

    /// The name that the column of a value was given.
    fn named(&self, value: TripValue) -> Option<&'a str> {
        match value {
            TripValue::PickupTime => self.pickup_time,
            TripValue::PickupLatitude => self.pickup_latitude,
            TripValue::PickupLongitude => self.pickup_longitude,
            TripValue::DropoffLatitude => self.dropoff_latitude,
            TripValue::DropoffLongitude => self.dropoff_longitude,
            TripValue::PickupZone => self.pickup_zone,
            TripValue::DropoffZone => self.dropoff_zone,
            TripValue::Passengers => self.passengers,
        }
    }
}

const TIME: &[&str] = &[
    "tpep_pickup_datetime",
    "lpep_pickup_datetime",
    "pickup_datetime",
    "trip_pickup_datetime",
    "pickup_time",
    "started_at",
    "trip_start_timestamp",
];
const PASSENGERS: &[&str] = &["passenger_count", "passengers"];
const PICKUP_LATITUDE: &[&str] =
    &["pickup_latitude", "start_lat", "start_latitude", "pickup_centroid_latitude"];
const PICKUP_LONGITUDE: &[&str] =
    &["pickup_longitude", "start_lon", "start_lng", "start_longitude", "pickup_centroid_longitude"];
const DROPOFF_LATITUDE: &[&str] =
    &["dropoff_latitude", "end_lat", "end_latitude", "dropoff_centroid_latitude"];
const DROPOFF_LONGITUDE: &[&str] =
    &["dropoff_longitude", "end_lon", "end_lng", "end_longitude", "dropoff_centroid_longitude"];
const PICKUP_ZONE: &[&str] =
    &["PULocationID", "pickup_zone", "pickup_location_id", "pickup_community_area"];
const DROPOFF_ZONE: &[&str] =
    &["DOLocationID", "dropoff_zone", "dropoff_location_id", "dropoff_community_area"];

/// Where the values of a record stand among the columns of one file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    pub(super) time: usize,
    pub(super) passengers: Option<usize>,
    /// A column that is not read and may hold the passengers, which no other column does.
    pub(super) overlooked: Option<usize>,
    pub(super) places: Places,
}

/// Where no column of passengers was found, one that may hold them by a word in its name.
fn overlooked(passengers: Option<usize>, found: &[String]) -> Option<usize> {
    const WORDS: [&str; 11] = [
        "passenger",
        "passengers",
        "pax",
        "rider",
        "riders",
        "person",
        "persons",
        "people",
        "occupants",
        "occupancy",
        "travellers",
    ];
    let of_passengers = |name: &String| {
        let mut words = name.split(|c: char| !c.is_alphanumeric());
        words.any(|word| WORDS.iter().any(|known| word.eq_ignore_ascii_case(known)))
    };
    passengers.map_or_else(|| found.iter().position(of_passengers), |_| None)
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
        let header = Header { origin, names: found, of: Named::Columns };
        let finder = Finder::new(columns, header)?;
        let find = |value| finder.find(value);
        let time = find(TripValue::PickupTime)?;
        let passengers = find(TripValue::Passengers)?;
        let coordinates = [
            find(TripValue::PickupLatitude)?,
            find(TripValue::PickupLongitude)?,
            find(TripValue::DropoffLatitude)?,
            find(TripValue::DropoffLongitude)?,
        ];
        let zones = [find(TripValue::PickupZone)?, find(TripValue::DropoffZone)?];
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
                    Some(NAME_THEM),
                ));
            }
        };
        let time = time.ok_or_else(|| {
            let what = "with the time of pick-up, such as pickup_datetime";
            finder.missing(what, "pickup_datetime", Some(NAME_THEM))
        })?;
        Ok(Self { time, passengers, overlooked: overlooked(passengers, found), places })
    }
}

/// The columns of one file, among which names are looked up.
struct Finder<'a> {
    columns: &'a TripColumns<'a>,
    header: Header<'a>,
    /// Those of the file's columns that hold one of the values, which no other value was meant to
    /// be in.
    used: Vec<usize>,
}

impl<'a> Finder<'a> {
    fn new(columns: &'a TripColumns<'_>, header: Header<'a>) -> Result<Self, Error> {
        let mut finder = Self { columns, header, used: Vec::new() };
        finder.used =
            TripValue::ALL.into_iter().filter_map(|value| finder.position(value)).collect();
        finder.used.iter().try_for_each(|&at| header.refuse_twice(at))?;
        Ok(finder)
    }

    /// Where the column of a value stands: the named one, or the first of the usual names that is
    /// there.
    fn position(&self, value: TripValue) -> Option<usize> {
        match self.columns.named(value) {
            Some(name) => self.header.position(name),
            None => value.usual_names().iter().find_map(|name| self.header.position(name)),
        }
    }

    /// Where the column of a value stands, which must be there if it is named.
    fn find(&self, value: TripValue) -> Result<Option<usize>, Error> {
        match (self.position(value), self.columns.named(value)) {
            (None, Some(name)) => Err(self.missing(&format!("{name:?}"), name, None)),
            (at, _) => Ok(at),
        }
    }

    /// The error that a column is missing; `like` is the name to which similar ones are looked for.
    fn missing(&self, what: &str, like: &str, remedy: Option<&str>) -> Error {
        self.header.missing(&Missing { column: what, like: &[like], used: &self.used, remedy })
    }
}

/// The remedy for columns of unknown names.
const NAME_THEM: &str =
    "--trip-columns names what is called otherwise, as pickup_time=began,passengers=riders";
