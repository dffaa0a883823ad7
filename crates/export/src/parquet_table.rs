//! Parquet: the columns of the CSV file with types, for data frames and databases.
//!
//! | values | physical type | logical type |
//! |---|---|---|
//! | ids, kinds, clock times | `BYTE_ARRAY` | `STRING` |
//! | passengers, seats, seconds since midnight | `INT32` | |
//! | amounts, distances, energies | `DOUBLE` | |
//! | instants, with a calendar | `INT64` | `TIMESTAMP`, in microseconds UTC |
//! | latitudes and longitudes | `DOUBLE`, optional | |
//!
//! All decisions stand in one row group, compressed with zstd. The file's metadata hold the name of the day, and the
//! date and time zone of the calendar.

use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, TimeUnit, Type as Physical, ZstdLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use vertifleet_core::Time;

use crate::columns::{Column, Values, columns};
use crate::flown::Taken;
use crate::{Calendar, Flown};

/// Every decision of the day as a Parquet file. With a calendar, the times stand there as instants too.
pub fn parquet(flown: &Flown<'_>, calendar: Option<&Calendar>) -> Vec<u8> {
    written(flown, calendar)
        .expect("memory takes every byte, and the columns are those of the schema")
}

fn written(flown: &Flown<'_>, calendar: Option<&Calendar>) -> Result<Vec<u8>, ParquetError> {
    let columns: Vec<&Column> = columns(calendar.is_some()).collect();
    let properties = WriterProperties::builder()
        .set_created_by("Vertifleet".to_owned())
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(3)?))
        .set_key_value_metadata(Some(metadata(flown, calendar)))
        // The day is one group, so that readers find its rows in the order of the trace.
        .set_max_row_group_row_count(None)
        .build();
    let mut file = SerializedFileWriter::new(Vec::new(), schema(&columns)?, Arc::new(properties))?;
    let taken: Vec<Taken<'_>> = flown.decisions().collect();
    let mut group = file.next_row_group()?;
    for column in columns {
        write_column(&mut group, column.values, &taken, calendar)?;
    }
    group.close()?;
    file.into_inner()
}

fn metadata(flown: &Flown<'_>, calendar: Option<&Calendar>) -> Vec<KeyValue> {
    let entry = |key: &str, value: String| KeyValue::new(key.to_owned(), value);
    let mut entries = vec![entry("vertifleet.day", flown.day().name.clone())];
    if let Some(calendar) = calendar {
        entries.push(entry("vertifleet.date", calendar.date().to_string()));
        entries.push(entry("vertifleet.time_zone", calendar.zone_name().to_owned()));
    }
    entries
}

fn schema(columns: &[&Column]) -> Result<TypePtr, ParquetError> {
    let fields = columns.iter().map(|column| field(column).map(Arc::new));
    let fields = fields.collect::<Result<_, _>>()?;
    Ok(Arc::new(Type::group_type_builder("decisions").with_fields(fields).build()?))
}

fn field(column: &Column) -> Result<Type, ParquetError> {
    let instant = LogicalType::timestamp(true, TimeUnit::MICROS);
    let (physical, logical) = match column.values {
        Values::Text(_) | Values::Clock(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        Values::Seconds(_) | Values::Count(_) => (Physical::INT32, None),
        Values::Instant(_) => (Physical::INT64, Some(instant)),
        Values::Number(_) | Values::Degrees(_) => (Physical::DOUBLE, None),
    };
    let repetition = match column.values {
        Values::Degrees(_) => Repetition::OPTIONAL,
        _ => Repetition::REQUIRED,
    };
    Type::primitive_type_builder(column.name, physical)
        .with_logical_type(logical)
        .with_repetition(repetition)
        .build()
}

fn write_column(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    values: Values,
    taken: &[Taken<'_>],
    calendar: Option<&Calendar>,
) -> Result<(), ParquetError> {
    match values {
        Values::Text(value) => {
            write::<ByteArrayType>(group, taken.iter().map(|taken| ByteArray::from(value(taken))))
        }
        Values::Clock(value) => {
            let text = |taken| ByteArray::from(value(taken).to_string().into_bytes());
            write::<ByteArrayType>(group, taken.iter().map(text))
        }
        Values::Seconds(value) => {
            write::<Int32Type>(group, taken.iter().map(|taken| seconds(value(taken))))
        }
        Values::Count(value) => {
            write::<Int32Type>(group, taken.iter().map(|taken| value(taken).into()))
        }
        Values::Instant(value) => {
            let times = taken.iter().filter_map(|taken| {
                calendar.map(|calendar| calendar.instant(value(taken)).as_microsecond())
            });
            write::<Int64Type>(group, times)
        }
        Values::Number(value) => write::<DoubleType>(group, taken.iter().map(value)),
        Values::Degrees(value) => write_optional(group, taken.iter().map(value)),
    }
}

fn seconds(time: Time) -> i32 {
    i32::try_from(time.seconds()).expect("`Flown` holds no time past 9999:59:59")
}

fn write<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    values: impl Iterator<Item = T::T>,
) -> Result<(), ParquetError> {
    write_levels::<T>(group, &values.collect::<Vec<_>>(), None)
}

/// Writes a column in which values may be missing. The level of a row says whether it has a value.
fn write_optional(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    values: impl Iterator<Item = Option<f64>> + Clone,
) -> Result<(), ParquetError> {
    let levels: Vec<i16> = values.clone().map(|value| value.is_some().into()).collect();
    let present: Vec<f64> = values.flatten().collect();
    write_levels::<DoubleType>(group, &present, Some(&levels))
}

fn write_levels<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    values: &[T::T],
    levels: Option<&[i16]>,
) -> Result<(), ParquetError> {
    let mut column = group.next_column()?.expect("a column of the schema for each that is written");
    column.typed::<T>().write_batch(values, levels, None)?;
    column.close()
}
