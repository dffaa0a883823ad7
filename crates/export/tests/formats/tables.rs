//! CSV and Parquet: the same columns, and all that the trace has.

use bytes::Bytes;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row, RowAccessor};
use proptest::prelude::{prop_assert_eq, proptest};
use vertifleet_export::{CSV_FILE, PARQUET_FILE};

use crate::days::{Played, any_played, calendar, tiny};

/// A row of the CSV file, by the names of its columns.
type Record = std::collections::HashMap<String, String>;

fn records(bytes: &[u8]) -> Vec<Record> {
    let mut reader = csv::Reader::from_reader(bytes);
    reader.deserialize().map(|record| record.expect("a row")).collect()
}

fn number(record: &Record, column: &str) -> f64 {
    record[column].parse().expect("a number")
}

fn rows(bytes: Vec<u8>) -> Vec<Row> {
    let reader = SerializedFileReader::new(Bytes::from(bytes)).expect("a Parquet file");
    reader.get_row_iter(None).expect("rows").map(|row| row.expect("a row")).collect()
}

/// The columns of a Parquet file, each with its type.
fn schema(bytes: Vec<u8>) -> String {
    let reader = SerializedFileReader::new(Bytes::from(bytes)).expect("a Parquet file");
    let mut text = Vec::new();
    let root = reader.metadata().file_metadata().schema();
    parquet::schema::printer::print_schema(&mut text, root);
    String::from_utf8(text).expect("text")
}

fn field<'a>(row: &'a Row, column: &str) -> &'a Field {
    let mut columns = row.get_column_iter();
    columns.find(|(name, _)| *name == column).map(|(_, field)| field).expect("a column")
}

fn double(row: &Row, column: &str) -> f64 {
    let at = row.get_column_iter().position(|(name, _)| name == column).expect("a column");
    row.get_double(at).expect("a number")
}

fn text<'a>(row: &'a Row, column: &str) -> &'a str {
    match field(row, column) {
        Field::Str(text) => text,
        other => panic!("{column} is {other}"),
    }
}

fn revenue_usd(played: &Played) -> f64 {
    played.rows.iter().map(|row| row.revenue_usd).sum()
}

#[test]
fn the_table_of_a_tiny_day_reads_as_it_should() {
    let csv = vertifleet_export::csv(&tiny().flown(), Some(&calendar()));
    assert!(csv.starts_with(CSV_FILE.opening.as_bytes()));
    insta::assert_snapshot!(String::from_utf8(csv).expect("text"));
}

#[test]
fn without_a_calendar_there_are_no_instants() {
    let csv = String::from_utf8(vertifleet_export::csv(&tiny().flown(), None)).expect("text");
    assert!(!csv.contains("_utc"));
    assert!(!schema(vertifleet_export::parquet(&tiny().flown(), None)).contains("_utc"));
}

#[test]
fn the_schema_of_parquet_is_documented_by_its_file() {
    let parquet = vertifleet_export::parquet(&tiny().flown(), Some(&calendar()));
    assert!(parquet.starts_with(PARQUET_FILE.opening.as_bytes()));
    insta::assert_snapshot!(schema(parquet));
}

#[test]
fn the_metadata_of_parquet_name_the_day_and_its_calendar() {
    let parquet = vertifleet_export::parquet(&tiny().flown(), Some(&calendar()));
    let reader = SerializedFileReader::new(Bytes::from(parquet)).expect("a Parquet file");
    let metadata = reader.metadata().file_metadata();
    assert_eq!(metadata.created_by(), Some("Vertifleet"));
    let entries: Vec<String> = metadata
        .key_value_metadata()
        .expect("entries")
        .iter()
        .map(|entry| format!("{}={}", entry.key, entry.value.as_deref().unwrap_or_default()))
        .collect();
    assert_eq!(
        entries,
        [
            "vertifleet.day=tiny",
            "vertifleet.date=2026-11-24",
            "vertifleet.time_zone=America/New_York"
        ]
    );
}

#[test]
fn times_past_midnight_belong_to_the_next_date() {
    let played = tiny();
    let csv = records(&vertifleet_export::csv(&played.flown(), Some(&calendar())));
    assert_eq!(csv[2]["departure"], "24:01:00");
    assert_eq!(csv[2]["departure_s"], "86460");
    assert_eq!(csv[2]["departure_utc"], "2026-11-25T05:01:00Z");
    let parquet = rows(vertifleet_export::parquet(&played.flown(), Some(&calendar())));
    assert_eq!(text(&parquet[2], "departure"), "24:01:00");
    assert_eq!(*field(&parquet[2], "departure_s"), Field::Int(86_460));
    let instant: jiff::Timestamp = "2026-11-25T05:01:00Z".parse().expect("an instant");
    let micros = Field::TimestampMicros(instant.as_microsecond());
    assert_eq!(*field(&parquet[2], "departure_utc"), micros);
}

#[test]
fn a_place_that_is_not_known_is_missing() {
    let mut played = tiny();
    let mut day = played.day.into_day();
    day.vertiports[1].degrees = None;
    played.day = day.check("a day in miles").expect("a day within the rules");
    let csv = records(&vertifleet_export::csv(&played.flown(), None));
    assert_eq!(
        (csv[0]["from_latitude_deg"].as_str(), csv[0]["to_latitude_deg"].as_str()),
        ("40.7033", "")
    );
    let parquet = rows(vertifleet_export::parquet(&played.flown(), None));
    assert_eq!(*field(&parquet[0], "from_latitude_deg"), Field::Double(40.7033));
    assert_eq!(*field(&parquet[0], "to_latitude_deg"), Field::Null);
}

proptest! {
    #[test]
    fn csv_has_all_that_the_trace_has(played in any_played()) {
        let csv = records(&vertifleet_export::csv(&played.flown(), Some(&calendar())));
        prop_assert_eq!(csv.len(), played.rows.len());
        for (record, row) in csv.iter().zip(&played.rows) {
            prop_assert_eq!(&record["aircraft"], &played.aircraft(row).id);
            prop_assert_eq!(&record["from"], &played.vertiport(row.from).id);
            prop_assert_eq!(&record["to"], &played.vertiport(row.to).id);
            prop_assert_eq!(&record["departure"], &row.time.to_string());
            prop_assert_eq!(&record["arrival"], &row.arrival.to_string());
            prop_assert_eq!(&record["ready_s"], &row.ready.seconds().to_string());
            prop_assert_eq!(&record["passengers"], &row.passengers.to_string());
            prop_assert_eq!(number(record, "passenger_cost_usd"), row.passenger_cost_usd);
            prop_assert_eq!(number(record, "energy_kwh"), row.energy_kwh);
            prop_assert_eq!(number(record, "energy_cost_usd"), row.energy_cost_usd);
            prop_assert_eq!(number(record, "flight_cost_usd"), row.flight_cost_usd);
            prop_assert_eq!(number(record, "profit_usd"), row.profit_usd());
            let degrees = played.vertiport(row.to).degrees.expect("a place");
            prop_assert_eq!(number(record, "to_longitude_deg"), degrees.longitude);
        }
        let revenue: f64 = csv.iter().map(|record| number(record, "revenue_usd")).sum();
        prop_assert_eq!(revenue.to_bits(), revenue_usd(&played).to_bits());
    }

    #[test]
    fn parquet_has_all_that_the_trace_has(played in any_played()) {
        let parquet = rows(vertifleet_export::parquet(&played.flown(), Some(&calendar())));
        prop_assert_eq!(parquet.len(), played.rows.len());
        for (read, row) in parquet.iter().zip(&played.rows) {
            prop_assert_eq!(text(read, "aircraft"), &played.aircraft(row).id);
            prop_assert_eq!(text(read, "from"), &played.vertiport(row.from).id);
            prop_assert_eq!(text(read, "to"), &played.vertiport(row.to).id);
            let kind = match (row.from == row.to, row.passengers) {
                (true, _) => "hold",
                (false, 0) => "reposition",
                (false, _) => "flight",
            };
            prop_assert_eq!(text(read, "kind"), kind);
            let arrival = i32::try_from(row.arrival.seconds()).expect("within a day or two");
            prop_assert_eq!(field(read, "arrival_s"), &Field::Int(arrival));
            prop_assert_eq!(field(read, "passengers"), &Field::Int(row.passengers.into()));
            prop_assert_eq!(double(read, "profit_usd"), row.profit_usd());
            let degrees = played.vertiport(row.from).degrees.expect("a place");
            prop_assert_eq!(double(read, "from_latitude_deg"), degrees.latitude);
        }
        let revenue: f64 = parquet.iter().map(|row| double(row, "revenue_usd")).sum();
        prop_assert_eq!(revenue.to_bits(), revenue_usd(&played).to_bits());
    }

    #[test]
    fn the_same_day_gives_the_same_bytes(played in any_played()) {
        let (flown, again, calendar) = (played.flown(), played.clone(), calendar());
        let again = again.flown();
        prop_assert_eq!(
            vertifleet_export::csv(&flown, Some(&calendar)),
            vertifleet_export::csv(&again, Some(&calendar))
        );
        prop_assert_eq!(
            vertifleet_export::parquet(&flown, Some(&calendar)),
            vertifleet_export::parquet(&again, Some(&calendar))
        );
    }
}
