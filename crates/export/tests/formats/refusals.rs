//! Each error of an export, by the trace, the day or the calendar that causes it.

use vertifleet_core::{AircraftIx, Coded, Scenario, Time, VertiportIx};
use vertifleet_export::{Calendar, Error, Flown, csv, geojson, gtfs, icalendar, parquet};
use vertifleet_sim::TraceRow;

use crate::days::{calendar, tiny};

/// The code and the message of an error.
fn message(error: &Error) -> String {
    format!("{}: {error}", error.code())
}

/// The error of the tiny day after a change of its second row.
fn refused(change: impl FnOnce(&mut TraceRow)) -> String {
    let mut played = tiny();
    change(&mut played.rows[1]);
    message(&Flown::new(&played.day, &played.rows).expect_err("a wrong row"))
}

#[test]
fn maps_and_feeds_need_latitude_and_longitude_and_the_other_formats_do_not() {
    let mut played = tiny();
    let mut day = played.day.into_day();
    day.vertiports[1].degrees = None;
    played.day = day.check("a day in miles").expect("a day within the rules");
    let (flown, calendar) = (played.flown(), calendar());
    for (format, error) in [
        ("GeoJSON", geojson(&flown, &calendar).expect_err("no degrees")),
        ("GTFS", gtfs(&flown, &calendar).expect_err("no degrees")),
    ] {
        let expected = format!(
            "V721: day \"tiny\": vertiport \"Zürich\" must have latitude and longitude for {format}, found a position in miles only"
        );
        assert_eq!(message(&error), expected);
        assert!(error.hint().is_some());
    }
    assert!(csv(&flown, None).ends_with(b",40.7033,-74.017\n"));
    assert!(parquet(&flown, None).starts_with(b"PAR1"));
    assert!(!icalendar(&flown, &calendar)[1].text.contains("GEO:"));
}

#[test]
fn a_date_and_a_zone_have_to_exist() {
    let date = Calendar::new("2026-02-30", "UTC").expect_err("no date");
    assert_eq!(
        message(&date),
        "V722: date must be a date from 1970-01-01 to 2199-12-31, written as YYYY-MM-DD, found \"2026-02-30\""
    );
    let zone = Calendar::new("2026-11-24", "America/Gotham").expect_err("no zone");
    assert_eq!(
        message(&zone),
        "V723: time zone must be a name of the IANA time zone database, found \"America/Gotham\""
    );
}

#[test]
fn a_row_of_another_day_is_refused() {
    assert_eq!(
        refused(|row| row.to = VertiportIx::new(2)),
        "V724: day \"tiny\": row 2: to is entry 3 of the vertiports, found 2 of them"
    );
    assert!(refused(|row| row.from = VertiportIx::new(9)).starts_with("V724"));
    assert!(refused(|row| row.aircraft = AircraftIx::new(1)).starts_with("V724"));
}

#[test]
fn a_row_that_no_played_day_has_is_refused() {
    assert_eq!(
        refused(|row| row.arrival = Time::from_seconds(0)),
        "V725: day \"tiny\": row 2: arrival must be 23:46:00 or later, found 00:00:00"
    );
    assert!(refused(|row| row.ready = Time::from_seconds(60)).starts_with("V725"));
    assert_eq!(
        refused(|row| row.ready = Time::from_seconds(u32::MAX)),
        "V725: day \"tiny\": row 2: ready must be before 10000:00:00, found 1193046:28:15"
    );
    assert_eq!(
        refused(|row| row.revenue_usd = f64::NAN),
        "V725: day \"tiny\": row 2: revenue must be finite, found NaN"
    );
    let infinite = refused(|row| {
        row.passenger_cost_usd = f64::MAX;
        row.energy_cost_usd = f64::MAX;
    });
    assert_eq!(infinite, "V725: day \"tiny\": row 2: profit must be finite, found -inf");
}

#[test]
fn the_latest_rows_and_a_day_without_rows_are_exported() {
    let mut played = tiny();
    for row in &mut played.rows {
        row.arrival = Time::from_seconds(36_000_000 - 1);
        row.ready = row.arrival;
    }
    let days: [(&Scenario, &[TraceRow]); 2] = [(&played.day, &played.rows), (&played.day, &[])];
    let calendar = Calendar::new("2199-12-31", "Pacific/Kiritimati").expect("a calendar");
    for (day, rows) in days {
        let flown = Flown::new(day, rows).expect("rows of the day");
        assert!(!csv(&flown, Some(&calendar)).is_empty());
        assert!(!parquet(&flown, Some(&calendar)).is_empty());
        assert!(geojson(&flown, &calendar).is_ok());
        assert!(gtfs(&flown, &calendar).is_ok());
        assert_eq!(icalendar(&flown, &calendar).len(), 2);
    }
}
