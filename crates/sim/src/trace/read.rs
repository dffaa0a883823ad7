//! Reads a trace: bounded and strict, with line and column of every error.
//!
//! The reader only requires that every column can hold its value. The [checker](crate::check)
//! judges whether the schedule keeps the rules of the day.

use std::collections::HashMap;
use std::path::Path;

use csv::ByteRecord;
use vertifleet_core::{AircraftIx, Scenario, Time, VertiportIx};

use super::{CHARGE, FLIGHT_COST, columns};
use crate::{Trace, TraceError, TraceRow};

const MOST_BYTES: u64 = 256 << 20;
/// The memory of this many rows is about as large as the longest file.
const MOST_ROWS: usize = 4_000_000;

impl Trace {
    /// Reads the trace of a day of `scenario`.
    ///
    /// # Errors
    /// [`TraceError`] names file, line, column, value and rule.
    pub fn read(path: &Path, scenario: &Scenario) -> Result<Self, TraceError> {
        let bytes = vertifleet_core::read_at_most(path, MOST_BYTES)?;
        Self::from_csv(&bytes, scenario, &path.display().to_string())
    }

    /// Reads a trace from the text of its file; `origin` names the file in messages.
    ///
    /// # Errors
    /// [`TraceError`] names file, line, column, value and rule.
    pub fn from_csv(csv: &[u8], scenario: &Scenario, origin: &str) -> Result<Self, TraceError> {
        let csv = csv.strip_prefix("\u{feff}".as_bytes()).unwrap_or(csv);
        Reader::new(csv, scenario, origin).rows(MOST_ROWS)
    }
}

/// A file that is being read.
struct Reader<'a> {
    bytes: &'a [u8],
    origin: &'a str,
    columns: Vec<&'static str>,
    aircraft: HashMap<&'a [u8], AircraftIx>,
    vertiports: HashMap<&'a [u8], VertiportIx>,
}

impl<'a> Reader<'a> {
    fn new(bytes: &'a [u8], scenario: &'a Scenario, origin: &'a str) -> Self {
        let aircraft = scenario.aircraft.iter().map(|aircraft| aircraft.id.as_bytes());
        let vertiports = scenario.vertiports.iter().map(|vertiport| vertiport.id.as_bytes());
        Self {
            bytes,
            origin,
            columns: columns(scenario),
            aircraft: aircraft.zip(AircraftIx::all(scenario.aircraft.len())).collect(),
            vertiports: vertiports.zip(VertiportIx::all(scenario.vertiports.len())).collect(),
        }
    }

    fn rows(&self, most: usize) -> Result<Trace, TraceError> {
        let mut csv =
            csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(self.bytes);
        let mut record = ByteRecord::new();
        let mut next = |record: &mut ByteRecord| {
            csv.read_byte_record(record)
                .expect("bytes in memory, rows of any width: nothing to fail")
        };
        next(&mut record);
        self.header(&record)?;
        let mut rows = Vec::new();
        while next(&mut record) {
            if rows.len() == most {
                return Err(TraceError::TooManyRows {
                    origin: self.origin.to_owned(),
                    line: self.line(&record),
                    limit: most,
                });
            }
            rows.push(self.row(&record)?);
        }
        Ok(Trace { rows })
    }

    fn header(&self, record: &ByteRecord) -> Result<(), TraceError> {
        if record.iter().eq(self.columns.iter().map(|column| column.as_bytes())) {
            return Ok(());
        }
        let found = record.iter().map(String::from_utf8_lossy).collect::<Vec<_>>().join(",");
        Err(TraceError::WrongHeader {
            origin: self.origin.to_owned(),
            expected: self.columns.join(","),
            found: shortened(&found),
        })
    }

    fn row(&self, record: &ByteRecord) -> Result<TraceRow, TraceError> {
        if record.len() != self.columns.len() {
            return Err(TraceError::WrongWidth {
                origin: self.origin.to_owned(),
                line: self.line(record),
                expected: self.columns.len(),
                found: record.len(),
            });
        }
        let time = self.time(record, 0)?;
        let optional = |name| self.columns.iter().position(|&column| column == name);
        Ok(TraceRow {
            time,
            aircraft: self.id(record, 1, &self.aircraft, "aircraft")?,
            from: self.id(record, 2, &self.vertiports, "vertiports")?,
            to: self.id(record, 3, &self.vertiports, "vertiports")?,
            passengers: self.passengers(record, 4)?,
            revenue_usd: self.amount(record, 5)?,
            passenger_cost_usd: self.amount(record, 6)?,
            energy_kwh: self.amount(record, 7)?,
            energy_cost_usd: self.amount(record, 8)?,
            arrival: self.time(record, 9)?,
            ready: self.time(record, 10)?,
            flight_cost_usd: match optional(FLIGHT_COST) {
                Some(column) => self.amount(record, column)?,
                None => 0.0,
            },
            charge_kwh: match optional(CHARGE[0]) {
                Some(column) => self.amount(record, column)?,
                None => 0.0,
            },
            takeoff: match optional(CHARGE[1]) {
                Some(column) => self.time(record, column)?,
                None => time,
            },
        })
    }

    fn id<Ix: Copy>(
        &self,
        record: &ByteRecord,
        column: usize,
        known: &HashMap<&[u8], Ix>,
        list: &'static str,
    ) -> Result<Ix, TraceError> {
        known.get(&record[column]).copied().ok_or_else(|| TraceError::UnknownId {
            origin: self.origin.to_owned(),
            line: self.line(record),
            column: self.columns[column],
            found: shortened(&String::from_utf8_lossy(&record[column])),
            list,
        })
    }

    fn time(&self, record: &ByteRecord, column: usize) -> Result<Time, TraceError> {
        self.value(record, column, "a time as HH:MM:SS", |text| text.parse().ok())
    }

    fn passengers(&self, record: &ByteRecord, column: usize) -> Result<u16, TraceError> {
        self.value(record, column, "a whole number from 0 to 65535", |text| text.parse().ok())
    }

    fn amount(&self, record: &ByteRecord, column: usize) -> Result<f64, TraceError> {
        self.value(record, column, "a finite number, at least 0", |text| {
            text.parse().ok().filter(|number: &f64| number.is_finite() && *number >= 0.0)
        })
    }

    fn value<T>(
        &self,
        record: &ByteRecord,
        column: usize,
        rule: &'static str,
        read: impl FnOnce(&str) -> Option<T>,
    ) -> Result<T, TraceError> {
        let bytes = &record[column];
        std::str::from_utf8(bytes).ok().and_then(read).ok_or_else(|| TraceError::WrongValue {
            origin: self.origin.to_owned(),
            line: self.line(record),
            column: self.columns[column],
            rule,
            found: shortened(&String::from_utf8_lossy(bytes)),
        })
    }

    /// The line on which a record starts. It is counted here, because the parser's own count lags
    /// behind where the parser skips empty lines or the second half of a CR LF.
    fn line(&self, record: &ByteRecord) -> usize {
        let position = record.position().map_or(0, csv::Position::byte);
        let mut start =
            usize::try_from(position).map_or(self.bytes.len(), |at| at.min(self.bytes.len()));
        start +=
            self.bytes[start..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
        self.bytes[..start].split(|&byte| byte == b'\n').count()
    }
}

/// At most 120 characters of a text, so that a broken file does not flood the screen.
fn shortened(text: &str) -> String {
    match text.char_indices().nth(120) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use vertifleet_core::{
        Aircraft, AircraftType, Charging, Day, Disturbances, Matrix, Operations, Time, TypeIx,
        Vertiport, VertiportIx,
    };

    use super::Reader;

    #[test]
    fn a_row_too_many_is_refused_with_its_line() {
        let hold = "06:00:00,A,V,V,0,0,0,0,0,06:00:00,06:15:00\n";
        let scenario = one_place().check("day").expect("a day within the rules");
        let csv = format!("{}\n{}", super::columns(&scenario).join(","), hold.repeat(3));
        let reader = Reader::new(csv.as_bytes(), &scenario, "day.csv");
        assert_eq!(reader.rows(3).expect("as many as there may be").rows.len(), 3);
        let error = reader.rows(2).expect_err("one too many");
        assert_eq!(error.to_string(), "day.csv: line 4: a trace has at most 2 rows");
    }

    fn one_place() -> Day {
        let start = Time::from_seconds(6 * 3600);
        Day {
            name: "day".to_owned(),
            seed: 1,
            operations: Operations {
                start,
                end: start,
                takeoff_s: 60,
                landing_s: 60,
                hold_s: 900,
                passenger_wait_s: 0,
                charging: Charging::ToFull,
            },
            vertiports: vec![Vertiport {
                id: "V".to_owned(),
                x_mi: 0.0,
                y_mi: 0.0,
                stands: 1,
                chargers: None,
                charger_kw: None,
                busy: false,
                degrees: None,
                stand_cost_usd: 0.0,
                charger_cost_usd: 0.0,
            }],
            aircraft_types: vec![AircraftType {
                id: "T".to_owned(),
                seats: 4,
                speed_mph: 60.0,
                battery_kwh: 100.0,
                energy_kwh_per_mi: 1.0,
                charge_kw: 60.0,
                self_discharge_per_h: 0.0,
                reserve_kwh: 0.0,
                turnaround_s: 0,
                charge_curve: None,
            }],
            aircraft: vec![Aircraft {
                id: "A".to_owned(),
                kind: TypeIx(0),
                at: VertiportIx(0),
                start_charge_kwh: None,
            }],
            distance_mi: Matrix::from_fn(1, |_, _| 0.0),
            corridors: None,
            fare_usd: Matrix::from_fn(1, |_, _| 0.0).into(),
            passenger_cost_usd: Matrix::from_fn(1, |_, _| 0.0),
            flight_cost_usd: Matrix::from_fn(1, |_, _| 0.0),
            aircraft_cost_usd: 0.0,
            periods: vec![start],
            demand: vec![Matrix::from_fn(1, |_, _| 0)],
            energy_price_usd: vec![0.2],
            disturbances: Disturbances::default(),
        }
    }
}
