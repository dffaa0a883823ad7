//! Files as planners really have them: readable parts are read, and the others are refused or named
//! in a warning.

use std::io::Write;
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::GzEncoder;
use vertifleet_core::Coded;
use vertifleet_import::{Demand, Error, Imported, Trips};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::planner::{
    Folder, VERTIPORTS, map, new_york, point, request, run, run_table, run_trips,
};

const TABLE: &str = "period,from,to,passengers\n6,JRB,JFK,1.5\n";
const HEADER: &str = "pickup_datetime,pickup_latitude,pickup_longitude,dropoff_latitude,dropoff_longitude,passengers\n";
/// From lower Manhattan to Kennedy.
const WAY: &str = "40.70112,-74.0088,40.63993,-73.77869";

fn gzipped(text: &str) -> Vec<u8> {
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    packed.write_all(text.as_bytes()).expect("memory");
    packed.finish().expect("memory")
}

fn zipped(files: &[(&str, &str)]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut archive = ZipWriter::new(&mut bytes);
    for (name, text) in files {
        archive.start_file(*name, SimpleFileOptions::default()).expect("memory");
        archive.write_all(text.as_bytes()).expect("memory");
    }
    archive.finish().expect("memory");
    bytes.into_inner()
}

/// Imports a file of demand.
fn demand(folder: &Folder, file: &Path) -> Result<Imported, Error> {
    let (base, vertiports) = (new_york(), folder.path("vertiports.csv"));
    run(&request(&base, &vertiports, Demand::Table(file)))
}

/// Imports a file of vertiports with the demand of [`TABLE`].
fn vertiports(folder: &Folder, file: &Path) -> Result<Imported, Error> {
    let (base, table) = (new_york(), folder.file("demand.csv", TABLE));
    run(&request(&base, file, Demand::Table(&table)))
}

/// Imports records that all count.
fn records<'a>(
    folder: &Folder,
    files: Vec<&'a Path>,
    set: impl FnOnce(&mut Trips<'a>),
) -> Result<Imported, Error> {
    let mut trips = Trips::new(files);
    trips.mode_share = 1.0;
    set(&mut trips);
    run_trips(folder, trips)
}

fn refused(folder: &Folder, result: Result<Imported, Error>) -> String {
    let error = result.expect_err("it is refused");
    format!("{} {}", error.code(), folder.message(&error))
}

fn warned(folder: &Folder, imported: &Imported) -> Vec<String> {
    let folder = format!("{}/", folder.path("x").parent().expect("a folder").display());
    let text = |warning: &vertifleet_import::Warning| format!("{} {warning}", warning.code());
    imported.warnings.iter().map(|warning| text(warning).replace(&folder, "")).collect()
}

fn passengers(imported: &Imported) -> f64 {
    imported.network.mean_demand().iter().flat_map(|table| table.cells().to_vec()).sum()
}

#[test]
fn values_beyond_the_header_are_refused_unless_they_are_empty() {
    let folder = Folder::new();
    let header = "period,from,to,passengers\n";
    assert_eq!(
        refused(&folder, run_table(&folder, &format!("{header}6,JRB,JFK,1\n\n6,JFK,JRB,1,234\n"))),
        "V701 demand.csv: cannot be read as CSV: line 4 has 5 values, and the header has 4 columns: write decimals with a point, \
         and put values with commas in quotes"
    );
    let padded = run_table(&folder, &format!("{header}6,JRB,JFK,1, ,\n")).expect("a network");
    assert_eq!(passengers(&padded), 1.0);
    let file = folder.file(
        "records.csv",
        format!("{HEADER}2015-06-01 07:30,{WAY},2\n2015-06-01 07:30,{WAY},1,5\n2015-06-01 07:30,{WAY},\"2\",,\n"),
    );
    let imported = records(&folder, vec![&file], |_| ()).expect("a network");
    let account = imported.account.as_ref().expect("trips");
    assert_eq!((account.kept, account.too_many_values), (2, 1));
}

#[test]
fn a_name_that_is_read_must_not_occur_twice() {
    let folder = Folder::new();
    let table = "period,from,to,passengers,Passengers\n6,JRB,JFK,1,2\n";
    assert_eq!(
        refused(&folder, run_table(&folder, table)),
        r#"V704 demand.csv: column 5: the name "Passengers" is given before, in column 4"#
    );
    assert!(run_table(&folder, "period,from,to,passengers,x,x\n6,JRB,JFK,1,2,3\n").is_ok());
    let file = folder.file("records.csv", HEADER.replace("passengers", "PICKUP_DATETIME"));
    let twice = refused(&folder, records(&folder, vec![&file], |_| ()));
    assert!(twice.starts_with("V704 records.csv: column 6"), "{twice}");
    let places = map(&[point(r#""id":"JRB","stands":3,"STANDS":4"#, -74.0, 40.7)]);
    let places = folder.file("places.geojson", places);
    assert_eq!(
        refused(&folder, vertiports(&folder, &places)),
        r#"V704 places.geojson: feature 1: the property "stands" is given before, in the same feature"#
    );
    let places = map(&[point(r#""id":"JRB","stands":3,"stands":4"#, -74.0, 40.7)]);
    let twice = refused(&folder, vertiports(&folder, &folder.file("places.geojson", places)));
    assert!(twice.contains(r#"the member "stands" is there twice at line 1"#), "{twice}");
}

#[test]
fn properties_are_read_in_any_case_and_similar_ones_are_named() {
    let folder = Folder::new();
    let places = map(&[
        point(r#""ID":"JRB","Stands":25,"BUSY":1"#, -74.0088, 40.70112),
        point(r#""ID":"JFK","Stands":30"#, -73.77869, 40.63993),
    ]);
    let file = folder.file("places.geojson", &places);
    let imported = vertiports(&folder, &file).expect("a network");
    assert_eq!(imported.network.vertiports()[0].stands, 25);
    assert!(warned(&folder, &imported).is_empty());
    let file = folder.file("places.geojson", places.replace("Stands", "number_of_stands"));
    assert!(refused(&folder, vertiports(&folder, &file)).starts_with("V117"), "4 stands each");
    let file = folder.file("places.csv", VERTIPORTS.replace("chargers", "charger"));
    let imported = vertiports(&folder, &file).expect("a network");
    assert_eq!(
        warned(&folder, &imported),
        ["chargers", "charger_kw"].map(|name| format!(
            r#"V740 places.csv: the column "charger" is not read: rename it to {name} if it means that"#
        ))
    );
    let file =
        folder.file("places.geojson", map(&[point(r#""code":"A","name":"B""#, -74.0, 40.7)]));
    assert_eq!(
        refused(&folder, vertiports(&folder, &file)),
        "V702 places.geojson: has no property id; it has code, name"
    );
}

#[test]
fn a_map_in_another_reference_system_is_refused() {
    let folder = Folder::new();
    let places = map(&[
        point(r#""id":"JRB","stands":30"#, -74.0088, 40.70112),
        point(r#""id":"JFK","stands":30"#, -73.77869, 40.63993),
    ]);
    let with = |name: &str| {
        let system = format!(r#"{{"crs":{{"type":"name","properties":{{"name":"{name}"}}}},"#);
        folder.file("places.geojson", places.replacen('{', &system, 1))
    };
    for degrees in ["urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326", "urn:ogc:def:crs:EPSG::4326"] {
        assert!(vertiports(&folder, &with(degrees)).is_ok(), "{degrees}");
    }
    assert_eq!(
        refused(&folder, vertiports(&folder, &with("urn:ogc:def:crs:EPSG::2263"))),
        "V701 places.geojson: cannot be read as a GeoJSON FeatureCollection: its positions are in urn:ogc:def:crs:EPSG::2263: \
         export it in longitude and latitude (WGS 84, EPSG:4326)"
    );
}

#[test]
fn points_in_sets_of_one_are_points_and_zones_go_by_the_name_of_their_number() {
    let folder = Folder::new();
    let one = |id: &str, at: &str| {
        format!(
            r#"{{"type":"Feature","properties":{{{id}}},"geometry":{{"type":"MultiPoint","coordinates":[{at}]}}}}"#
        )
    };
    let places = map(&[
        one(r#""id":"JRB","stands":30"#, "[-74.0088,40.70112]"),
        one(r#""id":"JFK","stands":30"#, "[-73.77869,40.63993]"),
    ]);
    let places = folder.file("places.geojson", places);
    assert!(vertiports(&folder, &places).is_ok());
    let two = map(&[one(r#""id":"JRB""#, "[-74,40],[-74,41]")]);
    let two = folder.file("places.geojson", two);
    assert!(refused(&folder, vertiports(&folder, &two)).starts_with("V706"));
    for name in ["location_id", "zone_id", "LOCATIONID", "zone"] {
        let zone = |id: u32, at: &str| one(&format!(r#""zone":"Park","{name}":{id}"#), at);
        let zones = map(&[zone(12, "[-74.0088,40.70112]"), zone(132, "[-73.77869,40.63993]")]);
        // A name that is the key itself stands there once.
        let zones = zones.replace(r#""zone":"Park","zone":"#, r#""zone":"#);
        let zones = folder.file("zones.geojson", zones);
        let file = folder.file(
            "records.csv",
            "pickup_datetime,PULocationID,DOLocationID\n2015-06-01 07:30:00,12.0,132\n",
        );
        let imported = records(&folder, vec![&file], |trips| trips.zones = Some(&zones));
        assert_eq!(passengers(&imported.expect(name)), 1.0, "{name}");
    }
}

#[test]
fn text_that_is_not_utf_8_is_refused_with_its_line() {
    let folder = Folder::new();
    let latin = |text: &str| {
        text.chars()
            .map(|c| u8::try_from(c).expect("a letter of western Europe"))
            .collect::<Vec<u8>>()
    };
    let problem =
        "line 3 is not UTF-8 (byte 0xe9), perhaps Windows-1252; save it as UTF-8".to_owned();
    let places = folder
        .file("places.csv", latin("id,latitude,longitude\nA,40,-74\nOrl\u{e9}ans,40.7,-74\n"));
    assert_eq!(
        refused(&folder, vertiports(&folder, &places)),
        format!("V701 places.csv: cannot be read as CSV: {problem}")
    );
    // In the first block, and in a later one.
    for lines in [0, 200_000] {
        let rows = format!("2015-06-01 07:30,{WAY},1\n").repeat(lines);
        let text = format!("{HEADER}{rows}2015-06-01 07:30,{WAY},1\n\u{e9}t\u{e9}\n");
        let file = folder.file("records.csv", latin(&text));
        assert_eq!(
            refused(&folder, records(&folder, vec![&file], |_| ())),
            format!(
                "V701 records.csv: cannot be read as CSV: {}",
                problem.replace('3', &(lines + 3).to_string())
            )
        );
    }
}

#[test]
fn ids_are_equal_however_their_accents_and_numbers_are_written() {
    let folder = Folder::new();
    let places = folder.file(
        "vertiports.csv",
        "id,latitude,longitude,stands\nOrl\u{e9}ans,40.7,-74,30\n7,40.6,-73.8,30\n",
    );
    let table = "period,from,to,passengers\n6,Orle\u{301}ans,7.0,1\n";
    let table = folder.file("demand.csv", table);
    let imported = run(&request(&new_york(), &places, Demand::Table(&table))).expect("a network");
    assert_eq!(passengers(&imported), 1.0);
}

#[test]
fn packed_files_are_read_and_other_kinds_are_refused_by_name() {
    let folder = Folder::new();
    let packed: [(&str, Vec<u8>); 3] = [
        ("demand.csv.gz", gzipped(TABLE)),
        ("demand.zip", zipped(&[("inner/demand.csv", TABLE), ("__MACOSX/._demand.csv", "")])),
        ("demand.csv", zipped(&[("demand.csv", TABLE)])),
    ];
    for (name, bytes) in packed {
        let file = folder.file(name, bytes);
        assert_eq!(passengers(&demand(&folder, &file).expect(name)), 1.5, "{name}");
    }
    let text = format!("{HEADER}{}", format!("2015-06-01 07:30,{WAY},0.5\n").repeat(150_000));
    let packed = [
        folder.file("records.csv.gz", gzipped(&text)),
        folder.file("records.zip", zipped(&[("records.csv", &text)])),
    ];
    for file in &packed {
        let imported = records(&folder, vec![file], |_| ()).expect("a network");
        assert_eq!(passengers(&imported), 75_000.0);
    }
    let others: [(Vec<u8>, &str); 7] = [
        (zipped(&[("[Content_Types].xml", ""), ("xl/workbook.xml", "")]), "an Excel workbook"),
        (zipped(&[("mimetype", ""), ("content.xml", "")]), "an OpenDocument file"),
        (zipped(&[("a.csv", TABLE), ("b.csv", TABLE)]), r#"2 files, such as "a.csv" and "b.csv""#),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1".to_vec(), "an Excel workbook"),
        (b"<!DOCTYPE html><html></html>".to_vec(), "an XML or HTML document"),
        (b"SQLite format 3\0".to_vec(), "a SQLite database"),
        (gzipped(TABLE)[..20].to_vec(), "cannot be read"),
    ];
    for (bytes, words) in others {
        let file = folder.file("demand.csv", bytes);
        let message = refused(&folder, demand(&folder, &file));
        assert!(message.contains(words), "{message}");
        let message = refused(&folder, records(&folder, vec![&file], |_| ()));
        assert!(message.contains(words), "{message}");
    }
}

/// Warnings of an import of records, without those of the network.
fn of_records(rows: &str, set: impl FnOnce(&mut Trips<'_>)) -> Vec<String> {
    let folder = Folder::new();
    let file = folder.file("records.csv", format!("{HEADER}{rows}"));
    let mut trips = Trips::new(vec![&file]);
    trips.mode_share = 1.0;
    set(&mut trips);
    let imported = run_trips(&folder, trips).expect("a network");
    warned(&folder, &imported)
}

#[test]
fn times_with_a_zone_are_converted_to_that_of_the_network_or_warned_of() {
    let folder = Folder::new();
    let rows = format!("2015-06-01T11:30:00Z,{WAY},1\n2015-06-01 07:30:00-04:00,{WAY},2\n");
    let file = folder.file("records.csv", format!("{HEADER}{rows}"));
    let (base, places) = (new_york(), folder.path("vertiports.csv"));
    let mut trips = Trips::new(vec![&file]);
    trips.mode_share = 1.0;
    let mut request = request(&base, &places, Demand::Trips(trips));
    request.time_zone = Some("America/New_York");
    let imported = run(&request).expect("a network");
    assert!(imported.warnings.is_empty());
    let at_seven: f64 = imported.network.mean_demand()[1].cells().iter().sum();
    assert_eq!(at_seven, 3.0);
    let found = of_records(&rows, |_| ());
    assert_eq!(
        found,
        [
            "V741 the trip records: the times of 2 rows have a time zone, and are taken as their clocks show them: --time-zone \
          converts them to that of the network"
        ]
    );
    request.time_zone = Some("UTC-5");
    assert_eq!(
        refused(&folder, run(&request)),
        "V712 time_zone must be a time zone of the IANA database, such as America/New_York or UTC, found UTC-5"
    );
}

#[test]
fn times_that_cannot_be_read_show_the_first_of_them_and_a_format_reads_them() {
    let rows = format!("2015-06-01 07:30,{WAY},1\n,{WAY},1\n01/06/2015 07:30,{WAY},2\nx,{WAY},1\n");
    assert_eq!(
        of_records(&rows, |_| ()),
        [
            "V741 the trip records: the times of 3 of 4 rows cannot be read, the first of them \"01/06/2015 07:30\": read are times \
          as 2015-06-01 07:08:09, also with T in place of the space, without seconds, or with Z, UTC or an offset at its end; \
          --time-format reads other forms, here as --time-format '%d/%m/%Y %H:%M' or '%m/%d/%Y %H:%M' (%m is the month, %d the day)"
        ]
    );
    let folder = Folder::new();
    for (format, time) in [
        ("%d/%m/%Y %H:%M", "01/06/2015 07:30"),
        ("%m/%d/%Y %I:%M:%S %p", "06/01/2015 07:30:00 AM"),
        ("epoch-s", "1433143800"),
        ("epoch-ms", "1433143800000"),
    ] {
        let file = folder.file("records.csv", format!("{HEADER}{time},{WAY},2\n"));
        let imported = records(&folder, vec![&file], |trips| {
            trips.time_format = Some(format.parse().expect("a format"));
        });
        assert_eq!(passengers(&imported.expect(format)), 2.0, "{format}");
    }
}

#[test]
fn stray_dates_days_without_records_and_files_given_twice_are_warned_of() {
    let day = |date: &str, rows: usize| format!("{date} 07:30,{WAY},1\n").repeat(rows);
    let rows =
        format!("{}{}{}", day("2015-06-01", 150), day("2015-06-02", 150), day("2001-01-01", 1));
    assert_eq!(
        of_records(&rows, |_| ()),
        [
            "V741 the trip records: 1 of the 3 days have hardly any records or are far from the others, and each counts as a day in the mean: \
          2001-01-01 (1 of about 150, far from the other dates); --first-date and --last-date leave them out"
        ]
    );
    assert_eq!(
        of_records(&rows, |trips| {
            trips.first_date = "2015-05-30".parse().ok();
            trips.last_date = "2015-06-05".parse().ok();
        }),
        [
            "V741 the trip records: 5 of the 7 days from 2015-05-30 to 2015-06-05 have no records and do not count in the mean; the \
          first of them is 2015-05-30"
        ]
    );
    let folder = Folder::new();
    let names = ["june.csv", "copy.csv", "other.csv"];
    let texts = [day("2015-06-01", 3), day("2015-06-01", 3), day("2015-06-02", 3)];
    let files: Vec<PathBuf> = names
        .iter()
        .zip(texts)
        .map(|(name, rows)| folder.file(name, format!("{HEADER}{rows}")))
        .collect();
    let files = files.iter().map(PathBuf::as_path).collect();
    let imported = records(&folder, files, |_| ()).expect("a network");
    assert_eq!(
        warned(&folder, &imported),
        [
            "V741 the trip records: june.csv and copy.csv hold the same records, which count twice in the demand of each day"
        ]
    );
}

#[test]
fn exchanged_coordinates_metres_and_passengers_that_are_not_read_are_warned_of() {
    let exchanged = "-74.0088,40.70112,-73.77869,40.63993";
    let rows = format!(
        "2015-06-01 07:30,{WAY},1\n{}",
        format!("2015-06-01 07:30,{exchanged},1\n").repeat(2)
    );
    assert_eq!(
        of_records(&rows, |_| ()),
        [
            "V741 the trip records: 2 rows would be near vertiports if their latitudes and longitudes were exchanged, and 1 are as \
          they stand: check the columns of coordinates, here and of the vertiports"
        ]
    );
    let metres = "4965000,583000,4965000,593000";
    let rows = format!("2015-06-01 07:30,{WAY},1\n2015-06-01 07:30,{metres},1\n");
    assert_eq!(
        of_records(&rows, |_| ()),
        [
            "V741 the trip records: the coordinates of 1 rows are no degrees: export them in longitude and latitude (WGS 84), and \
          not in metres of a map"
        ]
    );
    let folder = Folder::new();
    let header = HEADER.replace("passengers", "num_riders");
    let file = folder.file("records.csv", format!("{header}2015-06-01 07:30,{WAY},3\n"));
    let imported = records(&folder, vec![&file], |_| ()).expect("a network");
    assert_eq!(passengers(&imported), 1.0);
    assert_eq!(
        warned(&folder, &imported),
        [
            "V741 records.csv: each record counts as one passenger, and the column \"num_riders\" is not read: --trip-columns \
          passengers=num_riders reads the passengers from it"
        ]
    );
}
