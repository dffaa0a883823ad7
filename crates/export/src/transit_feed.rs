//! GTFS Schedule: the flights of a day as a feed of public transport, in a ZIP archive.
//!
//! | file | has |
//! |---|---|
//! | `agency.txt` | the fleet, under the name of the day, with the time zone of the calendar |
//! | `stops.txt` | every vertiport |
//! | `routes.txt` | every ordered pair of vertiports that is flown; `route_type` is 1100, an air service |
//! | `trips.txt` | every flight; `block_id` is the aircraft |
//! | `stop_times.txt` | departure and arrival of every flight |
//! | `transfers.txt` | that passengers leave an aircraft between two trips of its block |
//! | `calendar_dates.txt` | the one date of the day |
//! | `shapes.txt` | the great circle of every route |
//! | `feed_info.txt` | the same name, and the date |
//!
//! The type 1100 is one of the extended route types of Google Transit. Passengers may board at the
//! departure and leave at the arrival; on a flight that repositions an aircraft they may do neither
//! (`pickup_type` and `drop_off_type` are 1). Whether bicycles and wheelchairs are carried is left
//! open. A day has no address on the web, and GTFS wants one: it is `https://example.org/`, which
//! is reserved for examples.
//!
//! The tests read feeds of small days back with the `gtfs-structures` crate. They check that there
//! is a trip for each flight and a stop for each vertiport, that the stops, routes, services,
//! shapes and the agency that are referred to exist, that each trip has two stops in increasing
//! time, that shapes begin and end at these stops, and that the trips of a block are the flights of
//! one aircraft with their times. Other validators were not run.

mod archive;

use std::collections::BTreeSet;

use vertifleet_core::{Degrees, VertiportIx};

use crate::flight_path::route_path;
use crate::flown::Taken;
use crate::safe_ids::safe_ids;
use crate::{Calendar, Error, Flown};
use archive::{Archive, Table};

/// The id of the one agency.
const AGENCY: &str = "vertifleet";

/// The address on the web that agency and publisher are required to have.
const URL: &str = "https://example.org/";

/// The extended route type for air services.
const AIR_SERVICE: &str = "1100";

/// The id of the service of the one date.
const SERVICE: &str = "day";

/// The flights of the day as a GTFS Schedule feed.
///
/// # Errors
/// [`Error::NoDegrees`] (V721) if a vertiport has no latitude and longitude.
pub fn gtfs(flown: &Flown<'_>, calendar: &Calendar) -> Result<Vec<u8>, Error> {
    let feed = Feed {
        flown,
        date: calendar.date().strftime("%Y%m%d").to_string(),
        zone: calendar.zone_name(),
        places: flown.places("GTFS")?,
        stops: safe_ids(flown.day().vertiports.iter().map(|vertiport| vertiport.id.as_str())),
        blocks: safe_ids(flown.day().aircraft.iter().map(|aircraft| aircraft.id.as_str())),
    };
    let mut archive = Archive::new();
    archive.add_uncompressed("agency.txt", feed.agency());
    archive.add("stops.txt", feed.stops());
    archive.add("routes.txt", feed.routes());
    archive.add("trips.txt", feed.trips());
    archive.add("stop_times.txt", feed.stop_times());
    archive.add("transfers.txt", feed.transfers());
    archive.add("calendar_dates.txt", feed.calendar_dates());
    archive.add("shapes.txt", feed.shapes());
    archive.add("feed_info.txt", feed.feed_info());
    Ok(archive.finish())
}

/// The data of which the files of the feed are made.
struct Feed<'a> {
    flown: &'a Flown<'a>,
    /// The date as GTFS writes it.
    date: String,
    zone: &'a str,
    places: Vec<Degrees>,
    /// The id of each vertiport in the feed.
    stops: Vec<String>,
    /// The id of each aircraft in the feed.
    blocks: Vec<String>,
}

impl Feed<'_> {
    fn agency(&self) -> Table {
        let mut table = Table::new([
            "agency_id",
            "agency_name",
            "agency_url",
            "agency_timezone",
            "agency_lang",
        ]);
        table.row([AGENCY, &self.flown.day().name, URL, self.zone, "en"]);
        table
    }

    fn stops(&self) -> Table {
        let mut table = Table::new(["stop_id", "stop_name", "stop_lat", "stop_lon"]);
        for ((vertiport, id), place) in
            self.flown.day().vertiports.iter().zip(&self.stops).zip(&self.places)
        {
            let (latitude, longitude) = (place.latitude.to_string(), place.longitude.to_string());
            table.row([id, &vertiport.id, &latitude, &longitude]);
        }
        table
    }

    fn routes(&self) -> Table {
        let mut table = Table::new([
            "route_id",
            "agency_id",
            "route_short_name",
            "route_long_name",
            "route_type",
        ]);
        for pair in self.pairs() {
            let [from, to] = pair.map(|at| &self.flown.day().vertiports[at.at()].id);
            let (short, long) = (format!("{from}-{to}"), format!("{from} to {to}"));
            table.row([&self.route(pair), AGENCY, &short, &long, AIR_SERVICE]);
        }
        table
    }

    fn trips(&self) -> Table {
        let mut table = Table::new([
            "route_id",
            "service_id",
            "trip_id",
            "trip_headsign",
            "block_id",
            "shape_id",
        ]);
        for (flight, trip) in self.flights() {
            let route = self.route([flight.row.from, flight.row.to]);
            let block = &self.blocks[flight.row.aircraft.at()];
            table.row([&route, SERVICE, &trip, &flight.to.id, block, &route]);
        }
        table
    }

    fn stop_times(&self) -> Table {
        let mut table = Table::new([
            "trip_id",
            "arrival_time",
            "departure_time",
            "stop_id",
            "stop_sequence",
            "pickup_type",
            "drop_off_type",
            "timepoint",
        ]);
        for (flight, trip) in self.flights() {
            let closed = "1";
            let open = if flight.is_reposition() { closed } else { "0" };
            let (departure, arrival) =
                (flight.row.takeoff.to_string(), flight.row.arrival.to_string());
            let from = &self.stops[flight.row.from.at()];
            let to = &self.stops[flight.row.to.at()];
            table.row([&trip, &departure, &departure, from, "1", open, closed, "1"]);
            table.row([&trip, &arrival, &arrival, to, "2", closed, open, "1"]);
        }
        table
    }

    /// Passengers leave an aircraft where it lands. Without these rows, a planner of journeys would
    /// let them stay in their seats from one trip of a block to the next.
    fn transfers(&self) -> Table {
        const MUST_LEAVE: &str = "5";
        let mut table = Table::new([
            "from_stop_id",
            "to_stop_id",
            "from_trip_id",
            "to_trip_id",
            "transfer_type",
        ]);
        let mut latest: Vec<Option<String>> = vec![None; self.blocks.len()];
        for (flight, trip) in self.flights() {
            let stop = &self.stops[flight.row.from.at()];
            let before = latest[flight.row.aircraft.at()].replace(trip.clone());
            if let Some(before) = before {
                table.row([stop, stop, &before, &trip, MUST_LEAVE]);
            }
        }
        table
    }

    fn calendar_dates(&self) -> Table {
        let mut table = Table::new(["service_id", "date", "exception_type"]);
        // 1 adds the date to the service.
        table.row([SERVICE, &self.date, "1"]);
        table
    }

    fn shapes(&self) -> Table {
        let mut table =
            Table::new(["shape_id", "shape_pt_lat", "shape_pt_lon", "shape_pt_sequence"]);
        for pair in self.pairs() {
            let path = route_path(pair.map(|at| self.places[at.at()]));
            for (point, place) in (1_u32..).zip(path) {
                let (latitude, longitude) =
                    (place.latitude.to_string(), within_globe(place.longitude).to_string());
                table.row([&self.route(pair), &latitude, &longitude, &point.to_string()]);
            }
        }
        table
    }

    fn feed_info(&self) -> Table {
        let mut table = Table::new([
            "feed_publisher_name",
            "feed_publisher_url",
            "feed_lang",
            "feed_start_date",
            "feed_end_date",
            "feed_version",
        ]);
        let name = &self.flown.day().name;
        table.row([name, URL, "en", &self.date, &self.date, name]);
        table
    }

    /// The pairs that are flown, in the order of their vertiports.
    fn pairs(&self) -> BTreeSet<[VertiportIx; 2]> {
        self.flown.flights().map(|flight| [flight.row.from, flight.row.to]).collect()
    }

    /// The id of a pair's route. No stop has a dot in its id.
    fn route(&self, [from, to]: [VertiportIx; 2]) -> String {
        format!("{}.{}", self.stops[from.at()], self.stops[to.at()])
    }

    /// The flights with the ids of their trips: the aircraft, and the number of its flight.
    fn flights(&self) -> impl Iterator<Item = (Taken<'_>, String)> {
        let mut flown = vec![0_u32; self.blocks.len()];
        self.flown.flights().map(move |flight| {
            let aircraft = flight.row.aircraft.at();
            flown[aircraft] += 1;
            (flight, format!("{}.{}", self.blocks[aircraft], flown[aircraft]))
        })
    }
}

/// The longitude of the same meridian from -180 to 180 degrees, beyond which GTFS has no
/// longitudes.
fn within_globe(longitude: f64) -> f64 {
    if longitude > 180.0 {
        longitude - 360.0
    } else if longitude < -180.0 {
        longitude + 360.0
    } else {
        longitude
    }
}
