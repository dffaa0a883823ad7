//! Small tables, CSV or Parquet, read whole and row by row. Trip records, which may be much longer, have readers of
//! their own.

use std::path::Path;

use bytes::Bytes;
use csv::ByteRecord;
use vertifleet_core::read_at_most;

use crate::Error;
use crate::cell::Cell;
use crate::error::did_you_mean;
use crate::parquet_file::{self, Wanted};
use crate::row::{Column, Positions, Row};

/// The longest file that is read whole.
pub(crate) const LONGEST: u64 = 16 << 20;

/// Calls `each` with every row of a table and returns their number. Columns may have any order, and others are
/// ignored.
pub(crate) fn rows(
    path: &Path,
    columns: &[Column],
    mut each: impl FnMut(&Row<'_>) -> Result<(), Error>,
) -> Result<usize, Error> {
    let origin = path.display().to_string();
    let bytes = read_at_most(path, LONGEST)?;
    if parquet_file::is_parquet(path, &bytes) {
        return parquet_rows(bytes.into(), &origin, columns, &mut each);
    }
    csv_rows(without_mark(&bytes), &origin, columns, &mut each)
}

/// A text without the byte order mark at its start.
pub(crate) fn without_mark(text: &[u8]) -> &[u8] {
    text.strip_prefix("\u{feff}".as_bytes()).unwrap_or(text)
}

/// Finds each of the wanted columns among those of the file. Capitals and small letters are the same.
pub(crate) fn find_columns(
    wanted: &[Column],
    found: &[String],
    origin: &str,
) -> Result<Vec<Option<usize>>, Error> {
    let position = |name: &&str| found.iter().position(|has| has.eq_ignore_ascii_case(name));
    let places: Vec<Option<usize>> =
        wanted.iter().map(|column| column.names.iter().find_map(position)).collect();
    let absent = wanted.iter().zip(&places).find(|(column, at)| column.required && at.is_none());
    if let Some((column, _)) = absent {
        let used: Vec<&str> = places.iter().flatten().map(|&at| found[at].as_str()).collect();
        return Err(missing(column.names[0], found, &used, origin));
    }
    Ok(places)
}

/// An error that says which column is missing, and which there are. Those in use were not meant to be this one.
pub(crate) fn missing(column: &str, found: &[String], used: &[&str], origin: &str) -> Error {
    const SHOWN: usize = 30;
    let named = found.iter().filter(|name| !name.is_empty());
    let mut names: Vec<String> =
        named.clone().take(SHOWN).map(|name| crate::error::shortened(name, 40)).collect();
    if named.count() > SHOWN {
        names.push("...".to_owned());
    }
    let others = found.iter().map(String::as_str).filter(|name| !used.contains(name));
    Error::MissingColumn {
        origin: origin.to_owned(),
        column: column.to_owned(),
        found: names.join(", "),
        hint: did_you_mean(column, others),
    }
}

fn csv_rows(
    csv: &[u8],
    origin: &str,
    columns: &[Column],
    each: &mut dyn FnMut(&Row<'_>) -> Result<(), Error>,
) -> Result<usize, Error> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(csv);
    let mut record = ByteRecord::new();
    let mut next = |record: &mut ByteRecord| {
        reader.read_byte_record(record).map_err(|error| Error::NotParsed {
            origin: origin.to_owned(),
            kind: "CSV",
            problem: error.to_string(),
        })
    };
    next(&mut record)?;
    let header: Vec<String> =
        record.iter().map(|name| String::from_utf8_lossy(name.trim_ascii()).into_owned()).collect();
    let found = find_columns(columns, &header, origin)?;
    let mut count = 0;
    while next(&mut record)? {
        let value =
            |at: &Option<usize>| at.and_then(|at| record.get(at)).map_or(Cell::Missing, Cell::text);
        let cells: Vec<Cell<'_>> = found.iter().map(value).collect();
        let begin = record.position().map_or(0, csv::Position::byte);
        each(&Row {
            origin,
            positions: Positions::Lines(csv),
            position: usize::try_from(begin).unwrap_or(usize::MAX),
            columns,
            cells: &cells,
        })?;
        count += 1;
    }
    Ok(count)
}

fn parquet_rows(
    bytes: Bytes,
    origin: &str,
    columns: &[Column],
    each: &mut dyn FnMut(&Row<'_>) -> Result<(), Error>,
) -> Result<usize, Error> {
    let file = parquet_file::ParquetFile::open(bytes, origin)?;
    let found = find_columns(columns, file.columns(), origin)?;
    let wanted = found.iter().map(|at| at.map(|column| Wanted { column, moment: false }));
    let wanted: Vec<Option<Wanted>> = wanted.collect();
    let mut count = 0;
    for group in 0..file.groups() {
        file.rows(group, &wanted, &|| Ok(()), &mut |cells| {
            count += 1;
            each(&Row { origin, positions: Positions::Rows, position: count, columns, cells })
        })?;
    }
    Ok(count)
}
