//! Trip records that are not what they seem: stray dates, exchanged days and months, exchanged
//! axes of zones; and those of Chicago, whose columns have other names.

use std::fmt::Write;

use vertifleet_import::{Imported, Trips};

use crate::planner::{Folder, map, run_trips};

const HEADER: &str =
    "pickup_datetime,pickup_latitude,pickup_longitude,dropoff_latitude,dropoff_longitude\n";
/// From Downtown Manhattan to Kennedy.
const TRIP: &str = "40.7011,-74.0088,40.6399,-73.7787";

fn imported(text: &str, set: impl FnOnce(&mut Trips<'_>)) -> Imported {
    let folder = Folder::new();
    let file = folder.file("trips.csv", text);
    let mut trips = Trips::new(vec![&file]);
    set(&mut trips);
    run_trips(&folder, trips).unwrap_or_else(|error| panic!("{error}"))
}

fn warnings(text: &str, set: impl FnOnce(&mut Trips<'_>)) -> String {
    imported(text, set).warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// Records of June 2026: some a day on each of some days.
fn june(days: u32, a_day: u32) -> String {
    let mut text = HEADER.to_owned();
    for record in 0..days * a_day {
        let (day, hour) = (record / a_day + 1, 7 + record % 12);
        let _ = writeln!(text, "2026-06-{day:02} {hour:02}:30:00,{TRIP}");
    }
    text
}

#[test]
fn stray_dates_bring_a_warning_in_samples_of_any_size() {
    for (a_day, stray) in [
        // Two of 602 records lower the mean from 60 to 50.
        (60, ["2009-01-01 07:30:00", "2041-01-01 07:30:00"]),
        (60, ["2026-06-11 07:30:00", "2026-06-12 07:30:00"]),
        (60, ["2026-02-11 07:30:00", "2026-07-12 07:30:00"]),
        // A third of the usual records.
        (3, ["2026-03-01 07:30:00", "2026-09-12 07:30:00"]),
        // So small that no date has few records.
        (2, ["2009-01-01 07:30:00", "2041-01-01 07:30:00"]),
    ] {
        let records = june(10, a_day);
        assert_eq!(warnings(&records, |_| ()), "");
        let rows = stray.map(|time| format!("{time},{TRIP}\n")).concat();
        let found = warnings(&format!("{records}{rows}"), |_| ());
        for time in stray {
            assert!(found.contains(&time[..10]), "{a_day}: {time} is not named: {found}");
        }
        assert!(found.contains("--first-date and --last-date"), "{found}");
    }
}

#[test]
fn a_few_dates_far_from_the_others_bring_a_warning_whatever_their_records() {
    for a_day in [1, 6, 60] {
        for stray in [1, 2, 6, 60] {
            let mut records = june(10, a_day);
            for record in 0..2 * stray {
                let _ = writeln!(records, "2026-03-{:02} 07:30:00,{TRIP}", 1 + record % 2);
            }
            let found = warnings(&records, |_| ());
            assert!(found.starts_with("the trip records: 2 of the 12 days"), "{stray}: {found}");
            assert!(found.contains("far from the other dates"), "{stray}: {found}");
        }
    }
}

#[test]
fn samples_of_several_months_bring_none() {
    // The first weeks of two months, with a gap between them.
    let first = june(14, 40);
    let second = first.replace("2026-06-", "2026-07-").replacen(HEADER, "", 1);
    assert_eq!(warnings(&format!("{first}{second}"), |_| ()), "");
    // A week of each season.
    let week = june(7, 40).replacen(HEADER, "", 1);
    let seasons = ["03", "06", "09", "12"].map(|month| week.replace("-06-", &format!("-{month}-")));
    assert_eq!(warnings(&format!("{HEADER}{}", seasons.concat()), |_| ()), "");
}

#[test]
fn samples_of_one_weekday_bring_none() {
    // The Mondays of two years, every second one, and those without a month in between.
    let mondays: Vec<i64> = (0..104).collect();
    let second = mondays.iter().copied().step_by(2).collect();
    let gap = mondays.iter().copied().filter(|week| !(50..55).contains(week)).collect();
    for weeks in [mondays, second, gap] {
        let mut text = HEADER.to_owned();
        for week in weeks {
            let monday = jiff::civil::date(2026, 1, 5) + jiff::Span::new().weeks(week);
            for hour in 8..20 {
                let _ = writeln!(text, "{monday} {hour:02}:30:00,{TRIP}");
            }
        }
        assert_eq!(warnings(&text, |_| ()), "");
    }
}

#[test]
fn days_and_months_that_are_exchanged_bring_a_warning() {
    let month_first = |trips: &mut Trips<'_>| trips.time_format = "%m/%d/%Y %H:%M".parse().ok();
    let day_first = |trips: &mut Trips<'_>| trips.time_format = "%d/%m/%Y %H:%M".parse().ok();
    // Days of February: dates that are not read as months are dropped with their own warning.
    for days in [1..=3, 1..=5, 8..=12, 1..=12, 1..=28] {
        let mut text = HEADER.to_owned();
        for day in days {
            let _ = writeln!(text, "{day:02}/02/2026 07:30,{TRIP}");
        }
        let found = warnings(&text, month_first);
        assert!(found.contains("days and months may be exchanged"), "{found}");
        assert_eq!(warnings(&text, day_first), "");
    }
}

#[test]
fn a_day_of_each_month_is_no_exchange() {
    let mut text = HEADER.to_owned();
    for (month, day) in [(1, 5), (2, 2), (3, 2), (4, 6), (5, 4), (6, 1), (7, 6), (8, 3)] {
        let _ = writeln!(text, "2026-{month:02}-{day:02} 07:30:00,{TRIP}");
    }
    assert_eq!(warnings(&text, |_| ()), "");
}

#[test]
fn zones_with_exchanged_axes_bring_a_warning() {
    let zone = |id: u32, x: f64, y: f64| {
        let ring = [(0.0, 0.0), (0.01, 0.0), (0.01, 0.01), (0.0, 0.0)]
            .map(|(east, north)| format!("[{},{}]", x + east, y + north))
            .join(",");
        format!(
            r#"{{"type":"Feature","properties":{{"zone":{id}}},"geometry":{{"type":"Polygon","coordinates":[[{ring}]]}}}}"#
        )
    };
    let folder = Folder::new();
    let file = folder
        .file("trips.csv", "pickup_datetime,PULocationID,DOLocationID\n2026-06-01 07:30:00,1,2\n");
    let message = |zones: String| {
        let zones = folder.file("zones.geojson", zones);
        let mut trips = Trips::new(vec![&file]);
        trips.zones = Some(&zones);
        match run_trips(&folder, trips) {
            Ok(imported) => imported.warnings.iter().map(ToString::to_string).collect::<String>(),
            Err(error) => error.to_string(),
        }
    };
    let right = map(&[zone(1, -74.0088, 40.7011), zone(2, -73.7787, 40.6399)]);
    assert_eq!(message(right), "");
    let found = message(map(&[zone(1, 40.7011, -74.0088), zone(2, 40.6399, -73.7787)]));
    assert!(found.contains("if their latitudes and longitudes were exchanged"), "{found}");
}

#[test]
fn records_of_chicago_are_read_by_the_names_of_their_columns() {
    let names = [
        "Trip ID,Trip Start Timestamp,Trip End Timestamp,Pickup Community Area,Dropoff Community Area,Pickup Centroid Latitude,\
         Pickup Centroid Longitude,Dropoff Centroid Latitude,Dropoff Centroid  Longitude",
        "trip_id,trip_start_timestamp,trip_end_timestamp,pickup_community_area,dropoff_community_area,pickup_centroid_latitude,\
         pickup_centroid_longitude,dropoff_centroid_latitude,dropoff_centroid_longitude",
    ];
    for header in names {
        let row = "a1,06/01/2026 07:30:00 AM,06/01/2026 08:30:00 AM,8,76,40.7011,-74.0088,40.6399,-73.7787";
        let set = |trips: &mut Trips<'_>| trips.time_format = "%m/%d/%Y %I:%M:%S %p".parse().ok();
        let account = imported(&format!("{header}\n{row}\n"), set).account.expect("an account");
        assert_eq!((account.rows, account.kept), (1, 1), "{header}");
        // The portal's interface writes its own form.
        let row = row.replace("06/01/2026 07:30:00 AM", "2026-06-01T07:30:00.000");
        let account = imported(&format!("{header}\n{row}\n"), |_| ()).account.expect("an account");
        assert_eq!((account.rows, account.kept), (1, 1), "{header}");
    }
}

#[test]
fn the_format_of_times_in_a_common_form_is_proposed() {
    for (time, format) in [
        ("06/01/2026 07:30:00 AM", "%m/%d/%Y %I:%M:%S %p"),
        ("28/02/2026 07:30", "%d/%m/%Y %H:%M"),
        ("02/28/2026 07:30", "%m/%d/%Y %H:%M"),
        ("28.02.2026 07:30", "%d.%m.%Y %H:%M"),
    ] {
        let text = format!("{HEADER}2026-06-01 07:30:00,{TRIP}\n{time},{TRIP}\n");
        let found = warnings(&text, |_| ());
        assert!(found.contains(&format!("--time-format '{format}'")), "{time}: {found}");
    }
}
