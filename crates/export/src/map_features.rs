//! GeoJSON: a line for each flight, with the time at every point, and a point for each vertiport.
//!
//! Positions of a line are `[longitude, latitude, altitude, seconds since 1970]`, which is what the
//! trip layer of kepler.gl animates. The altitude is 0, because a day has no altitudes. Flights
//! come before vertiports, because kepler.gl looks at the first feature to see whether there are
//! trips. Longitudes continue past 180 degrees where a flight crosses the date line. Each feature
//! is one line of the file.

use std::collections::HashMap;

use geojson::{Feature, Geometry, JsonObject};
use serde_json::Value;
use vertifleet_core::{Degrees, Vertiport, VertiportIx};

use crate::flight_path::flight_path;
use crate::flown::Taken;
use crate::output_kinds::GEOJSON_FILE;
use crate::{Calendar, Error, Flown};

/// The flights and the vertiports of the day as a GeoJSON `FeatureCollection`. Holds are left out.
///
/// # Errors
/// [`Error::NoDegrees`] (V721) if a vertiport has no latitude and longitude.
pub fn geojson(flown: &Flown<'_>, calendar: &Calendar) -> Result<String, Error> {
    let places = flown.places("GeoJSON")?;
    let traffic = Traffic::of(flown);
    let flights = flown.flights().map(|flight| line(&flight, &places, flown, calendar));
    let vertiports = VertiportIx::all(places.len()).map(|at| {
        let vertiport = &flown.day().vertiports[at.at()];
        point(vertiport, places[at.at()], traffic.at(at))
    });
    let features: Vec<String> =
        flights.chain(vertiports).map(|feature| feature.to_string()).collect();
    Ok(format!("{}\n{}\n]}}\n", GEOJSON_FILE.opening, features.join(",\n")))
}

fn line(flight: &Taken<'_>, places: &[Degrees], flown: &Flown<'_>, calendar: &Calendar) -> Feature {
    let ends = [places[flight.row.from.at()], places[flight.row.to.at()]];
    let path = flight_path(flight, ends, &flown.day().operations);
    let positions = path.iter().map(|point| {
        // Seconds of these centuries are whole numbers far below 2^53, so the conversion is exact.
        let unix_s = calendar.instant(point.time).as_second() as f64;
        [point.place.longitude, point.place.latitude, 0.0, unix_s]
    });
    let time = |time| calendar.local(time).strftime("%Y-%m-%dT%H:%M:%S%:z").to_string();
    feature(
        Geometry::new_line_string(positions),
        [
            ("aircraft", flight.aircraft.id.as_str().into()),
            ("arrival", time(flight.row.arrival).into()),
            ("departure", time(flight.row.takeoff).into()),
            ("from", flight.from.id.as_str().into()),
            ("passengers", flight.row.passengers.into()),
            ("profit_usd", flight.row.profit_usd().into()),
            ("reposition", flight.is_reposition().into()),
            ("revenue_usd", flight.row.revenue_usd.into()),
            ("seats", flight.kind.seats.into()),
            ("to", flight.to.id.as_str().into()),
            ("type", flight.kind.id.as_str().into()),
        ],
    )
}

fn point(vertiport: &Vertiport, place: Degrees, [departures, arrivals]: [u64; 2]) -> Feature {
    feature(
        Geometry::new_point([place.longitude, place.latitude]),
        [
            ("arrivals", arrivals.into()),
            ("chargers", vertiport.chargers.into()),
            ("departures", departures.into()),
            ("id", vertiport.id.as_str().into()),
            ("stands", vertiport.stands.into()),
        ],
    )
}

/// A feature whose properties are given in the order of the alphabet, which is the order in which
/// `serde_json` writes them whether or not it keeps the order of insertion.
fn feature<const N: usize>(geometry: Geometry, properties: [(&str, Value); N]) -> Feature {
    debug_assert!(properties.is_sorted_by_key(|&(name, _)| name), "in the order of the alphabet");
    let properties = properties.into_iter().map(|(name, value)| (name.to_owned(), value));
    Feature {
        geometry: Some(geometry),
        properties: Some(properties.collect::<JsonObject>()),
        ..Feature::default()
    }
}

/// Departures and arrivals of each vertiport that has any.
struct Traffic(HashMap<VertiportIx, [u64; 2]>);

impl Traffic {
    fn of(flown: &Flown<'_>) -> Self {
        let mut counts: HashMap<VertiportIx, [u64; 2]> = HashMap::new();
        for flight in flown.flights() {
            counts.entry(flight.row.from).or_default()[0] += 1;
            counts.entry(flight.row.to).or_default()[1] += 1;
        }
        Self(counts)
    }

    fn at(&self, vertiport: VertiportIx) -> [u64; 2] {
        self.0.get(&vertiport).copied().unwrap_or_default()
    }
}
