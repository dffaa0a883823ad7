//! Rows of a Parquet file, with only the columns that are needed, row group by row group.
//!
//! Pages are decoded with the library's low-level column readers. A file in which pages, levels or
//! types contradict each other is an error here, also where the library would panic on it.

use std::panic::{AssertUnwindSafe, catch_unwind};

use parquet::basic::Compression;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{
    BoolType, ByteArray, ByteArrayType, DataType, DoubleType, FixedLenByteArray,
    FixedLenByteArrayType, FloatType, Int32Type, Int64Type, Int96, Int96Type,
};
use parquet::errors::ParquetError;
use parquet::file::reader::{ChunkReader, FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use crate::Error;
use crate::cell::Cell;
use crate::error::shortened;
use crate::input_file::InputFile;
use crate::parquet_meaning::{Meaning, Values, written};

/// The bytes with which a Parquet file begins.
pub(crate) const MAGIC: &[u8] = b"PAR1";
/// Rows that are decoded at once.
const BATCH: usize = 8_192;

/// Whether a file is Parquet, by its name or its first bytes.
pub(crate) fn is_parquet(file: &InputFile<'_>, first_bytes: &[u8]) -> bool {
    file.extension().as_deref() == Some("parquet") || first_bytes.starts_with(MAGIC)
}

/// An open Parquet file.
pub(crate) struct ParquetFile {
    reader: Box<dyn FileReader>,
    origin: String,
    /// The names of the columns that hold one value a row, and nothing for other columns.
    columns: Vec<String>,
}

/// A column to read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wanted {
    /// Its position in [`ParquetFile::columns`].
    pub(crate) column: usize,
    pub(crate) values: Values,
}

impl ParquetFile {
    /// Reads the description of a file.
    pub(crate) fn open(file: impl ChunkReader + 'static, origin: &str) -> Result<Self, Error> {
        guarded(origin, || {
            let reader =
                SerializedFileReader::new(file).map_err(|error| damaged(origin, &error))?;
            let schema = reader.metadata().file_metadata().schema_descr();
            let plain = |column: &ColumnDescriptor| {
                column.path().parts().len() == 1 && column.max_rep_level() == 0
            };
            let name = |column: &ColumnDescriptor| {
                if plain(column) { column.name().to_owned() } else { String::new() }
            };
            let columns = schema.columns().iter().map(|column| name(column)).collect();
            Ok(Self { reader: Box::new(reader), origin: origin.to_owned(), columns })
        })
    }

    /// The names of the columns. Columns that cannot be read have an empty name.
    pub(crate) fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Number of row groups.
    pub(crate) fn groups(&self) -> usize {
        self.reader.num_row_groups()
    }

    /// Number of rows of a row group, 0 if the number in the file is negative.
    pub(crate) fn group_rows(&self, group: usize) -> u64 {
        u64::try_from(self.reader.metadata().row_group(group).num_rows()).unwrap_or(0)
    }

    /// Refuses columns whose type or compression cannot be read.
    pub(crate) fn check(&self, wanted: &[Option<Wanted>]) -> Result<(), Error> {
        let schema = self.reader.metadata().file_metadata().schema_descr();
        guarded(&self.origin, || {
            for wanted in wanted.iter().flatten() {
                let column = schema.column(wanted.column);
                Meaning::of(&column, wanted.values)
                    .map_err(|error| error.in_column(&self.origin, column.name()))?;
                self.check_compression(wanted.column, column.name())?;
            }
            Ok(())
        })
    }

    fn check_compression(&self, column: usize, name: &str) -> Result<(), Error> {
        let groups = self.reader.metadata().row_groups();
        let compression = groups.first().map(|group| group.column(column).compression());
        let unknown = match compression {
            Some(Compression::BROTLI(_)) => "Brotli",
            Some(Compression::LZO) => "LZO",
            _ => return Ok(()),
        };
        let problem = format!(
            "its column {:?} is compressed with {unknown}: write it with Snappy, Zstandard, gzip or LZ4",
            shortened(name, 64)
        );
        Err(Error::NotParsed { origin: self.origin.clone(), kind: "Parquet", problem })
    }

    /// A column whose values are shown whatever their type, if they can be unpacked.
    pub(crate) fn any_values(&self, column: usize) -> Option<Wanted> {
        let can_be_unpacked = self.check_compression(column, "").is_ok();
        can_be_unpacked.then_some(Wanted { column, values: Values::Any })
    }

    /// Calls `each` with every row of a row group: one cell for each of the wanted columns. `pause`
    /// is called before each batch of rows and may end the reading.
    pub(crate) fn rows(
        &self,
        group: usize,
        wanted: &[Option<Wanted>],
        pause: &dyn Fn() -> Result<(), Error>,
        each: &mut dyn FnMut(&[Cell<'_>]) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.check(wanted)?;
        let (mut columns, mut left) = guarded(&self.origin, || self.batched(group, wanted))?;
        let count = columns.len();
        while left > 0 {
            pause()?;
            let rows = left.min(BATCH);
            guarded(&self.origin, || {
                let read = |column: &mut BatchedColumn| column.read(rows);
                columns
                    .iter_mut()
                    .flatten()
                    .try_for_each(read)
                    .map_err(|error| self.damaged(&error))
            })?;
            for row in 0..rows {
                let (mut few, mut many) = ([Cell::Missing; FEW_COLUMNS], Vec::new());
                let cells = if count <= FEW_COLUMNS {
                    &mut few[..count]
                } else {
                    many.resize(count, Cell::Missing);
                    &mut many[..]
                };
                for (cell, column) in cells.iter_mut().zip(&mut columns) {
                    *cell = column.as_mut().map_or(Cell::Missing, |column| column.next(row));
                }
                each(cells)?;
            }
            left -= rows;
        }
        Ok(())
    }

    /// The readers of the wanted columns of a row group, and its number of rows.
    fn batched(
        &self,
        group: usize,
        wanted: &[Option<Wanted>],
    ) -> Result<(Vec<Option<BatchedColumn>>, usize), Error> {
        let group = self.reader.get_row_group(group).map_err(|error| self.damaged(&error))?;
        let schema = self.reader.metadata().file_metadata().schema_descr();
        let batched = |Wanted { column, values }| {
            let descriptor = schema.column(column);
            let meaning = Meaning::of(&descriptor, values)
                .map_err(|error| error.in_column(&self.origin, descriptor.name()))?;
            let reader = group.get_column_reader(column).map_err(|error| self.damaged(&error))?;
            Ok(BatchedColumn::new(reader, &descriptor, meaning))
        };
        let columns = wanted.iter().map(|wanted| wanted.map(batched).transpose());
        let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        Ok((columns.collect::<Result<_, Error>>()?, rows))
    }

    fn damaged(&self, error: &ParquetError) -> Error {
        damaged(&self.origin, error)
    }
}

/// Columns of trip records, whose cells need no memory.
const FEW_COLUMNS: usize = 8;

/// The typed reader of a column with a batch of its values, packed without the missing ones.
enum Typed {
    Bool(ColumnReaderImpl<BoolType>, Vec<bool>),
    Int32(ColumnReaderImpl<Int32Type>, Vec<i32>),
    Int64(ColumnReaderImpl<Int64Type>, Vec<i64>),
    Int96(ColumnReaderImpl<Int96Type>, Vec<Int96>),
    Float(ColumnReaderImpl<FloatType>, Vec<f32>),
    Double(ColumnReaderImpl<DoubleType>, Vec<f64>),
    Bytes(ColumnReaderImpl<ByteArrayType>, Vec<ByteArray>),
    Fixed(ColumnReaderImpl<FixedLenByteArrayType>, Vec<FixedLenByteArray>),
}

/// A column that is read in batches.
struct BatchedColumn {
    values: Typed,
    meaning: Meaning,
    /// The level of rows that have a value; 0 if every row has one.
    present: i16,
    levels: Vec<i16>,
    /// Position of the next value in the batch.
    next: usize,
}

impl BatchedColumn {
    fn new(reader: ColumnReader, descriptor: &ColumnDescriptor, meaning: Meaning) -> Self {
        let values = match reader {
            ColumnReader::BoolColumnReader(reader) => Typed::Bool(reader, Vec::new()),
            ColumnReader::Int32ColumnReader(reader) => Typed::Int32(reader, Vec::new()),
            ColumnReader::Int64ColumnReader(reader) => Typed::Int64(reader, Vec::new()),
            ColumnReader::Int96ColumnReader(reader) => Typed::Int96(reader, Vec::new()),
            ColumnReader::FloatColumnReader(reader) => Typed::Float(reader, Vec::new()),
            ColumnReader::DoubleColumnReader(reader) => Typed::Double(reader, Vec::new()),
            ColumnReader::ByteArrayColumnReader(reader) => Typed::Bytes(reader, Vec::new()),
            ColumnReader::FixedLenByteArrayColumnReader(reader) => Typed::Fixed(reader, Vec::new()),
        };
        let present = descriptor.max_def_level();
        Self { values, meaning, present, levels: Vec::new(), next: 0 }
    }

    /// Reads the next `rows` rows.
    fn read(&mut self, rows: usize) -> Result<(), ParquetError> {
        self.next = 0;
        let levels = &mut self.levels;
        let (read, values) = match &mut self.values {
            Typed::Bool(reader, values) => fill(reader, values, levels, rows),
            Typed::Int32(reader, values) => fill(reader, values, levels, rows),
            Typed::Int64(reader, values) => fill(reader, values, levels, rows),
            Typed::Int96(reader, values) => fill(reader, values, levels, rows),
            Typed::Float(reader, values) => fill(reader, values, levels, rows),
            Typed::Double(reader, values) => fill(reader, values, levels, rows),
            Typed::Bytes(reader, values) => fill(reader, values, levels, rows),
            Typed::Fixed(reader, values) => fill(reader, values, levels, rows),
        }?;
        let present = if self.present == 0 {
            read
        } else {
            levels.iter().filter(|&&level| level == self.present).count()
        };
        if read == rows && present == values && (self.present == 0 || levels.len() == rows) {
            return Ok(());
        }
        Err(ParquetError::General("a column has fewer values than the file has rows".to_owned()))
    }

    /// The value of the next row of the batch, which is its row `row`.
    #[inline]
    fn next(&mut self, row: usize) -> Cell<'_> {
        if self.present != 0 && self.levels[row] != self.present {
            return Cell::Missing;
        }
        let at = self.next;
        self.next += 1;
        match &self.values {
            Typed::Bool(_, values) => Cell::Text(if values[at] { b"true" } else { b"false" }),
            Typed::Int32(_, values) => self.meaning.of_whole(values[at].into()),
            Typed::Int64(_, values) => self.meaning.of_whole(values[at]),
            Typed::Int96(_, values) => self.meaning.of_seconds(values[at].to_seconds()),
            Typed::Float(_, values) => Cell::Number(written(values[at])),
            Typed::Double(_, values) => Cell::Number(values[at]),
            Typed::Bytes(_, values) => self.meaning.of_bytes(values[at].data()),
            Typed::Fixed(_, values) => self.meaning.of_bytes(values[at].data()),
        }
    }
}

/// Reads a batch and returns the number of rows and the number of values.
fn fill<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    values: &mut Vec<T::T>,
    levels: &mut Vec<i16>,
    rows: usize,
) -> Result<(usize, usize), ParquetError> {
    values.clear();
    levels.clear();
    let (read, _, _) = reader.read_records(rows, Some(levels), None, values)?;
    Ok((read, values.len()))
}

fn damaged(origin: &str, error: &ParquetError) -> Error {
    Error::NotParsed {
        origin: origin.to_owned(),
        kind: "Parquet",
        problem: shortened(&error.to_string(), 300),
    }
}

/// Turns a panic of the library into an error, since some damaged files make it panic. What is
/// under way then is dropped, so that nothing half-done is used.
fn guarded<T>(origin: &str, read: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| {
        Err(damaged(origin, &ParquetError::General("the file is damaged".to_owned())))
    })
}
