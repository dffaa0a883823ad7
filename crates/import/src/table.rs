//! Small tables, CSV or Parquet, read whole and row by row. Trip records, which may be much longer,
//! have separate readers.

use bytes::Bytes;
use csv::ByteRecord;

use crate::cell::Cell;
use crate::header::{Found, Header, Named};
use crate::input_file::InputFile;
use crate::parquet_file::{self, ParquetFile, Wanted};
use crate::parquet_meaning::Values;
use crate::row::{Column, Positions, Row};
use crate::source::{LONGEST_HEAD, is_binary, other_json, read_whole};
use crate::unread::UnreadColumns;
use crate::{Error, Warning};

/// Columns whose names are values of their rows, by their positions.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Wide<'a> {
    /// Those that are read.
    pub(crate) read: &'a [usize],
    /// Those that are only looked at.
    pub(crate) others: &'a [usize],
}

/// Calls `each` with every row of a table. Columns may have any order, and others are ignored;
/// `warnings` names those of them that probably should not be.
pub(crate) fn rows(
    file: &InputFile<'_>,
    columns: &[Column],
    warnings: &mut Vec<Warning>,
    each: impl FnMut(&Row<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    wide_rows(file, (columns, Wide::default()), warnings, each)
}

/// Calls `each` with every row of a table that has, instead of several rows, some columns, whose
/// values are in [`Row::wide`].
pub(crate) fn wide_rows(
    file: &InputFile<'_>,
    columns: (&[Column], Wide<'_>),
    warnings: &mut Vec<Warning>,
    mut each: impl FnMut(&Row<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let (origin, bytes) = (file.origin(), read_whole(file)?);
    if parquet_file::is_parquet(file, &bytes) {
        return parquet_rows(bytes.into(), &origin, columns, warnings, &mut each);
    }
    csv_rows(text(&bytes, "CSV", &origin)?, &origin, columns, warnings, &mut each)
}

/// The names of the columns of a table.
pub(crate) fn column_names(file: &InputFile<'_>) -> Result<Vec<String>, Error> {
    let (origin, bytes) = (file.origin(), read_whole(file)?);
    if parquet_file::is_parquet(file, &bytes) {
        return Ok(ParquetFile::open(Bytes::from(bytes), &origin)?.columns().to_vec());
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

/// The columns of a table, in the order of the cells of its rows.
struct Plan<'a> {
    origin: &'a str,
    columns: &'a [Column],
    /// The positions of the columns, if the table has them.
    found: Found,
    wide: Wide<'a>,
    unread: UnreadColumns<'a>,
}

impl<'a> Plan<'a> {
    fn new(
        header: Header<'a>,
        (columns, wide): (&'a [Column], Wide<'a>),
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, Error> {
        let found = header.find(columns, warnings)?;
        let read: Vec<usize> = found.places.iter().flatten().chain(wide.read).copied().collect();
        let unread = UnreadColumns::of(header.names, &read, columns);
        Ok(Self { origin: header.origin, columns, found, wide, unread })
    }

    /// The positions of the columns that are read.
    fn read(&self) -> impl Iterator<Item = Option<usize>> {
        self.found.places.iter().copied().chain(self.wide.read.iter().copied().map(Some))
    }

    /// The positions of the columns that are only looked at.
    fn shown(&self) -> impl Iterator<Item = usize> {
        self.wide.others.iter().copied().chain(self.unread.positions())
    }

    /// Calls `each` with a row.
    fn row(
        &mut self,
        cells: &[Cell<'_>],
        (positions, position): (Positions<'_>, usize),
        each: &mut dyn FnMut(&Row<'_>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let (cells, wide) = cells.split_at(self.found.places.len());
        let (wide, unread) = wide.split_at(self.wide.read.len() + self.wide.others.len());
        let (origin, columns) = (self.origin, self.columns);
        self.unread.add(unread);
        each(&Row { origin, positions, position, columns, cells, wide })
            .map_err(|error| self.unread.explained(error))
    }

    /// The warning of the columns that are not read.
    fn warning(&self) -> Option<Warning> {
        self.unread.warning(self.origin, &self.found.named)
    }
}

fn csv_rows(
    csv: &[u8],
    origin: &str,
    columns: (&[Column], Wide<'_>),
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
    let header = Header { origin, names: &names, of: Named::Columns };
    let mut plan = Plan::new(header, columns, warnings)?;
    let all: Vec<Option<usize>> = plan.read().chain(plan.shown().map(Some)).collect();
    while next(&mut record)? {
        // Spreadsheets write rows of empty cells below a table.
        if record.iter().all(|cell| cell.trim_ascii().is_empty()) {
            continue;
        }
        let begin = record.position().map_or(0, csv::Position::byte);
        let place = (Positions::Lines(csv), usize::try_from(begin).unwrap_or(usize::MAX));
        if record.iter().skip(names.len()).any(|cell| !cell.trim_ascii().is_empty()) {
            return Err(wrong(format!(
                "{} has {} values, and the header has {} columns: write decimals with a point, and put values with \
                 commas in quotes",
                place.0.place(place.1),
                record.len(),
                names.len(),
            )));
        }
        let value =
            |at: &Option<usize>| at.and_then(|at| record.get(at)).map_or(Cell::Missing, Cell::text);
        let cells: Vec<Cell<'_>> = all.iter().map(value).collect();
        plan.row(&cells, place, each)?;
    }
    warnings.extend(plan.warning());
    Ok(())
}

fn parquet_rows(
    bytes: Bytes,
    origin: &str,
    columns: (&[Column], Wide<'_>),
    warnings: &mut Vec<Warning>,
    each: &mut dyn FnMut(&Row<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let file = ParquetFile::open(bytes, origin)?;
    let header = Header { origin, names: file.columns(), of: Named::Columns };
    let mut plan = Plan::new(header, columns, warnings)?;
    let read = plan.read().map(|at| at.map(|column| Wanted { column, values: Values::Plain }));
    let all: Vec<Option<Wanted>> = read.chain(plan.shown().map(|at| file.any_values(at))).collect();
    let mut position = 0;
    for group in 0..file.groups() {
        file.rows(group, &all, &|| Ok(()), &mut |cells| {
            position += 1;
            plan.row(cells, (Positions::Rows, position), each)
        })?;
    }
    warnings.extend(plan.warning());
    Ok(())
}
