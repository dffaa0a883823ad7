//! Every error of an import, provoked: the messages name file, place, member and rule.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use crate::planner::{
    Folder, VERTIPORTS, line, map, new_york, point, request, run, run_table, run_trips,
};
use parquet::data_type::Int64Type;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use vertifleet_core::{Coded, Network, Stop};
use vertifleet_import::{Demand, Error, Imported, TripColumns, Trips, Weekdays, import};

const TABLE: &str = "from,to,period,passengers\nJRB,JFK,7,14\n";
const RECORDS: &str =
    "pickup_datetime,pickup_latitude,pickup_longitude,dropoff_latitude,dropoff_longitude\n";

/// Collects messages, one for each error that was provoked.
struct Errors {
    folder: Folder,
    text: String,
    codes: BTreeSet<u16>,
}

impl Errors {
    fn add(&mut self, result: Result<Imported, Error>) {
        let error = result.expect_err("this is an error");
        self.codes.insert(error.code().0);
        let _ = writeln!(self.text, "{} {}", error.code(), self.folder.message(&error));
        if let Some(hint) = error.hint() {
            let _ = writeln!(self.text, "     hint: {hint}");
        }
    }

    fn vertiports(&mut self, name: &str, text: impl AsRef<[u8]>) {
        let (base, places) = (new_york(), self.folder.file(name, text));
        let demand = self.folder.file("demand.csv", TABLE);
        self.add(run(&request(&base, &places, Demand::Table(&demand))));
    }

    fn table(&mut self, text: &str) {
        let result = run_table(&self.folder, text);
        self.add(result);
    }

    fn records(&mut self, text: impl AsRef<[u8]>) {
        let file = self.folder.file("records.csv", text);
        let result = run_trips(&self.folder, Trips::new(vec![&file]));
        self.add(result);
    }

    fn setting<'a>(&mut self, file: &'a Path, set: impl FnOnce(&mut Trips<'a>)) {
        let mut trips = Trips::new(vec![file]);
        set(&mut trips);
        let result = run_trips(&self.folder, trips);
        self.add(result);
    }

    fn zones(&mut self, name: &str, text: &str) {
        let zones = self.folder.file(name, text);
        let file = self.folder.file("header.csv", RECORDS);
        self.setting(&file, |trips| trips.zones = Some(&zones));
    }

    /// A request with one more file.
    fn with(&mut self, name: &str, text: &str) {
        let (base, places) = (new_york(), self.folder.path("vertiports.csv"));
        self.folder.file("vertiports.csv", VERTIPORTS);
        let demand = self.folder.file("demand.csv", TABLE);
        let file = self.folder.file(name, text);
        let mut request = request(&base, &places, Demand::Table(&demand));
        let place: &mut Option<&Path> = match name {
            "corridors.geojson" => &mut request.corridors,
            "fares.csv" => &mut request.tariffs,
            _ => &mut request.energy_prices,
        };
        *place = Some(&file);
        self.add(run(&request));
    }
}

/// A Parquet file whose times are plain numbers.
fn parquet_of_numbers() -> Vec<u8> {
    let schema = "message trips { required int64 pickup_datetime; required int64 PULocationID; required int64 DOLocationID; }";
    let schema = Arc::new(parse_message_type(schema).expect("a schema"));
    let properties = Arc::new(WriterProperties::builder().build());
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, properties).expect("a file");
    let mut group = writer.next_row_group().expect("a group");
    while let Some(mut column) = group.next_column().expect("a column") {
        column.typed::<Int64Type>().write_batch(&[1, 2], None, None).expect("written");
        column.close().expect("written");
    }
    group.close().expect("written");
    writer.close().expect("written");
    bytes
}

/// A text as some spreadsheets save it.
fn utf_16(text: &str) -> Vec<u8> {
    [0xfeff].into_iter().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect()
}

#[test]
fn every_error_names_file_place_member_and_rule() {
    let mut errors = Errors { folder: Folder::new(), text: String::new(), codes: BTreeSet::new() };
    of_vertiports(&mut errors);
    of_demand(&mut errors);
    of_trips(&mut errors);
    of_corridors(&mut errors);
    of_tariffs(&mut errors);
    of_the_network(&mut errors);
    insta::assert_snapshot!("every_error", errors.text);
    let all: BTreeSet<u16> = (701..=717).collect();
    let missing: Vec<&u16> = all.difference(&errors.codes).collect();
    assert!(missing.is_empty(), "{missing:?} are not provoked");
}

fn of_vertiports(errors: &mut Errors) {
    let header = "id,latitude,longitude,stands,busy\n";
    for rows in [
        "A,40.7,-74,4,true\nA,40.8,-74,4,true\n",
        "A,40.7,-74,4,true\n\nB,91,-74,4,true\n",
        "A,40.7,east,4,true\n",
        "A,40.7,,4,true\n",
        "A,40.7,-74,0,true\n",
        "A,40.7,-74,2.5,true\n",
        "A,40.7,-74,4,perhaps\n",
        ",40.7,-74,4,true\n",
        "\"A\tB\",40.7,-74,4,true\n",
        "",
    ] {
        errors.vertiports("places.csv", format!("{header}{rows}"));
    }
    let with_power = "id,latitude,longitude,charger_kw\n";
    errors.vertiports("places.csv", format!("{with_power}A,40.7,-74,0\n"));
    errors.vertiports("places.csv", format!("{with_power}A,40.7,-74,fast\n"));
    errors.vertiports("places.csv", "id,latitudes,longitude\nA,40.7,-74\n");
    errors.vertiports("places.csv", "id,latitude,x\nA,40.7,-74\n");
    errors.vertiports("places.csv", "id;latitude;longitude\nA;40,7;-74\n");
    errors.vertiports("places.csv", "id\tlatitude\tlongitude\nA\t40.7\t-74\n");
    errors.vertiports("places.csv", utf_16(VERTIPORTS));
    errors.vertiports("places.csv", "\u{feff}\r\n");
    errors.vertiports("places.geojson", utf_16("{}"));
    errors.vertiports("places.geojson", "");
    let many = (0..257).map(|n| format!("V{n},40,-74,4,true\n")).collect::<Vec<_>>().concat();
    errors.vertiports("places.csv", format!("{header}{many}"));
    errors.vertiports("places.geojson", "{\"type\":");
    errors.vertiports("places.geojson", map(&[line(r#""id":"A""#, "[-74,40],[-74,41]")]));
    errors.vertiports("places.geojson", map(&[point(r#""id":"A""#, 935_996.0, 191_376.0)]));
    errors.vertiports("places.geojson", map(&[point(r#""id":"A""#, -74.0, 89.5)]));
    errors.vertiports("places.geojson", map(&[point(r#""name":"A""#, -74.0, 40.0)]));
    errors.vertiports("places.parquet", "PAR1");
}

fn of_demand(errors: &mut Errors) {
    let header = "from,to,period,passengers\n";
    for rows in [
        "JRB,JFK2,7,14\n",
        "JRB,JRB,7,14\n",
        "JRB,JFK,7,-1\n",
        "JRB,JFK,48,1\n",
        "JRB,JFK,noon,1\n",
        "JRB,JFK,7,1\nJRB,JFK,07:00:00,1\n",
        "",
    ] {
        errors.table(&format!("{header}{rows}"));
    }
    let places = (0..256).map(|n| format!("V{n},40,-74,4\n")).collect::<Vec<_>>().concat();
    errors.folder.file("vertiports.csv", format!("id,latitude,longitude,stands\n{places}"));
    let minutes =
        (0..62).map(|minute| format!("V0,V1,06:{:02}:{:02},1\n", minute / 2, minute % 2 * 30));
    errors.table(&format!("{header}{}", minutes.collect::<String>()));
    errors.folder.file("vertiports.csv", VERTIPORTS);
}

fn of_trips(errors: &mut Errors) {
    errors.records(
        "pickup_datetime,pickup_latitude,pickup_longitude,dropoff_latitudes,dropoff_longitude\n",
    );
    errors.records("pickup,PULocationID,DOLocationID\n");
    errors.records("pickup_datetime,PULocationID,DOLocationID\n");
    errors.records("");
    errors.records(utf_16(RECORDS));
    errors.records(RECORDS.replace(',', ";"));
    errors.records(RECORDS.replace("pickup_latitude", "x"));
    errors.records(format!("{RECORDS}2015-06-01 07:30,0,0,0,0\n,,,,\n"));
    errors.records(format!("{RECORDS}{}\n", "1,".repeat(40_000)));
    errors.records("x".repeat(5 << 20));
    let parquet = errors.folder.file("records.parquet", parquet_of_numbers());
    let result = run_trips(&errors.folder, Trips::new(vec![&parquet]));
    errors.add(result);
    let zones = errors.folder.file("zones.csv", "zone,latitude,longitude\n1,40,-74\n");
    let mut trips = Trips::new(vec![&parquet]);
    trips.zones = Some(&zones);
    let result = run_trips(&errors.folder, trips);
    errors.add(result);
    let file = errors.folder.file("header.csv", RECORDS);
    errors.setting(&file, |trips| trips.radius_mi = 0.0);
    errors.setting(&file, |trips| trips.mode_share = 1.5);
    errors.setting(&file, |trips| trips.decay_mi = Some(f64::NAN));
    errors.setting(&file, |trips| trips.weekdays = Weekdays::from_iter([]));
    errors.setting(&file, |trips| trips.files.clear());
    errors.setting(&file, |trips| {
        trips.first_date = "2015-06-02".parse().ok();
        trips.last_date = "2015-06-01".parse().ok();
    });
    errors.setting(&file, |trips| {
        trips.columns = TripColumns { passengers: Some("riders"), ..TripColumns::default() };
    });
    errors.zones("zones.csv", "zone,latitude,longitude\n1,40,-74\n1.0,40,-74\n");
    errors.zones("zones.csv", "zone,latitude,longitude\n");
    errors.zones("zones.geojson", &map(&[line(r#""zone":"A""#, "[-74,40],[-74,41]")]));
    let flat = point(r#""zone":"A""#, 0.0, 0.0)
        .replace("Point", "Polygon")
        .replace("[0,0]", "[[[0,0],[1,0],[0,0]]]");
    errors.zones("zones.geojson", &map(&[flat]));
}

fn of_corridors(errors: &mut Errors) {
    const WAY: &str = "[-74.0088,40.70112],[-73.77869,40.63993]";
    let ends = r#""from":"JRB","to":"JFK""#;
    for features in [
        vec![
            line(ends, WAY),
            line(r#""from":"JFK","to":"JRB""#, "[-73.77869,40.63993],[-74.0088,40.70112]"),
        ],
        vec![line(ends, "[-74.0088,40.70112],[-73.8,40.63993]")],
        vec![line(ends, "[-73.77869,40.63993],[-74.0088,40.70112]")],
        vec![line(ends, "[40.70112,-74.0088],[40.63993,-73.77869]")],
        vec![line(r#""from":"JRB","to":"JRB""#, WAY)],
        vec![line(r#""from":"JRB""#, WAY)],
        vec![line(r#""from":"JRB","to":"JFK","both_ways":"maybe""#, WAY)],
        vec![line(ends, "[-74.0088,40.70112]")],
        vec![
            line(ends, &format!("[{WAY}],[{WAY}]"))
                .replace(r#":"LineString"#, r#":"MultiLineString"#),
        ],
        vec![point(ends, -74.0, 40.0)],
        vec![],
    ] {
        errors.with("corridors.geojson", &map(&features));
    }
}

fn of_tariffs(errors: &mut Errors) {
    for rows in ["JRB,JFK,\n", "JRB,JFK,-5\n", "JRB,JFK,5\nJRB,JFK,6\n", ""] {
        errors.with("fares.csv", &format!("from,to,fare_usd\n{rows}"));
    }
    errors.with("fares.csv", "from,to,fare\nJRB,JFK,5\n");
    for rows in ["7,0.1\n", "6,0.1\n6,0.2\n", "6,0.1\n7,x\n", ""] {
        errors.with("prices.csv", &format!("period,price_usd_per_kwh\n{rows}"));
    }
}

fn of_the_network(errors: &mut Errors) {
    let (base, places) = (new_york(), errors.folder.path("vertiports.csv"));
    let demand = errors.folder.file("demand.csv", TABLE);
    let mut wrong = request(&base, &places, Demand::Table(&demand));
    wrong.name = "a name # with spaces\n";
    errors.add(run(&wrong));
    let small =
        errors.folder.file("small.csv", "id,latitude,longitude\nJRB,40.7,-74\nJFK,40.6,-73.8\n");
    errors.add(run(&request(&base, &small, Demand::Table(&demand))));
    let mut zone = request(&base, &places, Demand::Table(&demand));
    zone.time_zone = Some("Eastern Time");
    errors.add(run(&zone));
    let long = errors.folder.file("long.csv", vec![b' '; (16 << 20) + 1]);
    errors.add(run(&request(&base, &long, Demand::Table(&demand))));
    let away = errors.folder.path("away.csv");
    let result = run(&request(&base, &places, Demand::Table(&away)));
    errors.add(result);
    let stop = Stop::default();
    stop.request();
    errors.add(import(&request(&base, &places, Demand::Table(&demand)), &stop, &|_| ()));
}

#[test]
fn whatever_else_is_wrong_is_said_before_long_files_are_read() {
    let folder = Folder::new();
    let (base, away) = (Network::shipped("new-york").expect("shipped"), folder.path("away.csv"));
    let small = folder.file("small.csv", "id,latitude,longitude\nJRB,40.7,-74\n");
    let error = run(&request(&base, &small, Demand::Trips(Trips::new(vec![&away]))))
        .expect_err("too few stands");
    assert_eq!(error.code().0, 117);
}
