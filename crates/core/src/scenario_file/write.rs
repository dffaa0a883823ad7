//! Writes the scenario file, with one line for each entry or matrix row, and numbers as short as
//! they read back.

use std::fmt::Write;
use std::path::Path;

use crate::limits::number;
use crate::{
    Charging, Closure, CurvePoint, Degrees, Disturbances, Error, Matrix, Outage, OutputKind, Route,
    Scenario, TakeoffDelays, VertiportIx, write_atomically,
};

impl Scenario {
    /// The beginning of every scenario file that this program wrote, in any version of the format.
    pub const FILE: OutputKind = OutputKind {
        name: "scenario",
        skipped: 0,
        opening: "{\n  \"format\": \"vertifleet-scenario/",
    };

    /// Writes the scenario file whole or not at all.
    ///
    /// # Errors
    /// [`Error::CannotWrite`]; the former file is still there then.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        write_atomically(path.as_ref(), self.to_json().as_bytes())
    }

    /// The text of the scenario file. Reading it gives the same scenario, bit for bit.
    pub fn to_json(&self) -> String {
        let mut members = vec![
            ("format", text(super::FORMAT)),
            ("name", text(&self.name)),
            ("seed", self.seed.to_string()),
            ("operations", self.operations_json()),
            ("vertiports", self.vertiports_json()),
            ("aircraft_types", self.aircraft_types_json()),
            ("aircraft", self.aircraft_json()),
            ("distance_mi", table(&self.distance_mi, 2, |&cell| number(cell))),
            ("fare", self.fares_json()),
            ("passenger_cost", table(&self.passenger_cost_usd, 2, |&cell| number(cell))),
            ("periods", row(self.periods.iter().map(|period| format!("\"{period}\"")))),
            ("demand", passengers(&self.demand)),
            ("energy_price", row(self.energy_price_usd.iter().map(|&price| number(price)))),
        ];
        if self.has_flight_costs() {
            members.push(("flight_cost", table(&self.flight_cost_usd, 2, |&cell| number(cell))));
        }
        if self.aircraft_cost_usd != 0.0 {
            members.push(("aircraft_cost", number(self.aircraft_cost_usd)));
        }
        if let Some(corridors) = &self.corridors {
            let corridor = |route: &Route| format!("{{{}}}", self.route_json(*route));
            members.push(("corridors", lines(corridors.iter().map(corridor), 2)));
        }
        members.extend(self.disturbances_json());
        let members: Vec<String> =
            members.into_iter().map(|(name, value)| format!("  \"{name}\": {value}")).collect();
        format!("{{\n{}\n}}\n", members.join(",\n"))
    }

    fn fares_json(&self) -> String {
        let fares = |fares: &Matrix<f64>, indent| table(fares, indent, |&cell| number(cell));
        let tables = self.fare_usd.tables();
        if tables.clone().count() == 1 {
            return fares(self.fare_usd.in_period(0), 2);
        }
        lines(tables.map(|table| fares(table, 4)), 2)
    }

    fn operations_json(&self) -> String {
        let day = &self.operations;
        let wait = match day.passenger_wait_s {
            0 => String::new(),
            wait_s => format!(r#", "passenger_wait_s": {wait_s}"#),
        };
        let charging = match day.charging {
            Charging::ToFull => "",
            Charging::AsNeeded => r#", "charging": "as_needed""#,
        };
        format!(
            r#"{{"start": "{}", "end": "{}", "takeoff_s": {}, "landing_s": {}, "hold_s": {}{wait}{charging}}}"#,
            day.start, day.end, day.takeoff_s, day.landing_s, day.hold_s
        )
    }

    fn vertiports_json(&self) -> String {
        let vertiport = |vertiport: &crate::Vertiport| {
            let chargers =
                vertiport.chargers.map(|chargers| format!(r#", "chargers": {chargers}"#));
            let charger_kw =
                vertiport.charger_kw.map(|kw| format!(r#", "charger_kw": {}"#, number(kw)));
            let degrees = vertiport.degrees.map(|Degrees { latitude, longitude }| {
                let (latitude, longitude) = (number(latitude), number(longitude));
                format!(r#", "latitude": {latitude}, "longitude": {longitude}"#)
            });
            let cost = |name: &str, cost_usd: f64| {
                if cost_usd == 0.0 {
                    return String::new();
                }
                format!(r#", "{name}": {}"#, number(cost_usd))
            };
            format!(
                r#"{{"id": {}, "x_mi": {}, "y_mi": {}, "stands": {}{}{}, "busy": {}{}{}{}}}"#,
                text(&vertiport.id),
                number(vertiport.x_mi),
                number(vertiport.y_mi),
                vertiport.stands,
                chargers.unwrap_or_default(),
                charger_kw.unwrap_or_default(),
                vertiport.busy,
                degrees.unwrap_or_default(),
                cost("stand_cost", vertiport.stand_cost_usd),
                cost("charger_cost", vertiport.charger_cost_usd),
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
            if kind.reserve_kwh != 0.0 {
                write!(json, r#", "reserve_kwh": {}"#, number(kind.reserve_kwh))
                    .expect("a String takes any text");
            }
            if kind.turnaround_s != 0 {
                write!(json, r#", "turnaround_s": {}"#, kind.turnaround_s)
                    .expect("a String takes any text");
            }
            if let Some(curve) = &kind.charge_curve {
                let point = |point: &CurvePoint| {
                    format!("[{}, {}]", number(point.charge), number(point.kw))
                };
                let points = row(curve.points().iter().map(point));
                write!(json, r#", "charge_curve": {points}"#).expect("a String takes any text");
            }
            json + "}"
        };
        lines(self.aircraft_types.iter().map(kind), 2)
    }

    fn aircraft_json(&self) -> String {
        let aircraft = |aircraft: &crate::Aircraft| {
            let charge = aircraft.start_charge_kwh.map(|kwh| {
                let kwh = number(kwh);
                format!(r#", "start_charge_kwh": {kwh}"#)
            });
            format!(
                r#"{{"id": {}, "type": {}, "at": {}{}}}"#,
                text(&aircraft.id),
                text(&self.aircraft_types[aircraft.kind.at()].id),
                text(&self.vertiports[aircraft.at.at()].id),
                charge.unwrap_or_default()
            )
        };
        lines(self.aircraft.iter().map(aircraft), 2)
    }

    /// The members for the disturbances that the day has.
    fn disturbances_json(&self) -> Vec<(&'static str, String)> {
        let Disturbances { forecast, takeoff_delays, closures, outages } = &self.disturbances;
        let mut members = Vec::new();
        if let Some(forecast) = forecast {
            members.push(("forecast", passengers(forecast)));
        }
        if let Some(TakeoffDelays { slot_s, delay_s }) = takeoff_delays {
            let slots = delay_s.iter().map(|slot| row(slot.iter().map(u32::to_string)));
            let delays = lines(slots, 2);
            members.push((
                "takeoff_delays",
                format!(r#"{{"slot_s": {slot_s}, "delay_s": {delays}}}"#),
            ));
        }
        if !closures.is_empty() {
            let closure = |closure: &Closure| {
                let Closure { route, start, end, known } = *closure;
                let known = if known { r#", "known": true"# } else { "" };
                let route = self.route_json(route);
                format!(r#"{{{route}, "start": "{start}", "end": "{end}"{known}}}"#)
            };
            members.push(("closures", lines(closures.iter().map(closure), 2)));
        }
        if !outages.is_empty() {
            let outage = |outage: &Outage| {
                let aircraft = text(&self.aircraft[outage.aircraft.at()].id);
                let Outage { start, end, .. } = outage;
                format!(r#"{{"aircraft": {aircraft}, "start": "{start}", "end": "{end}"}}"#)
            };
            members.push(("outages", lines(outages.iter().map(outage), 2)));
        }
        members
    }

    /// The members of a route. The way back is written only if the route includes it.
    fn route_json(&self, route: Route) -> String {
        let id = |vertiport: VertiportIx| text(&self.vertiports[vertiport.at()].id);
        let back = if route.both_ways { r#", "both_ways": true"# } else { "" };
        format!(r#""from": {}, "to": {}{back}"#, id(route.from), id(route.to))
    }
}

/// The table of passengers of each period.
fn passengers(tables: &[Matrix<u32>]) -> String {
    lines(tables.iter().map(|period| table(period, 4, u32::to_string)), 2)
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
