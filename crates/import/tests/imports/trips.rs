//! Demand from trip records: the same from both kinds of file and on any number of threads, and the
//! same as a simple computation of it.

use std::collections::{BTreeSet, HashMap};
use std::fs::File;
use std::sync::Mutex;

use crate::made::{self, Random, Trip};
use crate::planner::{self, Folder, map, point, run_trips};
use vertifleet_core::{Stop, VertiportIx};
use vertifleet_import::{
    Demand, Error, Imported, TripAccount, TripColumns, Trips, Weekday, Weekdays, import,
};

/// The places of [`planner::VERTIPORTS`].
const PLACES: [(f64, f64); 3] =
    [(40.701_12, -74.008_80), (40.639_93, -73.778_69), (40.692_48, -74.168_69)];

fn made_trips(count: u64) -> impl Iterator<Item = Trip> {
    made::trips(&PLACES, count, 7)
}

/// Writes the same trips in both forms.
fn both_forms(folder: &Folder, count: u64) -> (std::path::PathBuf, std::path::PathBuf) {
    let (csv, parquet) = (folder.path("trips.csv"), folder.path("trips.parquet"));
    made::write_csv(File::create(&csv).expect("a file"), made_trips(count)).expect("written");
    made::write_parquet(File::create(&parquet).expect("a file"), made_trips(count), 7_000)
        .expect("written");
    (csv, parquet)
}

fn account(imported: &Imported) -> &TripAccount {
    imported.account.as_ref().expect("trips have an account")
}

/// The haversine formula.
fn miles(from: (f64, f64), to: (f64, f64)) -> f64 {
    let half = |a: f64, b: f64| ((b - a).to_radians() / 2.0).sin().powi(2);
    let h = half(from.0, to.0)
        + from.0.to_radians().cos() * to.0.to_radians().cos() * half(from.1, to.1);
    2.0 * 3_958.761_3 * h.sqrt().asin()
}

/// The nearest vertiport within a radius.
fn near(place: (i64, i64), radius_mi: f64) -> Option<(usize, f64)> {
    let place = (place.0 as f64 / 1e6, place.1 as f64 / 1e6);
    let distances = PLACES.iter().map(|&other| miles(place, other)).enumerate();
    distances.filter(|(_, distance)| *distance <= radius_mi).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Passengers of a day by hour and pair, by the book.
fn simply(
    trips: &[Trip],
    radius_mi: f64,
    share: f64,
    decay_mi: f64,
) -> HashMap<(u64, usize, usize), f64> {
    let mut sums: HashMap<(u64, usize, usize), f64> = HashMap::new();
    let mut days = BTreeSet::new();
    for trip in trips.iter().filter(|trip| trip.passengers > 0) {
        // 1970-01-01 was a Thursday; days from Monday to Friday count.
        let day = trip.pickup_s / 86_400;
        if (day + 3) % 7 >= 5 {
            continue;
        }
        days.insert(day);
        let hour = trip.pickup_s % 86_400 / 3600;
        if !(6..22).contains(&hour) {
            continue;
        }
        let (Some(from), Some(to)) = (near(trip.pickup, radius_mi), near(trip.dropoff, radius_mi))
        else {
            continue;
        };
        if from.0 != to.0 {
            let weight = f64::from(trip.passengers) * share * (-(from.1 + to.1) / decay_mi).exp();
            *sums.entry((hour, from.0, to.0)).or_default() += weight;
        }
    }
    sums.into_iter().map(|(cell, sum)| (cell, sum / days.len() as f64)).collect()
}

#[test]
fn demand_is_what_a_simple_computation_gives() {
    let folder = Folder::new();
    let (csv, _) = both_forms(&folder, 30_000);
    let mut trips = Trips::new(vec![&csv]);
    (trips.radius_mi, trips.mode_share, trips.decay_mi) = (1.5, 0.3, Some(0.8));
    trips.weekdays = Weekday::ALL[..5].iter().copied().collect();
    let imported = run_trips(&folder, trips).expect("a network");
    let all: Vec<Trip> = made_trips(30_000).collect();
    let expected = simply(&all, 1.5, 0.3, 0.8);
    assert!(expected.len() > 80, "{}", expected.len());
    let means = imported.network.mean_demand();
    assert_eq!(means.len(), 16);
    for (period, hour) in (6..22).enumerate() {
        for (from, to) in (0..3).flat_map(|from| (0..3).map(move |to| (from, to))) {
            let mean = means[period][(VertiportIx::new(from), VertiportIx::new(to))];
            let simple = expected.get(&(hour, from, to)).copied().unwrap_or(0.0);
            assert!((mean - simple).abs() < 1e-6, "{hour} {from} {to}: {mean} {simple}");
        }
    }
    let account = account(&imported);
    let sum: f64 = expected.values().sum();
    assert!((account.passengers_a_day - sum).abs() < 1e-3);
    assert_eq!((account.rows, account.days), (30_000, 22));
    let dropped: u64 = account.dropped().iter().map(|(_, rows)| rows).sum();
    assert_eq!(account.rows, account.kept + dropped);
    assert_eq!(
        account.no_passengers,
        all.iter().filter(|trip| trip.passengers == 0).count() as u64
    );
}

#[test]
fn both_kinds_of_file_give_the_same_network_on_any_number_of_threads() {
    let folder = Folder::new();
    // More than one block of 4 MiB, and several row groups.
    let (csv, parquet) = both_forms(&folder, 90_000);
    assert!(std::fs::metadata(&csv).expect("written").len() > 8 << 20);
    let network = |file: &std::path::Path, threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let mut trips = Trips::new(vec![file]);
        (trips.radius_mi, trips.decay_mi) = (1.5, Some(0.8));
        let imported = pool.install(|| run_trips(&folder, trips)).expect("a network");
        let account = account(&imported).clone();
        let text = imported.toml.replace("trips.csv", "TRIPS").replace("trips.parquet", "TRIPS");
        let rows = account.first_dropped.clone();
        (text, TripAccount { files: Vec::new(), first_dropped: Vec::new(), ..account }, rows)
    };
    let (once, groups) = (network(&csv, 1), network(&parquet, 1));
    assert!(once.1.kept > 1000 && once.2.len() == 5, "{:?}", once.2);
    assert_eq!((&once.0, &once.1), (&groups.0, &groups.1));
    assert_eq!(once, network(&csv, 4));
    assert_eq!(groups, network(&parquet, 4));
}

#[test]
fn files_in_any_order_and_of_both_kinds_add_up() {
    let folder = Folder::new();
    let (csv, parquet) = both_forms(&folder, 2_000);
    let both = |files| run_trips(&folder, Trips::new(files)).expect("a network");
    let (one, two) = (both(vec![&csv]), both(vec![&parquet, &csv]));
    assert_eq!(account(&two).rows, 2 * account(&one).rows);
    assert_eq!(account(&two).days, account(&one).days);
    let expected = 2.0 * account(&one).passengers_a_day;
    assert!((account(&two).passengers_a_day - expected).abs() < 1e-3);
    assert_eq!(both(vec![&csv, &parquet]).network.mean_demand(), two.network.mean_demand());
}

/// Records of one kind each, from JRB to JFK at 7:30 unless stated otherwise.
#[test]
fn every_record_is_kept_or_counted_with_the_first_reason() {
    let folder = Folder::new();
    let rows = "\
pickup_datetime,pickup_latitude,pickup_longitude,dropoff_latitude,dropoff_longitude,passengers
2015-06-01 07:30:00,40.70112,-74.0088,40.63993,-73.77869,2
2015-06-01T07:30,40.70112,-74.0088,40.63993,-73.77869,\"4\"
2015-06-02 07:30:00,40.70112,-74.0088,40.63993,-73.77869,
,40.70112,-74.0088,40.63993,-73.77869,2
2015-06-01 25:30:00,40.70112,-74.0088,40.63993,-73.77869,2
2015-06-01 07:30:00,,-74.0088,40.63993,-73.77869,2
2015-06-01 07:30:00,40.70112,-74.0088,40.63993
2015-06-01 07:30:00,95,-74.0088,40.63993,-73.77869,2
2015-06-01 07:30:00,40.70112,-74.0088,40.63993,-73.77869,0
2015-06-01 07:30:00,40.70112,-74.0088,40.63993,-73.77869,many
2015-06-01 05:59:59,40.70112,-74.0088,40.63993,-73.77869,2
2015-06-01 22:00:00,40.70112,-74.0088,40.63993,-73.77869,2
2015-06-01 07:30:00,0,0,40.63993,-73.77869,2
2015-06-01 07:30:00,40.70112,-74.0088,0,0,2
2015-06-01 07:30:00,40.70112,-74.0088,40.70113,-74.0088,2
2015-06-06 07:30:00,40.70112,-74.0088,40.63993,-73.77869,2
2003-01-01 07:30:00,40.70112,-74.0088,40.63993,-73.77869,2

";
    let file = folder.file("records.csv", rows);
    let mut trips = Trips::new(vec![&file]);
    trips.mode_share = 0.5;
    trips.weekdays = Weekdays::from_iter([Weekday::Monday, Weekday::Tuesday]);
    trips.first_date = Some("2015-06-01".parse().expect("a date"));
    trips.last_date = Some("2015-06-30".parse().expect("a date"));
    let imported = run_trips(&folder, trips).expect("a network");
    let found = account(&imported);
    let expected = TripAccount {
        files: vec!["records.csv".to_owned()],
        rows: 17,
        kept: 2,
        too_many_values: 0,
        no_time: 2,
        no_place: 3,
        no_passengers: 3,
        other_date: 1,
        other_weekday: 1,
        outside_operations: 2,
        far_pickup: 1,
        far_dropoff: 1,
        same_vertiport: 1,
        days: 1,
        first_date: Some("2015-06-01".parse().expect("a date")),
        last_date: Some("2015-06-01".parse().expect("a date")),
        passengers_a_day: 3.0,
        first_dropped: found.first_dropped.clone(),
    };
    assert_eq!(*found, expected);
    insta::assert_snapshot!("dropped_rows", found.dropped_rows());
    let json = serde_json::to_value(found).expect("JSON");
    assert_eq!((&json["other_weekday"], &json["first_date"]), (&1.into(), &"2015-06-01".into()));
    insta::assert_snapshot!(
        "demand_section",
        imported.toml.split_once("# Demand").expect("a section").1
    );
}

#[test]
fn trips_after_midnight_belong_to_the_day_before_where_operations_go_on() {
    let folder = Folder::new();
    let base = planner::new_york().toml().replace("end = \"22:00:00\"", "end = \"25:30:00\"");
    let base = vertifleet_core::Network::from_toml(&base, "late").expect("a network");
    let place = "40.70112,-74.0088,40.63993,-73.77869";
    let columns =
        "pickup_datetime,pickup_latitude,pickup_longitude,dropoff_latitude,dropoff_longitude";
    // A Friday, its night, and the Saturday; 1:30 is when operations end.
    let rows = [
        "2015-06-05 07:30:00",
        "2015-06-06 01:29:59",
        "2015-06-06 01:30:00",
        "2015-06-06 08:00:00",
    ];
    let rows = rows.map(|time| format!("{time},{place}\n")).concat();
    let file = folder.file("night.csv", format!("{columns}\n{rows}"));
    let mut trips = Trips::new(vec![&file]);
    trips.weekdays = Weekdays::from_iter([Weekday::Friday]);
    trips.mode_share = 1.0;
    let vertiports = folder.path("vertiports.csv");
    let imported = planner::run(&planner::request(&base, &vertiports, Demand::Trips(trips)))
        .expect("a network");
    let account = account(&imported);
    assert_eq!((account.kept, account.other_weekday, account.days), (2, 2, 1));
    let starts: Vec<String> =
        imported.network.period_starts().iter().map(ToString::to_string).collect();
    assert_eq!(starts.last().map(String::as_str), Some("25:00:00"));
    let last = &imported.network.mean_demand()[19];
    assert_eq!(last[(VertiportIx::new(0), VertiportIx::new(1))], 1.0);
}

#[test]
fn zones_are_found_by_number_or_name_at_their_middles() {
    let folder = Folder::new();
    let square = |west: f64, south: f64| {
        let (east, north) = (west + 0.01, south + 0.01);
        format!(
            "[[{west},{south}],[{east},{south}],[{east},{north}],[{west},{north}],[{west},{south}]]"
        )
    };
    let area = |zone: &str, rings: String| {
        format!(
            r#"{{"type":"Feature","properties":{{{zone}}},"geometry":{{"type":"Polygon","coordinates":[{rings}]}}}}"#
        )
    };
    // The first zone has two parts, whose middle together is JRB, and a name next to its number, as
    // in New York.
    let zones = folder.file(
        "zones.geojson",
        map(&[
            area(r#""LocationID":12,"zone":"Battery Park""#, square(-74.0238, 40.696_12)),
            area(r#""LocationID":"12","zone":"Battery Park""#, square(-74.0038, 40.696_12)),
            point(r#""zone":"Kennedy Airport""#, -73.778_69, 40.639_93),
        ]),
    );
    let rows = "tpep_pickup_datetime,PULocationID,DOLocationID\n2015-06-01 07:30:00,12.0,Kennedy Airport\n2015-06-01 07:30:00,12,\"Kennedy Airport\"\n2015-06-01 07:30:00,13,12\n";
    let file = folder.file("trips.csv", rows);
    let mut trips = Trips::new(vec![&file]);
    (trips.zones, trips.mode_share, trips.radius_mi) = (Some(zones.as_path()), 1.0, 0.01);
    let imported = run_trips(&folder, trips).expect("a network");
    let account = account(&imported);
    assert_eq!((account.kept, account.no_place, account.passengers_a_day), (2, 1, 2.0));

    let table = folder.file(
        "zones.csv",
        "zone,latitude,longitude\n12,40.70112,-74.0088\nKennedy Airport,40.63993,-73.77869\n",
    );
    let mut trips = Trips::new(vec![&file]);
    (trips.zones, trips.mode_share, trips.radius_mi) = (Some(table.as_path()), 1.0, 0.01);
    assert_eq!(
        run_trips(&folder, trips).expect("a network").network.mean_demand(),
        imported.network.mean_demand()
    );
}

#[test]
fn columns_can_be_named() {
    let folder = Folder::new();
    let file = folder.file("trips.csv", "when,a,b,c,d,who,pickup_datetime\n2015-06-01 07:30:00,40.70112,-74.0088,40.63993,-73.77869,3,\n");
    let mut trips = Trips::new(vec![&file]);
    trips.mode_share = 1.0;
    trips.columns = TripColumns {
        pickup_time: Some("when"),
        pickup_latitude: Some("a"),
        pickup_longitude: Some("b"),
        dropoff_latitude: Some("c"),
        dropoff_longitude: Some("d"),
        passengers: Some("WHO"),
        ..TripColumns::default()
    };
    let imported = run_trips(&folder, trips).expect("a network");
    assert_eq!(account(&imported).passengers_a_day, 3.0);
}

#[test]
fn progress_rises_to_one_and_a_request_to_stop_ends_the_import() {
    let folder = Folder::new();
    let (csv, parquet) = both_forms(&folder, 80_000);
    let (base, vertiports) = (planner::new_york(), folder.path("vertiports.csv"));
    let trips = Trips::new(vec![&csv, &parquet]);
    let request = planner::request(&base, &vertiports, Demand::Trips(trips));
    let shares = Mutex::new(Vec::new());
    import(&request, &Stop::default(), &|share| shares.lock().expect("no panic").push(share))
        .expect("a network");
    let shares = shares.into_inner().expect("no panic");
    assert!(
        shares.len() > 4 && shares.iter().all(|share| (0.0..=1.0).contains(share)),
        "{shares:?}"
    );
    assert_eq!(shares.last(), Some(&1.0));

    for files in [vec![csv.as_path()], vec![parquet.as_path()]] {
        let request = planner::request(&base, &vertiports, Demand::Trips(Trips::new(files)));
        let stop = Stop::default();
        let stopped = import(&request, &stop, &|_| {
            stop.request();
        });
        assert!(matches!(stopped, Err(Error::Stopped)));
    }
}

#[test]
fn malformed_rows_spoil_no_others() {
    let folder = Folder::new();
    let mut random = Random(3);
    let mut text = Vec::new();
    made::write_csv(&mut text, made_trips(3_000)).expect("written");
    let text = String::from_utf8(text).expect("plain");
    let mut odd = String::new();
    for (at, line) in text.lines().enumerate() {
        odd += line;
        odd.push('\n');
        if at > 0 && random.below(10) == 0 {
            odd += ["\"never closed, 1, 2\n", "\n", "1,2\n", "\u{fffd}\u{0},,,,\n"]
                [usize::try_from(random.below(4)).expect("small")];
        }
    }
    let (plain, odd) = (folder.file("plain.csv", text), folder.file("odd.csv", odd));
    let imported = |file| run_trips(&folder, Trips::new(vec![file])).expect("a network");
    let (plain, odd) = (imported(plain.as_path()), imported(odd.as_path()));
    assert_eq!(plain.network.mean_demand(), odd.network.mean_demand());
    assert!(account(&odd).no_time > 100);
}
