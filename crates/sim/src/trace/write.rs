//! Writes a trace, whole or not at all, with the ids of the scenario.

use std::io::{self, Write};
use std::path::Path;

use vertifleet_core::{Charging, OutputKind, Scenario};

use super::columns;
use crate::{Trace, TraceError, TraceRow};

impl Trace {
    /// The beginning of every trace that this program wrote.
    pub const FILE: OutputKind = OutputKind {
        name: "trace",
        skipped: 0,
        // On days with flight costs, and on days that charge as needed, more columns follow.
        opening: "time,aircraft,from,to,passengers,revenue,passenger_cost,energy_kwh,energy_cost,arrival,ready",
    };

    /// Writes the trace as a CSV file, whole or not at all.
    ///
    /// # Errors
    /// [`TraceError::Core`] (V102); the former file is still there then.
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
        csv.write_record(columns(scenario))?;
        let with_flight_costs = scenario.has_flight_costs();
        let with_charge = scenario.operations.charging == Charging::AsNeeded;
        for row in &self.rows {
            write_row(row, scenario, &mut csv)?;
            if with_flight_costs {
                csv.write_field(row.flight_cost_usd.to_string())?;
            }
            if with_charge {
                csv.write_field(row.charge_kwh.to_string())?;
                csv.write_field(row.takeoff.to_string())?;
            }
            // An empty record after fields only ends the line.
            csv.write_record(None::<&[u8]>)?;
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
    // `{}` writes an `f64` in the fewest digits that read back as the same number.
    for number in [row.revenue_usd, row.passenger_cost_usd, row.energy_kwh, row.energy_cost_usd] {
        csv.write_field(number.to_string())?;
    }
    csv.write_field(row.arrival.to_string())?;
    csv.write_field(row.ready.to_string())?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use vertifleet_core::{DaySeed, Matrix, Network};

    use crate::Trace;

    #[test]
    fn a_written_trace_is_known_again() {
        let network = Network::shipped("paper").expect("a shipped network");
        let day = network.draw(DaySeed::comparison(1).expect("a seed"));
        assert_eq!(Trace::default().to_csv(&day), format!("{}\n", Trace::FILE.opening));
        let mut costly = day.into_day();
        costly.flight_cost_usd = Matrix::from_fn(costly.vertiports.len(), |_, _| 1.0);
        let costly = costly.check("a day with flight costs").expect("a day within the rules");
        let header = format!("{},flight_cost\n", Trace::FILE.opening);
        assert_eq!(Trace::default().to_csv(&costly), header);
    }
}
