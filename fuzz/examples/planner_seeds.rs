//! Writes planners' files as seeds for fuzzing, in a folder for each reader:
//! `cargo run --example planner_seeds -- FOLDER`.

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;

#[path = "../fuzz_targets/planner_files.rs"]
mod planner_files;

use planner_files::{CORRIDORS, DEMAND, FARES, TRIPS, VERTIPORTS, ZONES, import_with};

const POINTS: &str = r#"{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"id":"JRB","stands":40},
"geometry":{"type":"Point","coordinates":[-74.0088,40.70112]}},{"type":"Feature","properties":{"id":"JFK","busy":true},
"geometry":{"type":"Point","coordinates":[-73.77869,40.63993]}}]}"#;
const AREAS: &str = r#"{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"zone":12},
"geometry":{"type":"Polygon","coordinates":[[[-74.02,40.70],[-74.0,40.70],[-74.0,40.71],[-74.02,40.70]]]}},
{"type":"Feature","properties":{"zone":"Kennedy"},"geometry":{"type":"Point","coordinates":[-73.77869,40.63993]}}]}"#;

fn main() {
    let folder = PathBuf::from(std::env::args().nth(1).expect("a folder to write to"));
    let seeds: [(&str, &str, Vec<u8>); 10] = [
        ("vertiports", "table", VERTIPORTS.into()),
        ("vertiports", "map", POINTS.into()),
        ("demand", "table", DEMAND.into()),
        ("demand", "columns", demand().expect("memory takes every byte")),
        ("trips", "table", TRIPS.into()),
        ("trips", "columns", trips().expect("memory takes every byte")),
        ("zones", "table", ZONES.into()),
        ("zones", "map", AREAS.into()),
        ("corridors", "map", CORRIDORS.into()),
        ("fares", "table", FARES.into()),
    ];
    for (reader, name, bytes) in seeds {
        assert!(import_with(reader, &bytes), "the {name} of {reader} is good");
        fs::create_dir_all(folder.join(reader)).expect("a folder that can be made");
        fs::write(folder.join(reader).join(name), bytes).expect("a folder of ours");
    }
}

/// A table of demand as Parquet.
fn demand() -> Result<Vec<u8>, ParquetError> {
    let schema = "message demand { required binary from (STRING); required binary to (STRING); required int64 period; \
                  required double passengers; }";
    written(schema, |group| {
        column::<ByteArrayType>(group, &["JRB", "JFK"].map(ByteArray::from))?;
        column::<ByteArrayType>(group, &["JFK", "JRB"].map(ByteArray::from))?;
        column::<Int64Type>(group, &[7, 8])?;
        column::<DoubleType>(group, &[14.0, 2.5])
    })
}

/// Trip records as Parquet, with coordinates.
fn trips() -> Result<Vec<u8>, ParquetError> {
    let schema = "message trips { required int64 pickup_datetime (TIMESTAMP(MICROS,false)); \
                  required double pickup_latitude; required double pickup_longitude; \
                  required double dropoff_latitude; required double dropoff_longitude; }";
    written(schema, |group| {
        column::<Int64Type>(group, &[1_433_143_800_000_000, 1_433_147_400_000_000])?;
        column::<DoubleType>(group, &[40.701_12, 40.639_93])?;
        column::<DoubleType>(group, &[-74.0088, -73.778_69])?;
        column::<DoubleType>(group, &[40.639_93, 40.701_12])?;
        column::<DoubleType>(group, &[-73.778_69, -74.0088])
    })
}

type Group<'a> = SerializedRowGroupWriter<'a, Vec<u8>>;

fn written(
    schema: &str,
    columns: impl FnOnce(&mut Group<'_>) -> Result<(), ParquetError>,
) -> Result<Vec<u8>, ParquetError> {
    let properties = Arc::new(WriterProperties::builder().build());
    let schema = Arc::new(parse_message_type(schema)?);
    let mut file = SerializedFileWriter::new(Vec::new(), schema, properties)?;
    let mut group = file.next_row_group()?;
    columns(&mut group)?;
    group.close()?;
    file.into_inner()
}

fn column<T: DataType>(group: &mut Group<'_>, values: &[T::T]) -> Result<(), ParquetError> {
    let mut column = group.next_column()?.expect("a column of the schema");
    column.typed::<T>().write_batch(values, None, None)?;
    column.close()
}
