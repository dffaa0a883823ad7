//! The scenario file, written: one entry or matrix row a line, numbers as short as they read back.

use std::fmt::Write;
use std::path::Path;

use crate::limits::number;
use crate::{Error, Matrix, Scenario, files, read};

impl Scenario {
    /// Writes the scenario file whole or not at all.
    ///
    /// # Errors
    /// [`Error::CannotWrite`]; what was there before is still there then.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        files::write_atomically(path.as_ref(), self.to_json().as_bytes())
    }

    /// The text of the scenario file. Read again, it gives the same scenario, bit for bit.
    pub fn to_json(&self) -> String {
        let members = [
            ("format", text(read::FORMAT)),
            ("name", text(&self.name)),
            ("seed", self.seed.to_string()),
            ("operations", self.operations_json()),
            ("vertiports", self.vertiports_json()),
            ("aircraft_types", self.aircraft_types_json()),
            ("aircraft", self.aircraft_json()),
            ("distance_mi", table(&self.distance_mi, 2, |&cell| number(cell))),
            ("fare", table(&self.fare_usd, 2, |&cell| number(cell))),
            ("passenger_cost", table(&self.passenger_cost_usd, 2, |&cell| number(cell))),
            ("periods", row(self.periods.iter().map(|period| format!("\"{period}\"")))),
            ("demand", lines(self.demand.iter().map(|day| table(day, 4, u32::to_string)), 2)),
            ("energy_price", row(self.energy_price_usd.iter().map(|&price| number(price)))),
        ];
        let members: Vec<String> =
            members.into_iter().map(|(name, value)| format!("  \"{name}\": {value}")).collect();
        format!("{{\n{}\n}}\n", members.join(",\n"))
    }

    fn operations_json(&self) -> String {
        let day = &self.operations;
        format!(
            r#"{{"start": "{}", "end": "{}", "takeoff_s": {}, "landing_s": {}, "hold_s": {}}}"#,
            day.start, day.end, day.takeoff_s, day.landing_s, day.hold_s
        )
    }

    fn vertiports_json(&self) -> String {
        let vertiport = |vertiport: &crate::Vertiport| {
            format!(
                r#"{{"id": {}, "x_mi": {}, "y_mi": {}, "stands": {}, "busy": {}}}"#,
                text(&vertiport.id),
                number(vertiport.x_mi),
                number(vertiport.y_mi),
                vertiport.stands,
                vertiport.busy
            )
        };
        lines(self.vertiports.iter().map(vertiport), 2)
    }

    fn aircraft_types_json(&self) -> String {
        let kind = |kind: &crate::AircraftType| {
            let mut json = format!(r#"{{"id": {}, "seats": {}"#, text(&kind.id), kind.seats);
            for (name, value) in [
                ("speed_mph", kind.speed_mph),
                ("battery_kwh", kind.battery_kwh),
                ("energy_kwh_per_mi", kind.energy_kwh_per_mi),
                ("charge_kw", kind.charge_kw),
                ("self_discharge_per_h", kind.self_discharge_per_h),
            ] {
                write!(json, r#", "{name}": {}"#, number(value)).expect("a String takes any text");
            }
            json + "}"
        };
        lines(self.aircraft_types.iter().map(kind), 2)
    }

    fn aircraft_json(&self) -> String {
        let aircraft = |aircraft: &crate::Aircraft| {
            format!(
                r#"{{"id": {}, "type": {}, "at": {}}}"#,
                text(&aircraft.id),
                text(&self.aircraft_types[aircraft.kind.at()].id),
                text(&self.vertiports[aircraft.at.at()].id)
            )
        };
        lines(self.aircraft.iter().map(aircraft), 2)
    }
}

/// A JSON string.
fn text(plain: &str) -> String {
    serde_json::Value::from(plain).to_string()
}

/// A JSON list on one line.
fn row(entries: impl Iterator<Item = String>) -> String {
    format!("[{}]", entries.collect::<Vec<_>>().join(", "))
}

/// A JSON list with a line for each entry; its brackets are indented by `indent`.
fn lines(entries: impl Iterator<Item = String>, indent: usize) -> String {
    let entries: Vec<String> =
        entries.map(|entry| format!("{:width$}{entry}", "", width = indent + 2)).collect();
    format!("[\n{}\n{:indent$}]", entries.join(",\n"), "")
}

/// A table with a line for each row.
fn table<T>(table: &Matrix<T>, indent: usize, mut cell: impl FnMut(&T) -> String) -> String {
    lines(table.rows().map(|cells| row(cells.iter().map(&mut cell))), indent)
}
