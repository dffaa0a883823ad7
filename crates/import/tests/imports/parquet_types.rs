//! The types that columns of Parquet files may have: equal values of different types give the same
//! network.

use std::path::PathBuf;
use std::sync::Arc;

use parquet::data_type::{
    ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int32Type, Int64Type, Int96,
    Int96Type,
};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use vertifleet_core::Coded;
use vertifleet_import::{Demand, Error, Imported, Trips};

use crate::planner::{Folder, new_york, request, run, run_table, run_trips};

type Group<'a, 'b> = SerializedRowGroupWriter<'a, &'b mut Vec<u8>>;

/// Writes the next column; of an optional column the values are those of the rows where `present`
/// is 1.
fn column<T: DataType>(group: &mut Group<'_, '_>, values: &[T::T], present: Option<&[i16]>) {
    let mut column = group.next_column().expect("a file").expect("a column");
    column.typed::<T>().write_batch(values, present, None).expect("written");
    column.close().expect("written");
}

/// A file with one row group.
fn file(
    folder: &Folder,
    name: &str,
    schema: &str,
    write: impl FnOnce(&mut Group<'_, '_>),
) -> PathBuf {
    let schema = parse_message_type(&format!("message table {{ {schema} }}")).expect("a schema");
    let mut bytes = Vec::new();
    let properties = Arc::new(WriterProperties::builder().build());
    let mut writer =
        SerializedFileWriter::new(&mut bytes, Arc::new(schema), properties).expect("a file");
    let mut group = writer.next_row_group().expect("a group");
    write(&mut group);
    group.close().expect("written");
    writer.close().expect("written");
    folder.file(name, bytes)
}

fn texts(texts: &[&str]) -> Vec<ByteArray> {
    texts.iter().map(|&text| text.into()).collect()
}

/// 2015-06-01 07:30:00 and 08:30:00.
const SECONDS: [i64; 2] = [1_433_143_800, 1_433_147_400];

fn times(per_second: i64) -> [i64; 2] {
    SECONDS.map(|second| second * per_second)
}

/// Imports two trips from zone 12 to Kennedy of which the second has no passengers, with the first
/// column as given.
fn two_trips(
    time_type: &str,
    zone_type: &str,
    write: impl FnOnce(&mut Group<'_, '_>),
) -> Result<Imported, Error> {
    let folder = Folder::new();
    let zones = folder
        .file("zones.csv", "zone,latitude,longitude\n12,40.70112,-74.0088\nK,40.63993,-73.77869\n");
    let schema = format!(
        "required {time_type}; required {zone_type}; required binary DOLocationID (UTF8); optional float passenger_count;"
    );
    let path = file(&folder, "trips.parquet", &schema, |group| {
        write(group);
        column::<ByteArrayType>(group, &texts(&["K", "K"]), None);
        column::<FloatType>(group, &[2.0], Some(&[1, 0]));
    });
    let mut trips = Trips::new(vec![&path]);
    (trips.zones, trips.mode_share) = (Some(zones.as_path()), 1.0);
    run_trips(&folder, trips)
}

#[test]
fn times_and_zones_may_have_any_type_that_says_them() {
    const ZONE: &str = "int32 PULocationID";
    let time = |annotation: &str| format!("int64 pickup_datetime ({annotation})");
    let zone = |group: &mut Group<'_, '_>| column::<Int32Type>(group, &[12, 12], None);
    let whole = |annotation: &str, per_second| {
        two_trips(&time(annotation), ZONE, |group| {
            column::<Int64Type>(group, &times(per_second), None);
            zone(group);
        })
    };
    let written = |annotation: &str| {
        two_trips(&format!("binary pickup_datetime{annotation}"), "double PULocationID", |group| {
            column::<ByteArrayType>(
                group,
                &texts(&["2015-06-01 07:30:00", "2015-06-01T08:30"]),
                None,
            );
            column::<DoubleType>(group, &[12.0, 12.0], None);
        })
    };
    let julian = two_trips("int96 pickup_datetime", ZONE, |group| {
        let day = |second: u64| {
            let mut time = Int96::new();
            let nanos = second * 1_000_000_000;
            #[expect(clippy::cast_possible_truncation, reason = "the halves of a 64-bit number")]
            time.set_data(nanos as u32, (nanos >> 32) as u32, 2_457_175);
            time
        };
        column::<Int96Type>(group, &[day(27_000), day(30_600)], None);
        zone(group);
    });
    let all = [
        whole("TIMESTAMP_MILLIS", 1_000),
        whole("TIMESTAMP_MICROS", 1_000_000),
        whole("TIMESTAMP(NANOS,false)", 1_000_000_000),
        whole("TIMESTAMP(MILLIS,true)", 1_000),
        two_trips(&time("TIMESTAMP_MILLIS"), "int32 PULocationID (DECIMAL(9,2))", |group| {
            column::<Int64Type>(group, &times(1_000), None);
            column::<Int32Type>(group, &[1200, 1200], None);
        }),
        written(" (UTF8)"),
        written(""),
        julian,
    ];
    let all: Vec<Imported> = all.into_iter().map(|one| one.expect("a network")).collect();
    let account = all[0].account.as_ref().expect("an account");
    assert_eq!((account.kept, account.no_passengers, account.passengers_a_day), (1, 1, 2.0));
    for one in &all[1..] {
        assert_eq!(one.toml, all[0].toml);
    }
}

#[test]
fn types_that_say_no_time_or_number_are_refused() {
    let refused = [
        two_trips("int64 pickup_datetime", "int32 PULocationID", |group| {
            column::<Int64Type>(group, &times(1), None);
            column::<Int32Type>(group, &[12, 12], None);
        }),
        two_trips(
            "int64 pickup_datetime (TIMESTAMP_MILLIS)",
            "int32 PULocationID (DATE)",
            |group| {
                column::<Int64Type>(group, &times(1_000), None);
                column::<Int32Type>(group, &[12, 12], None);
            },
        ),
    ];
    for result in refused {
        assert_eq!(result.expect_err("a wrong type").code().0, 711);
    }
}

#[test]
fn a_table_of_demand_in_parquet_is_the_one_in_csv() {
    let folder = Folder::new();
    let csv = run_table(&folder, "period,from,to,passengers\n7,JRB,JFK,14\n8,JFK,JRB,2.5\n")
        .expect("a network");
    let schema = "required double passengers; required int32 period; required binary to (UTF8); required binary from (UTF8);";
    let path = file(&folder, "demand.parquet", schema, |group| {
        column::<DoubleType>(group, &[14.0, 2.5], None);
        column::<Int32Type>(group, &[7, 8], None);
        column::<ByteArrayType>(group, &texts(&["JFK", "JRB"]), None);
        column::<ByteArrayType>(group, &texts(&["JRB", "JFK"]), None);
    });
    let (base, vertiports) = (new_york(), folder.path("vertiports.csv"));
    let parquet = run(&request(&base, &vertiports, Demand::Table(&path))).expect("a network");
    assert_eq!(parquet.toml.replace("demand.parquet", "demand.csv"), csv.toml);
}

#[test]
fn times_of_day_decimals_and_single_precision_are_read_as_they_are_written() {
    let folder = Folder::new();
    let csv =
        run_table(&folder, "period,from,to,passengers\n07:30,JRB,JFK,1.4\n").expect("a network");
    let ends = "required binary to (UTF8); required binary from (UTF8);";
    let (base, vertiports) = (new_york(), folder.path("vertiports.csv"));
    for (passengers, single) in
        [("int64 passengers (DECIMAL(12,1))", false), ("float passengers", true)]
    {
        let schema = format!("required {passengers}; required int32 period (TIME_MILLIS); {ends}");
        let path = file(&folder, "demand.parquet", &schema, |group| {
            if single {
                column::<FloatType>(group, &[1.4], None);
            } else {
                column::<Int64Type>(group, &[14], None);
            }
            column::<Int32Type>(group, &[27_000_000], None);
            column::<ByteArrayType>(group, &texts(&["JFK"]), None);
            column::<ByteArrayType>(group, &texts(&["JRB"]), None);
        });
        let parquet = run(&request(&base, &vertiports, Demand::Table(&path))).expect("a network");
        assert_eq!(parquet.toml.replace("demand.parquet", "demand.csv"), csv.toml);
    }
}

/// Imports a Parquet table of demand.
fn demand(schema: &str, write: impl FnOnce(&mut Group<'_, '_>)) -> Result<Imported, Error> {
    let folder = Folder::new();
    let (base, places) = (new_york(), folder.path("vertiports.csv"));
    let table = file(&folder, "demand.parquet", schema, write);
    run(&request(&base, &places, Demand::Table(&table)))
}

fn warnings(imported: &Imported) -> String {
    imported.warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// The demand of a network file.
fn demand_section(imported: &Imported) -> Vec<&str> {
    let lines = imported.toml.lines().skip_while(|line| *line != "[hourly_demand]");
    lines.filter(|line| line.contains("periods") || line.contains("from =")).collect()
}

#[test]
fn wide_tables_are_those_of_csv() {
    // More columns than trip records have.
    let hours: Vec<String> = (6..22).map(|hour| format!("{hour:02}:00")).collect();
    let numbers: Vec<String> =
        hours.iter().map(|hour| format!("required double {hour};")).collect();
    let numbers = numbers.concat();
    let ends = "required binary from (UTF8); required binary to (UTF8);";
    let by_period = demand(&format!("{ends} {numbers}"), |group| {
        column::<ByteArrayType>(group, &texts(&["JRB"]), None);
        column::<ByteArrayType>(group, &texts(&["JFK"]), None);
        for passengers in 0_u8..16 {
            column::<DoubleType>(group, &[passengers.into()], None);
        }
    });
    let row: Vec<String> = (0..16).map(|passengers| passengers.to_string()).collect();
    let table = format!("from,to,{}\nJRB,JFK,{}\n", hours.join(","), row.join(","));
    let csv = run_table(&Folder::new(), &table).expect("a network");
    assert_eq!(demand_section(&by_period.expect("a network")), demand_section(&csv));

    let by_destination = |name: &str| {
        let schema = format!(
            "required int32 period; required binary from (UTF8); required double JRB; required double {name};"
        );
        demand(&schema, |group| {
            column::<Int32Type>(group, &[6, 7], None);
            column::<ByteArrayType>(group, &texts(&["EWR", "EWR"]), None);
            column::<DoubleType>(group, &[3.0, 4.0], None);
            column::<DoubleType>(group, &[2.0, 0.0], None);
        })
    };
    let csv = run_table(&Folder::new(), "period,from,JRB,JFK\n6,EWR,3,2\n7,EWR,4,0\n");
    let same = by_destination("JFK").expect("a network");
    assert_eq!(demand_section(&same), demand_section(&csv.expect("a network")));
    let error = by_destination("JFX").expect_err("no vertiport");
    assert_eq!(error.code().0, 705);
    assert!(error.to_string().contains("demand.parquet: the names of its columns: "), "{error}");
}

#[test]
fn columns_that_may_split_a_table_are_named_whatever_their_type() {
    let long = "required int32 period; required binary from (UTF8); required binary to (UTF8); required double passengers;";
    let others =
        "required binary scenario (UTF8); required int32 date (DATE); optional double growth;";
    let table = |second_period: i32| {
        demand(&format!("{long} {others}"), |group| {
            column::<Int32Type>(group, &[6, second_period], None);
            column::<ByteArrayType>(group, &texts(&["JRB", "JRB"]), None);
            column::<ByteArrayType>(group, &texts(&["JFK", "JFK"]), None);
            column::<DoubleType>(group, &[3.0, 4.0], None);
            column::<ByteArrayType>(group, &texts(&["low", "high"]), None);
            column::<Int32Type>(group, &[16_587, 16_588], None);
            column::<DoubleType>(group, &[1.5], Some(&[1, 0]));
        })
    };
    let found = warnings(&table(7).expect("a network"));
    for named in [
        r#""scenario" (such as "low" and "high")"#,
        r#""date" (such as "2015-06-01 "#,
        r#""growth" (such as "1.5" and "")"#,
    ] {
        assert!(found.contains(named), "{found}");
    }
    let twice = table(6).expect_err("given twice");
    assert!(twice.hint().is_some_and(|hint| hint.contains("\"scenario\"")), "{:?}", twice.hint());
}
