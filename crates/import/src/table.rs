//! Small tables, CSV or Parquet, read whole and row by row. Trip records, which may be much longer,
//! have separate readers.

use bytes::Bytes;
use csv::ByteRecord;

use crate::cell::Cell;
use crate::header::{Header, Named};
use crate::input_file::InputFile;
use crate::parquet_file::{self, Wanted};
use crate::row::{Column, Positions, Row};
use crate::source::{LONGEST_HEAD, is_binary, other_json, read_whole};
use crate::splitting::UnreadColumns;
use crate::{Error, Warning};

/// Calls `each` with every row of a table. Columns may have any order, and others are ignored;
/// `warnings` has those of them that look like one that is read.
pub(crate) fn rows(
    file: &InputFile<'_>,
    columns: &[Column],
    warnings: &mut Vec<Warning>,
    mut each: impl FnMut(&Row<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let origin = file.origin();
    let bytes = read_whole(file)?;
    if parquet_file::is_parquet(file, &bytes) {
        return parquet_rows(bytes.into(), &origin, columns, warnings, &mut each);
    }
    csv_rows(text(&bytes, "CSV", &origin)?, &origin, (columns, &[]), warnings, &mut each)
}

/// Calls `each` with every row of a CSV table that has, instead of several rows, the columns at
/// some positions, whose values are in [`Row::wide`].
pub(crate) fn wide_rows(
    file: &InputFile<'_>,
    columns: (&[Column], &[usize]),
    warnings: &mut Vec<Warning>,
    mut each: impl FnMut(&Row<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let (origin, bytes) = (file.origin(), read_whole(file)?);
    csv_rows(text(&bytes, "CSV", &origin)?, &origin, columns, warnings, &mut each)
}

/// The names of the columns of a CSV table; none if the table is Parquet.
pub(crate) fn csv_names(file: &InputFile<'_>) -> Result<Vec<String>, Error> {
    let (origin, bytes) = (file.origin(), read_whole(file)?);
    if parquet_file::is_parquet(file, &bytes) {
        return Ok(Vec::new());
    }
    let text = text(&bytes, "CSV", &origin)?;
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(text);
    let mut record = ByteRecord::new();
    // A header that cannot be read is an error of the rows.
    let _ = reader.read_byte_record(&mut record);
    Ok(names(&record))
}

/// The names of the columns in the header of a CSV table.
fn names(header: &ByteRecord) -> Vec<String> {
    header.iter().map(|name| String::from_utf8_lossy(name.trim_ascii()).into_owned()).collect()
}

/// The text of a file that is not Parquet, without the byte order mark at its start. It has
/// something in it, and is UTF-8.
pub(crate) fn text<'a>(
    bytes: &'a [u8],
    kind: &'static str,
    origin: &str,
) -> Result<&'a [u8], Error> {
    let text = without_mark(bytes);
    if text.trim_ascii().is_empty() {
        let what = "rows or features, as it is empty";
        return Err(Error::Nothing { origin: origin.to_owned(), what });
    }
    if let [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [0, _, ..] | [_, 0, ..] = text {
        let problem = "its text is encoded in UTF-16; save it as UTF-8".to_owned();
        return Err(Error::NotParsed { origin: origin.to_owned(), kind, problem });
    }
    if kind == "CSV"
        && let Some(problem) = other_json(text)
    {
        let problem = problem.to_owned();
        return Err(Error::NotParsed { origin: origin.to_owned(), kind, problem });
    }
    if let Err(error) = str::from_utf8(text) {
        let (before, after) = text.split_at(error.valid_up_to());
        let line = before.split(|&byte| byte == b'\n').count() as u64;
        if is_binary(&text[..text.len().min(LONGEST_HEAD)]) {
            let problem =
                "it is no text: write it as CSV or Parquet, or a map as GeoJSON".to_owned();
            return Err(Error::NotParsed { origin: origin.to_owned(), kind, problem });
        }
        return Err(wrong_encoding(origin, kind, line, after[0]));
    }
    Ok(text)
}

/// The error that a line is not UTF-8.
pub(crate) fn wrong_encoding(origin: &str, kind: &'static str, line: u64, byte: u8) -> Error {
    let problem = format!(
        "line {line} is not UTF-8 (byte 0x{byte:02x}), perhaps Windows-1252; save it as UTF-8"
    );
    Error::NotParsed { origin: origin.to_owned(), kind, problem }
}

/// A text without the byte order mark at its start.
pub(crate) fn without_mark(text: &[u8]) -> &[u8] {
    text.strip_prefix("\u{feff}".as_bytes()).unwrap_or(text)
}

fn csv_rows(
    csv: &[u8],
    origin: &str,
    (columns, wide): (&[Column], &[usize]),
    warnings: &mut Vec<Warning>,
    each: &mut dyn FnMut(&Row<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(csv);
    let mut record = ByteRecord::new();
    let wrong =
        |problem: String| Error::NotParsed { origin: origin.to_owned(), kind: "CSV", problem };
    let mut next = |record: &mut ByteRecord| {
        reader.read_byte_record(record).map_err(|error| wrong(error.to_string()))
    };
    next(&mut record)?;
    let names = names(&record);
    let found = Header { origin, names: &names, of: Named::Columns }.find(columns, warnings)?;
    let mut unread = UnreadColumns::of(&names, (&found, wide), columns);
    while next(&mut record)? {
        // Spreadsheets write rows of empty cells below a table.
        if record.iter().all(|cell| cell.trim_ascii().is_empty()) {
            continue;
        }
        let value =
            |at: &Option<usize>| at.and_then(|at| record.get(at)).map_or(Cell::Missing, Cell::text);
        let cells: Vec<Cell<'_>> = found.iter().map(value).collect();
        let wide: Vec<Cell<'_>> = wide.iter().map(|at| value(&Some(*at))).collect();
        let begin = record.position().map_or(0, csv::Position::byte);
        let row = Row {
            origin,
            positions: Positions::Lines(csv),
            position: usize::try_from(begin).unwrap_or(usize::MAX),
            columns,
            cells: &cells,
            wide: &wide,
        };
        if record.iter().skip(names.len()).any(|cell| !cell.trim_ascii().is_empty()) {
            return Err(wrong(format!(
                "{} has {} values, and the header has {} columns: write decimals with a point, and put values with \
                 commas in quotes",
                row.place(),
                record.len(),
                names.len(),
            )));
        }
        unread.add(|at| record.get(at));
        each(&row).map_err(|error| unread.explained(error))?;
    }
    warnings.extend(unread.warnings(origin));
    Ok(())
}

fn parquet_rows(
    bytes: Bytes,
    origin: &str,
    columns: &[Column],
    warnings: &mut Vec<Warning>,
    each: &mut dyn FnMut(&Row<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let file = parquet_file::ParquetFile::open(bytes, origin)?;
    let header = Header { origin, names: file.columns(), of: Named::Columns };
    let found = header.find(columns, warnings)?;
    let wanted = found.iter().map(|at| at.map(|column| Wanted { column, moment: false }));
    let wanted: Vec<Option<Wanted>> = wanted.collect();
    let mut position = 0;
    for group in 0..file.groups() {
        file.rows(group, &wanted, &|| Ok(()), &mut |cells| {
            position += 1;
            each(&Row { origin, positions: Positions::Rows, position, columns, cells, wide: &[] })
        })?;
    }
    Ok(())
}
