//! GTFS: the feed is read back by another program's reader, and every reference in it leads
//! somewhere.

use std::collections::HashMap;
use std::io::{Cursor, Read};

use gtfs_structures::{ExtendedRouteType, Gtfs, PickupDropOffType, RouteType, StopTime, Trip};
use proptest::prelude::{prop_assert, prop_assert_eq, proptest};
use vertifleet_core::Time;
use vertifleet_export::{GTFS_FILE, gtfs};
use zip::ZipArchive;

use crate::days::{Played, any_played, calendar, tiny};

fn feed(played: &Played) -> Gtfs {
    let bytes = gtfs(&played.flown(), &calendar()).expect("vertiports on the globe");
    Gtfs::from_reader(Cursor::new(bytes)).expect("a feed")
}

fn seconds(time: Option<u32>) -> u32 {
    time.expect("a time")
}

/// The trips of each block, in the order of their departures.
fn blocks(feed: &Gtfs) -> HashMap<&str, Vec<&Trip>> {
    let mut blocks: HashMap<&str, Vec<&Trip>> = HashMap::new();
    for trip in feed.trips.values() {
        blocks.entry(trip.block_id.as_deref().expect("a block")).or_default().push(trip);
    }
    for trips in blocks.values_mut() {
        trips.sort_by_key(|trip| trip.stop_times[0].departure_time);
    }
    blocks
}

#[test]
fn the_feed_of_a_tiny_day_reads_as_it_should() {
    let bytes = gtfs(&tiny().flown(), &calendar()).expect("vertiports on the globe");
    let mut archive = ZipArchive::new(Cursor::new(bytes)).expect("an archive");
    let mut parts = Vec::new();
    for at in 0..archive.len() {
        let mut file = archive.by_index(at).expect("a file");
        let mut text = String::new();
        file.read_to_string(&mut text).expect("text");
        parts.push(format!("--- {}\n{text}", file.name()));
    }
    insta::assert_snapshot!(parts.concat());
}

#[test]
fn a_feed_is_known_by_its_beginning_and_has_no_time_of_writing() {
    let bytes = gtfs(&tiny().flown(), &calendar()).expect("vertiports on the globe");
    assert!(bytes[GTFS_FILE.skipped..].starts_with(GTFS_FILE.opening.as_bytes()));
    let mut archive = ZipArchive::new(Cursor::new(bytes)).expect("an archive");
    for at in 0..archive.len() {
        let file = archive.by_index(at).expect("a file");
        let written = file.last_modified().expect("a time");
        assert_eq!((written.year(), written.month(), written.day()), (1980, 1, 1));
    }
}

#[test]
fn no_passenger_boards_a_flight_that_repositions_its_aircraft() {
    let feed = feed(&tiny());
    let types = |trip: &str| {
        let stops = &feed.trips[trip].stop_times;
        stops.iter().map(|stop| (stop.pickup_type, stop.drop_off_type)).collect::<Vec<_>>()
    };
    let (open, closed) = (PickupDropOffType::Regular, PickupDropOffType::NotAvailable);
    assert_eq!(types("A1.1"), [(open, closed), (closed, open)]);
    assert_eq!(types("A1.2"), [(closed, closed), (closed, closed)]);
}

proptest! {
    #[test]
    fn every_reference_of_a_feed_leads_somewhere(played in any_played()) {
        // The reader itself refuses a feed in which a stop time has an unknown trip or stop.
        let feed = feed(&played);
        prop_assert_eq!(feed.trips.len(), played.flights().count());
        prop_assert_eq!(feed.stops.len(), played.day.vertiports.len());
        let agency = &feed.agencies[0];
        prop_assert_eq!((&*agency.name, &*agency.timezone), (&*played.day.name, "America/New_York"));
        let date = &feed.calendar_dates["day"][0];
        prop_assert_eq!(date.date.to_string(), "2026-11-24");
        for trip in feed.trips.values() {
            let route = &feed.routes[&trip.route_id];
            prop_assert_eq!(route.agency_id.as_ref(), agency.id.as_ref());
            prop_assert_eq!(route.route_type, RouteType::Extended(ExtendedRouteType::Air));
            prop_assert!(feed.calendar_dates.contains_key(&trip.service_id));
            let shape = &feed.shapes[trip.shape_id.as_ref().expect("a shape")];
            let [from, to]: &[StopTime; 2] = trip.stop_times.as_slice().try_into().expect("two stops");
            prop_assert!(seconds(from.departure_time) < seconds(to.arrival_time));
            for (stop, point) in [(from, &shape[0]), (to, &shape[shape.len() - 1])] {
                prop_assert_eq!(stop.stop.latitude, Some(point.latitude));
                prop_assert_eq!(stop.stop.longitude, Some(point.longitude));
            }
        }
    }

    #[test]
    fn the_trips_of_a_block_are_the_flights_of_an_aircraft(played in any_played()) {
        let feed = feed(&played);
        let mut blocks = blocks(&feed);
        let mut flown: HashMap<_, Vec<_>> = HashMap::new();
        for row in played.flights() {
            flown.entry(row.aircraft).or_default().push(row);
        }
        prop_assert_eq!(blocks.len(), flown.len());
        for (aircraft, rows) in flown {
            // Aircraft of these days begin with their position, which safe ids keep.
            let block = blocks.keys().find(|block| block.starts_with(&aircraft.at().to_string()));
            let block = *block.expect("a block of the aircraft");
            let trips = blocks.remove(block).expect("trips");
            prop_assert_eq!(trips.len(), rows.len());
            for (trip, row) in trips.iter().zip(rows) {
                let [from, to] = [&trip.stop_times[0], &trip.stop_times[1]];
                let names = [from, to].map(|stop| stop.stop.name.as_deref().unwrap_or_default());
                // The reader trims names.
                prop_assert_eq!(names[0], played.vertiport(row.from).id.trim());
                prop_assert_eq!(names[1], played.vertiport(row.to).id.trim());
                let times = [from.departure_time, to.arrival_time].map(seconds);
                prop_assert_eq!(times.map(Time::from_seconds), [row.time, row.arrival]);
                let boards = from.pickup_type == PickupDropOffType::Regular;
                prop_assert_eq!(boards, row.passengers > 0);
            }
        }
    }

    #[test]
    fn passengers_leave_an_aircraft_between_the_trips_of_its_block(played in any_played()) {
        let bytes = gtfs(&played.flown(), &calendar()).expect("a feed");
        let mut archive = ZipArchive::new(Cursor::new(&bytes)).expect("an archive");
        let transfers = csv::Reader::from_reader(archive.by_name("transfers.txt").expect("a file"))
            .records()
            .map(|row| row.expect("a row").iter().map(str::to_owned).collect::<Vec<String>>())
            .collect::<Vec<_>>();
        let feed = feed(&played);
        let blocks = blocks(&feed);
        let pairs = || blocks.values().flat_map(|trips| trips.windows(2));
        prop_assert_eq!(transfers.len(), pairs().count());
        for pair in pairs() {
            let stop = &pair[1].stop_times[0].stop.id;
            let row = [stop, stop, &pair[0].id, &pair[1].id, "5"];
            prop_assert!(transfers.iter().any(|transfer| transfer == &row), "{:?}", row);
        }
    }

    #[test]
    fn the_same_day_gives_the_same_feed(played in any_played()) {
        let again = played.clone();
        prop_assert_eq!(
            gtfs(&played.flown(), &calendar()).expect("a feed"),
            gtfs(&again.flown(), &calendar()).expect("a feed")
        );
    }
}
