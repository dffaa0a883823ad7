//! Tables of typed columns as Parquet files, for data frames and databases, and as CSV.
//!
//! A Parquet file has all rows in one row group, compressed with zstd. The same table gives the
//! same bytes on every machine.

use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, TimeUnit, Type as Physical, ZstdLevel};
use parquet::data_type::{
    BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int32Type, Int64Type,
};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};

/// A column of a table: its name, with the unit, and a cell for each row.
#[derive(Debug, Clone, PartialEq)]
pub struct TypedColumn {
    /// The name.
    pub name: String,
    /// The cells.
    pub cells: Cells,
}

/// The cells of a column, which all have one type. Those that may be missing are optional in the
/// file.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// Texts (`BYTE_ARRAY`, `STRING`).
    Text(Vec<String>),
    /// Texts that may be missing.
    OptionalText(Vec<Option<String>>),
    /// True or false (`BOOLEAN`).
    Flag(Vec<bool>),
    /// Whole numbers of 32 bits (`INT32`).
    Short(Vec<i32>),
    /// Whole numbers of 64 bits (`INT64`).
    Whole(Vec<i64>),
    /// Whole numbers of 64 bits that may be missing.
    OptionalWhole(Vec<Option<i64>>),
    /// Numbers (`DOUBLE`).
    Number(Vec<f64>),
    /// Numbers that may be missing.
    OptionalNumber(Vec<Option<f64>>),
    /// Instants in microseconds of the Unix clock (`INT64`, `TIMESTAMP` in UTC).
    Instant(Vec<i64>),
}

/// The table as a Parquet file whose rows are called `rows`. `metadata` are keys and values of the
/// file.
///
/// # Panics
/// Panics if columns have different numbers of cells, or names that are no names.
pub fn typed_table(rows: &str, columns: &[TypedColumn], metadata: &[(&str, String)]) -> Vec<u8> {
    written(rows, columns, metadata)
        .expect("memory takes every byte, and the columns are those of the schema")
}

/// The table as CSV with a header row. A cell that is missing is empty.
///
/// # Panics
/// Panics if columns have different numbers of cells.
pub fn csv_table(columns: &[TypedColumn]) -> Vec<u8> {
    const TO_MEMORY: &str = "memory takes every row";
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    writer.write_record(columns.iter().map(|column| &column.name)).expect(TO_MEMORY);
    let texts: Vec<Vec<String>> = columns.iter().map(|column| column.cells.texts()).collect();
    for row in 0..texts.first().map_or(0, Vec::len) {
        writer.write_record(texts.iter().map(|column| &column[row])).expect(TO_MEMORY);
    }
    writer.into_inner().expect(TO_MEMORY)
}

impl Cells {
    /// The cells as texts.
    fn texts(&self) -> Vec<String> {
        fn all<T: ToString>(cells: &[T]) -> Vec<String> {
            cells.iter().map(T::to_string).collect()
        }
        fn present<T: ToString>(cells: &[Option<T>]) -> Vec<String> {
            cells.iter().map(|cell| cell.as_ref().map_or_else(String::new, T::to_string)).collect()
        }
        match self {
            Self::Text(cells) => cells.clone(),
            Self::OptionalText(cells) => present(cells),
            Self::Flag(cells) => all(cells),
            Self::Short(cells) => all(cells),
            Self::Whole(cells) | Self::Instant(cells) => all(cells),
            Self::OptionalWhole(cells) => present(cells),
            Self::Number(cells) => all(cells),
            Self::OptionalNumber(cells) => present(cells),
        }
    }
}

fn written(
    rows: &str,
    columns: &[TypedColumn],
    metadata: &[(&str, String)],
) -> Result<Vec<u8>, ParquetError> {
    let entry = |(key, value): &(&str, String)| KeyValue::new((*key).to_owned(), value.clone());
    let entries: Vec<KeyValue> = metadata.iter().map(entry).collect();
    let properties = WriterProperties::builder()
        .set_created_by("Vertifleet".to_owned())
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(3)?))
        .set_key_value_metadata((!entries.is_empty()).then_some(entries))
        // The table is one group, so that readers find its rows in their order.
        .set_max_row_group_row_count(None)
        .build();
    let schema = schema(rows, columns)?;
    let mut file = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    for column in columns {
        column.cells.write(&mut group)?;
    }
    group.close()?;
    file.into_inner()
}

fn schema(rows: &str, columns: &[TypedColumn]) -> Result<TypePtr, ParquetError> {
    let fields = columns.iter().map(|column| column.field().map(Arc::new));
    let fields = fields.collect::<Result<_, _>>()?;
    Ok(Arc::new(Type::group_type_builder(rows).with_fields(fields).build()?))
}

impl TypedColumn {
    /// A column.
    pub fn new(name: impl Into<String>, cells: Cells) -> Self {
        Self { name: name.into(), cells }
    }

    fn field(&self) -> Result<Type, ParquetError> {
        let instant = LogicalType::timestamp(true, TimeUnit::MICROS);
        let (physical, logical) = match self.cells {
            Cells::Text(_) | Cells::OptionalText(_) => {
                (Physical::BYTE_ARRAY, Some(LogicalType::String))
            }
            Cells::Flag(_) => (Physical::BOOLEAN, None),
            Cells::Short(_) => (Physical::INT32, None),
            Cells::Whole(_) | Cells::OptionalWhole(_) => (Physical::INT64, None),
            Cells::Number(_) | Cells::OptionalNumber(_) => (Physical::DOUBLE, None),
            Cells::Instant(_) => (Physical::INT64, Some(instant)),
        };
        let repetition = match self.cells {
            Cells::OptionalText(_) | Cells::OptionalWhole(_) | Cells::OptionalNumber(_) => {
                Repetition::OPTIONAL
            }
            _ => Repetition::REQUIRED,
        };
        Type::primitive_type_builder(&self.name, physical)
            .with_logical_type(logical)
            .with_repetition(repetition)
            .build()
    }
}

type Group<'a> = SerializedRowGroupWriter<'a, Vec<u8>>;

impl Cells {
    fn write(&self, group: &mut Group<'_>) -> Result<(), ParquetError> {
        let bytes = |text: &String| ByteArray::from(text.as_bytes().to_vec());
        match self {
            Self::Text(cells) => {
                let cells: Vec<ByteArray> = cells.iter().map(bytes).collect();
                write::<ByteArrayType>(group, &cells, None)
            }
            Self::OptionalText(cells) => write_optional::<ByteArrayType>(
                group,
                cells.iter().map(|one| one.as_ref().map(bytes)),
            ),
            Self::Flag(cells) => write::<BoolType>(group, cells, None),
            Self::Short(cells) => write::<Int32Type>(group, cells, None),
            Self::Whole(cells) | Self::Instant(cells) => write::<Int64Type>(group, cells, None),
            Self::OptionalWhole(cells) => write_optional::<Int64Type>(group, cells.iter().copied()),
            Self::Number(cells) => write::<DoubleType>(group, cells, None),
            Self::OptionalNumber(cells) => {
                write_optional::<DoubleType>(group, cells.iter().copied())
            }
        }
    }
}

/// Writes a column in which cells may be missing. The level of a row shows whether it has one.
fn write_optional<T: DataType>(
    group: &mut Group<'_>,
    cells: impl Iterator<Item = Option<T::T>> + Clone,
) -> Result<(), ParquetError> {
    let levels: Vec<i16> = cells.clone().map(|cell| cell.is_some().into()).collect();
    let present: Vec<T::T> = cells.flatten().collect();
    write::<T>(group, &present, Some(&levels))
}

fn write<T: DataType>(
    group: &mut Group<'_>,
    cells: &[T::T],
    levels: Option<&[i16]>,
) -> Result<(), ParquetError> {
    let mut column = group.next_column()?.expect("a column of the schema for each that is written");
    column.typed::<T>().write_batch(cells, levels, None)?;
    column.close()
}
