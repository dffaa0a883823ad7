//! Writing a trace: whole or not at all, ids as in the scenario.

use std::io::{self, Write};
use std::path::Path;

use vertifleet_core::Scenario;

use super::COLUMNS;
use crate::{Trace, TraceError, TraceRow};

impl Trace {
    /// Writes the trace as a CSV file that is there whole or not at all.
    ///
    /// # Errors
    /// [`TraceError::Core`] (V102); what was there before is still there then.
    ///
    /// # Panics
    /// If a row names an aircraft or a vertiport that `scenario` does not have.
    pub fn write(&self, scenario: &Scenario, path: &Path) -> Result<(), TraceError> {
        Ok(vertifleet_core::write_atomically(path, self.to_csv(scenario).as_bytes())?)
    }

    /// The trace as the text of its CSV file.
    ///
    /// # Panics
    /// If a row names an aircraft or a vertiport that `scenario` does not have.
    pub fn to_csv(&self, scenario: &Scenario) -> String {
        let mut csv = Vec::new();
        self.write_rows(scenario, &mut csv).expect("memory takes every byte");
        String::from_utf8(csv).expect("ids, numbers and times are all text")
    }

    fn write_rows(&self, scenario: &Scenario, to: impl Write) -> io::Result<()> {
        let mut csv = csv::Writer::from_writer(to);
        csv.write_record(COLUMNS)?;
        for row in &self.rows {
            write_row(row, scenario, &mut csv)?;
        }
        csv.flush()
    }
}

fn write_row(
    row: &TraceRow,
    scenario: &Scenario,
    csv: &mut csv::Writer<impl Write>,
) -> io::Result<()> {
    csv.write_field(row.time.to_string())?;
    csv.write_field(&scenario.aircraft[row.aircraft.at()].id)?;
    csv.write_field(&scenario.vertiports[row.from.at()].id)?;
    csv.write_field(&scenario.vertiports[row.to.at()].id)?;
    csv.write_field(row.passengers.to_string())?;
    // `{}` gives an `f64` the fewest digits that read back as itself.
    for number in [row.revenue_usd, row.passenger_cost_usd, row.energy_kwh, row.energy_cost_usd] {
        csv.write_field(number.to_string())?;
    }
    csv.write_field(row.arrival.to_string())?;
    csv.write_field(row.ready.to_string())?;
    // An empty record after fields only ends the line.
    csv.write_record(None::<&[u8]>)?;
    Ok(())
}
