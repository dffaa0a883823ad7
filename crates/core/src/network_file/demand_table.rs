//! A table of demand in the folder of a network file: CSV with the columns period, from, to and
//! passengers, as a spreadsheet writes it.
//!
//! The text of a network is complete, so that a copy of it draws the same days elsewhere. The rows
//! of the table therefore replace the member that names it, and later code does not use the table.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::Path;

use csv::ByteRecord;

use crate::demand_model::RawHourlyDemand;
use crate::parse::{shortened, without_mark};
use crate::paths::origin;
use crate::{Error, FormatError, Time, input, limits};

const COLUMNS: [&str; 4] = ["period", "from", "to", "passengers"];

/// Returns the text of a network file with the rows of the file `table` put into it; `raw` is the
/// hourly demand in that text, and `vertiports` are the ids of its vertiports.
pub(crate) fn inlined(
    text: &str,
    raw: &RawHourlyDemand,
    table: &Path,
    vertiports: &[&str],
) -> Result<String, Error> {
    let csv = input::read_at_most(table, input::LONGEST_TABLE)?;
    let reader = Reader {
        csv: without_mark(&csv),
        periods: raw.periods.iter().copied().zip(0..).collect(),
        vertiports: vertiports.iter().map(|id| id.as_bytes()).zip(0..).collect(),
    };
    let pairs = reader.pairs().map_err(|error| error.in_file(&origin(table)))?;
    let pairs = pairs.iter().map(|pair| pair_value(pair, vertiports)).collect();
    let mut file: toml::Table = toml::from_str(text).expect("the text has been read before");
    if let Some(toml::Value::Table(hourly)) = file.get_mut("hourly_demand") {
        hourly.remove("table");
        hourly.insert("pairs".to_owned(), toml::Value::Array(pairs));
    }
    Ok(toml::to_string(&file).expect("what was read can be written"))
}

/// The mean passengers of a pair by period. The pair is given by the positions of its vertiports.
struct Pair {
    ends: (usize, usize),
    passengers: Vec<f64>,
}

/// A pair as it is written in a network file. Whole numbers are written without a fraction, which
/// keeps the text short.
#[expect(clippy::cast_possible_truncation, reason = "within bounds, and only whole numbers")]
fn pair_value(pair: &Pair, vertiports: &[&str]) -> toml::Value {
    let number = |&mean: &f64| {
        if mean.fract() == 0.0 { toml::Value::Integer(mean as i64) } else { mean.into() }
    };
    let mut value = toml::Table::new();
    value.insert("from".to_owned(), vertiports[pair.ends.0].into());
    value.insert("to".to_owned(), vertiports[pair.ends.1].into());
    let passengers = pair.passengers.iter().map(number).collect();
    value.insert("passengers".to_owned(), toml::Value::Array(passengers));
    value.into()
}

/// A table that is being read.
struct Reader<'a> {
    csv: &'a [u8],
    periods: HashMap<Time, usize>,
    vertiports: HashMap<&'a [u8], usize>,
}

impl Reader<'_> {
    /// The pairs of the table in the order in which they first appear.
    fn pairs(&self) -> Result<Vec<Pair>, FormatError> {
        let mut csv =
            csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(self.csv);
        let mut record = ByteRecord::new();
        let mut next = |record: &mut ByteRecord| {
            csv.read_byte_record(record)
                .expect("bytes in memory, rows of any width: nothing to fail")
        };
        next(&mut record);
        let header = Row { table: self, record: &record };
        if !record.iter().eq(COLUMNS.iter().map(|column| column.as_bytes())) {
            let rule = format!("{:?}", COLUMNS.join(","));
            return Err(header.wrong("the header", rule, &header.whole()));
        }
        let mut pairs: Vec<Pair> = Vec::new();
        let mut known = HashMap::new();
        let mut begins = HashMap::new();
        while next(&mut record) {
            let row = Row { table: self, record: &record };
            let (period, ends, mean) = row.read()?;
            if let Some(before) = begins.insert((period, ends), row.begin()) {
                return Err(FormatError::GivenTwice {
                    member: row.name(),
                    what: format!(
                        "the demand of the period and pair of line {}",
                        self.line(before)
                    ),
                });
            }
            let at = *known.entry(ends).or_insert_with(|| {
                pairs.push(Pair { ends, passengers: vec![0.0; self.periods.len()] });
                pairs.len() - 1
            });
            pairs[at].passengers[period] = mean;
        }
        Ok(pairs)
    }

    /// The line of the record that begins at a byte. It is counted here, because the parser's own
    /// count lags behind where the parser skips empty lines or the second half of a CR LF.
    fn line(&self, begin: usize) -> usize {
        let mut begin = begin.min(self.csv.len());
        begin += self.csv[begin..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
        self.csv[..begin].split(|&byte| byte == b'\n').count()
    }
}

/// A row of a table.
struct Row<'a> {
    table: &'a Reader<'a>,
    record: &'a ByteRecord,
}

impl Row<'_> {
    /// Reads the row's period, the ends of its pair, and the mean.
    fn read(&self) -> Result<(usize, (usize, usize), f64), FormatError> {
        if self.record.len() != COLUMNS.len() {
            let rule = format!("of {} values", COLUMNS.len());
            return Err(self.wrong("a row", rule, &self.whole()));
        }
        let (period, ends) = (self.period()?, (self.vertiport(1)?, self.vertiport(2)?));
        if ends.0 == ends.1 {
            return Err(FormatError::RouteToItself {
                member: self.name(),
                vertiport: self.text(1).into_owned(),
            });
        }
        let mean = self.text(3).parse().ok();
        let mean = mean.ok_or_else(|| self.wrong_value(3, "a number"))?;
        let member = || format!("{}: {}", self.name(), COLUMNS[3]);
        limits::DEMAND_MEAN.check(mean, member)?;
        Ok((period, ends, mean))
    }

    fn period(&self) -> Result<usize, FormatError> {
        let start: Option<Time> = self.text(0).parse().ok();
        let start = start.ok_or_else(|| self.wrong_value(0, "a time as HH:MM:SS"))?;
        let period = self.table.periods.get(&start).copied();
        period.ok_or_else(|| self.unknown(0, "starts of demand periods"))
    }

    fn vertiport(&self, column: usize) -> Result<usize, FormatError> {
        let position = self.table.vertiports.get(&self.record[column]).copied();
        position.ok_or_else(|| self.unknown(column, "vertiports"))
    }

    fn text(&self, column: usize) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.record[column])
    }

    fn whole(&self) -> String {
        self.record.iter().map(String::from_utf8_lossy).collect::<Vec<_>>().join(",")
    }

    fn begin(&self) -> usize {
        let byte = self.record.position().map_or(0, csv::Position::byte);
        usize::try_from(byte).unwrap_or(usize::MAX)
    }

    fn name(&self) -> String {
        format!("line {}", self.table.line(self.begin()))
    }

    fn unknown(&self, column: usize, list: &'static str) -> FormatError {
        FormatError::UnknownId {
            member: format!("{}: {}", self.name(), COLUMNS[column]),
            found: shortened(&self.text(column), 64),
            list,
        }
    }

    fn wrong_value(&self, column: usize, rule: &str) -> FormatError {
        self.wrong(COLUMNS[column], rule.to_owned(), &self.text(column))
    }

    fn wrong(&self, column: &'static str, rule: String, found: &str) -> FormatError {
        FormatError::TableRow {
            line: self.table.line(self.begin()),
            column,
            rule,
            found: shortened(found, 80),
        }
    }
}
