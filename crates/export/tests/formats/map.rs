//! GeoJSON: one line a flight from vertiport to vertiport in increasing time, and one point a
//! vertiport.

use geojson::{Feature, FeatureCollection, GeometryValue, Position};
use proptest::prelude::{prop_assert, prop_assert_eq, proptest};
use vertifleet_core::VertiportIx;
use vertifleet_export::{GEOJSON_FILE, geojson};

use crate::days::{Played, any_played, calendar, tiny};

/// The features of the day, those of flights and those of vertiports.
fn features(played: &Played) -> (Vec<Feature>, Vec<Feature>) {
    let text = geojson(&played.flown(), &calendar()).expect("vertiports on the globe");
    let collection: FeatureCollection = text.parse().expect("GeoJSON");
    collection.features.into_iter().partition(|feature| feature.contains_property("aircraft"))
}

fn line(flight: &Feature) -> &[Position] {
    match flight.geometry.as_ref().map(|geometry| &geometry.value) {
        Some(GeometryValue::LineString { coordinates }) => coordinates,
        other => panic!("a flight has {other:?}"),
    }
}

fn text<'a>(feature: &'a Feature, property: &str) -> &'a str {
    feature.property(property).and_then(|value| value.as_str()).expect("a text")
}

fn number(feature: &Feature, property: &str) -> f64 {
    feature.property(property).and_then(serde_json::Value::as_f64).expect("a number")
}

#[test]
fn the_map_of_a_tiny_day_reads_as_it_should() {
    let text = geojson(&tiny().flown(), &calendar()).expect("vertiports on the globe");
    assert!(text.starts_with(GEOJSON_FILE.opening));
    insta::assert_snapshot!(text);
}

#[test]
fn an_aircraft_stays_at_its_vertiports_while_it_takes_off_and_lands() {
    let (flights, _) = features(&tiny());
    let line = line(&flights[0]);
    let seconds: Vec<f64> = line.iter().map(|position| position.as_slice()[3]).collect();
    let departure: jiff::Timestamp = "2026-11-25T04:15:00Z".parse().expect("an instant");
    let after: Vec<f64> = seconds.iter().map(|s| s - departure.as_second() as f64).collect();
    // 10 minutes of take-off, 6 minutes of cruise in 5 pieces of about 2 miles, 5 minutes of
    // landing.
    assert_eq!(after, [0.0, 600.0, 672.0, 744.0, 816.0, 888.0, 960.0, 1260.0]);
    assert_eq!(line[0].as_slice()[..2], line[1].as_slice()[..2]);
    assert_eq!(line[6].as_slice()[..2], line[7].as_slice()[..2]);
}

proptest! {
    #[test]
    fn every_flight_is_a_line_between_its_vertiports(played in any_played()) {
        let (flights, _) = features(&played);
        prop_assert_eq!(flights.len(), played.flights().count());
        for (flight, row) in flights.iter().zip(played.flights()) {
            prop_assert_eq!(text(flight, "aircraft"), &played.aircraft(row).id);
            prop_assert_eq!(text(flight, "from"), &played.vertiport(row.from).id);
            prop_assert_eq!(text(flight, "to"), &played.vertiport(row.to).id);
            prop_assert_eq!(number(flight, "revenue_usd"), row.revenue_usd);
            prop_assert_eq!(number(flight, "profit_usd"), row.profit_usd());
            prop_assert_eq!(number(flight, "passengers"), f64::from(row.passengers));
            let reposition = flight.property("reposition").and_then(serde_json::Value::as_bool);
            prop_assert_eq!(reposition, Some(row.passengers == 0));
            let line = line(flight);
            prop_assert!(line.len() >= 2 && line.iter().all(|position| position.len() == 4));
            prop_assert!(line.iter().all(|position| position.as_slice()[2] == 0.0));
            let ends = [(&line[0], row.from), (&line[line.len() - 1], row.to)];
            for (position, vertiport) in ends {
                let degrees = played.vertiport(vertiport).degrees.expect("a place");
                prop_assert!((position.as_slice()[0] - degrees.longitude).abs() < 1e-6);
                prop_assert!((position.as_slice()[1] - degrees.latitude).abs() < 1e-6);
            }
            let seconds: Vec<f64> = line.iter().map(|position| position.as_slice()[3]).collect();
            prop_assert!(seconds.windows(2).all(|pair| pair[0] < pair[1]));
            let flight_s = seconds[seconds.len() - 1] - seconds[0];
            prop_assert_eq!(flight_s, f64::from(row.arrival.since(row.time)));
        }
    }

    #[test]
    fn every_vertiport_is_a_point_that_counts_its_flights(played in any_played()) {
        let (_, vertiports) = features(&played);
        prop_assert_eq!(vertiports.len(), played.day.vertiports.len());
        for (feature, at) in vertiports.iter().zip(VertiportIx::all(vertiports.len())) {
            prop_assert_eq!(text(feature, "id"), &played.vertiport(at).id);
            prop_assert_eq!(number(feature, "stands"), f64::from(played.vertiport(at).stands));
            let departures = played.flights().filter(|row| row.from == at).count();
            let arrivals = played.flights().filter(|row| row.to == at).count();
            prop_assert_eq!(number(feature, "departures"), departures as f64);
            prop_assert_eq!(number(feature, "arrivals"), arrivals as f64);
        }
    }
}
