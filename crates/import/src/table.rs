//! Small tables, CSV or Parquet, read whole and row by row. Trip records, which may be much longer, have readers of
//! their own.

use std::path::Path;

use bytes::Bytes;
use csv::ByteRecord;
use vertifleet_core::read_at_most;

use crate::Error;
use crate::cell::Cell;
use crate::error::{did_you_mean, shortened};
use crate::parquet_file::{self, Wanted};
use crate::row::{Column, Need, Positions, Row};
use crate::vertiports::printable;

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
    csv_rows(text(&bytes, "CSV", &origin)?, &origin, columns, &mut each)
}

/// The text of a file that is not Parquet, without the byte order mark at its start. It has something in it, and one byte
/// for each plain letter.
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
    Ok(text)
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
    let of = |need: Need| wanted.iter().zip(&places).filter(move |(column, _)| column.need == need);
    let used: Vec<&str> = places.iter().flatten().map(|&at| found[at].as_str()).collect();
    let missing = |like: &[&str]| {
        let column = like.join(" or ");
        Missing { column: &column, like, found, used: &used, remedy: None }.error(origin)
    };
    if let Some((column, _)) = of(Need::Required).find(|(_, at)| at.is_none()) {
        return Err(missing(&column.names[..1]));
    }
    let one_of: Vec<&str> = of(Need::OneOf).map(|(column, _)| column.names[0]).collect();
    if !one_of.is_empty() && of(Need::OneOf).all(|(_, at)| at.is_none()) {
        return Err(missing(&one_of));
    }
    Ok(places)
}

/// A column that is needed and missing.
pub(crate) struct Missing<'a> {
    /// Which column that is, in words.
    pub(crate) column: &'a str,
    /// The names to which similar ones are looked for.
    pub(crate) like: &'a [&'a str],
    /// The columns of the file.
    pub(crate) found: &'a [String],
    /// Those of them that hold something else that is needed, so that they were not meant to be this one.
    pub(crate) used: &'a [&'a str],
    /// What else may be done about it.
    pub(crate) remedy: Option<&'a str>,
}

impl Missing<'_> {
    /// The error that names the column that is missing, and those that are there.
    pub(crate) fn error(&self, origin: &str) -> Error {
        const SHOWN: usize = 30;
        let columns: Vec<&String> = self.found.iter().filter(|name| !name.is_empty()).collect();
        let shown = |name: &&String| shortened(&printable(name), 40);
        let mut names: Vec<String> = columns.iter().take(SHOWN).map(shown).collect();
        if columns.len() > SHOWN {
            names.push("...".to_owned());
        }
        Error::MissingColumn {
            origin: origin.to_owned(),
            column: self.column.to_owned(),
            found: names.join(", "),
            hint: other_separator(self.found).or_else(|| self.hint()),
        }
    }

    fn hint(&self) -> Option<String> {
        let free = self.found.iter().map(String::as_str).filter(|name| !self.used.contains(name));
        let meant = self.like.iter().find_map(|column| meant(column, free.clone()));
        match (meant, self.remedy) {
            (Some(meant), Some(remedy)) => Some(format!("{meant} {remedy}")),
            (meant, remedy) => meant.or_else(|| remedy.map(str::to_owned)),
        }
    }
}

/// A hint that names the separator of a header that has no commas.
fn other_separator(found: &[String]) -> Option<String> {
    let [header] = found else { return None };
    let separators = [(';', "semicolons"), ('\t', "tabs"), ('|', "vertical bars")];
    let (_, name) = separators.into_iter().find(|(separator, _)| header.contains(*separator))?;
    Some(format!(
        "its columns are separated by {name}: save it with commas between the columns, and with decimal points"
    ))
}

/// A hint that names the column that was probably meant: one with nearly this name, or with its beginning, as `fare`
/// for `fare_usd`.
fn meant<'a>(column: &str, found: impl Iterator<Item = &'a str> + Clone) -> Option<String> {
    let begins = |name: &&str| {
        let begin = column.get(..name.len());
        name.len() > 2 && begin.is_some_and(|begin| begin.eq_ignore_ascii_case(name))
    };
    let begin = found.clone().find(begins);
    did_you_mean(column, found).or_else(|| did_you_mean(begin?, begin))
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
        // Spreadsheets write rows of empty cells below a table.
        if record.iter().all(|cell| cell.trim_ascii().is_empty()) {
            continue;
        }
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
