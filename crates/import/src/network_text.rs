//! The text of the network file: the base's text, in which the contents of the planner's files
//! replace those of the base.
//!
//! The text is edited, not rewritten, so that comments stay next to what they explain. Members that
//! belong to the vertiports or the demand of the base are removed or adapted, and a comment states
//! it.

use std::fmt::Write;
use std::path::Path;

use toml_edit::{
    Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value, value,
};
use vertifleet_core::{Network, Time};

use crate::corridors::Corridor;
use crate::energy_prices::EnergyPrices;
use crate::error::shortened;
use crate::hourly_demand::HourlyDemand;
use crate::tariffs::PairTariff;
use crate::vertiports::{ASSUMED_STANDS, Vertiport, Vertiports};
use crate::{Error, file_name, fleet};

/// The contents of a file, and its path.
pub(crate) struct FromFile<'a, T> {
    pub(crate) what: T,
    pub(crate) path: &'a Path,
}

/// Everything that the network file is made of, except for the demand.
pub(crate) struct NetworkText<'a> {
    pub(crate) base: &'a Network,
    pub(crate) name: &'a str,
    pub(crate) vertiports: FromFile<'a, &'a Vertiports>,
    pub(crate) corridors: Option<FromFile<'a, Vec<Corridor>>>,
    pub(crate) pair_tariffs: Option<FromFile<'a, Vec<PairTariff>>>,
    pub(crate) aircraft: Option<u32>,
    pub(crate) time_zone: Option<&'a str>,
    pub(crate) energy_prices: Option<FromFile<'a, EnergyPrices>>,
}

/// Other members of a base that refer to its demand or its vertiports, with the reason to leave
/// them out.
const LEFT_OUT: [(&[&str], &str); 11] = [
    (&["corridors"], "names its vertiports"),
    (&["closures"], "names its vertiports"),
    (&["tariffs", "pairs"], "names its vertiports"),
    (&["market", "elasticities"], "names its vertiports"),
    (&["market", "demand_factor"], "belongs to its demand"),
    (&["market", "reference"], "belongs to its demand"),
    (&["disturbances", "takeoff_delays"], "names its vertiports"),
    (&["disturbances", "closures"], "names its vertiports"),
    (&["feature_scales"], "states the typical sizes of its quantities"),
    (&["time_zone"], "is that of its place"),
    (&["start_stands"], "has a number for each of its vertiports"),
];

/// The members that an import writes itself, besides the demand.
const OWN: [&str; 3] = ["format", "name", "vertiports"];

/// The sections of a base whose members are inherited individually.
const SECTIONS: [&str; 3] = ["tariffs", "market", "disturbances"];

/// The demand models, of which a base has one.
const DEMAND_MODELS: [&str; 4] = ["demand", "daily_demand", "hourly_demand", "uniform_demand"];

impl NetworkText<'_> {
    /// Makes the text, and reads and checks it. `source` describes where the demand is from.
    pub(crate) fn network(
        &self,
        demand: &HourlyDemand,
        source: &[String],
    ) -> Result<(Network, String), Error> {
        let text = self.text(demand, source)?;
        let network = Network::from_toml(&text, "the imported network")?;
        Ok((network, text))
    }

    /// The members that are taken from the base, with what surges among them do to the demand and
    /// whether the fleet has another size.
    pub(crate) fn inherited(&self) -> Result<Vec<String>, Error> {
        let file = self.base_file()?;
        let mut members = Vec::new();
        let is_own = |name: &str| OWN.contains(&name) || DEMAND_MODELS.contains(&name);
        for (name, item) in file.iter().filter(|(name, _)| !is_own(name)) {
            match item.as_table_like().filter(|_| SECTIONS.contains(&name)) {
                Some(section) => {
                    members.extend(section.iter().map(|(of, _)| format!("{name}.{of}")));
                }
                None => members.push(name.to_owned()),
            }
        }
        let left_out = |member: &String| {
            LEFT_OUT.iter().any(|(path, _)| path.join(".") == *member)
                || self.energy_prices.is_some() && member == "tariffs.energy_price_usd_per_kwh"
        };
        members.retain(|member| !left_out(member));
        let surges = surges_percent(&file);
        for member in &mut members {
            if surges > 0.0 && member == "disturbances.forecast_error" {
                let _ = write!(member, " (its surges raise demand by {surges:.1} % in the mean)");
            }
            if let (Some(aircraft), "fleet") = (self.aircraft, member.as_str()) {
                let _ = write!(member, " (its shares of types, with {aircraft} aircraft)");
            }
        }
        Ok(members)
    }

    /// The base's text, to be edited.
    fn base_file(&self) -> Result<DocumentMut, Error> {
        without_head(self.base.toml()).parse().map_err(|error: toml_edit::TomlError| {
            Error::NotParsed {
                origin: self.base.name().to_owned(),
                kind: "TOML",
                problem: shortened(error.message(), 300),
            }
        })
    }

    fn text(&self, demand: &HourlyDemand, source: &[String]) -> Result<String, Error> {
        let mut file = self.base_file()?;
        let mut notes = Vec::new();
        for (path, why) in LEFT_OUT {
            if remove(file.as_table_mut(), path) {
                notes.push(format!("{}, which {why}", path.join(".")));
            }
        }
        for model in DEMAND_MODELS {
            file.remove(model);
        }
        file["name"] = value(self.name);
        self.put_time_zone(&mut file);
        if let Some(aircraft) = self.aircraft {
            fleet::resize(&mut file, aircraft, self.base.name());
        }
        self.put_vertiports(&mut file);
        self.put_corridors(&mut file);
        self.put_tariffs(&mut file, &demand.periods)?;
        let mut text = self.head(&notes);
        let _ = write!(text, "{file}");
        if !text.ends_with('\n') {
            text.push('\n');
        }
        self.put_demand(&mut text, demand, source);
        Ok(text)
    }

    /// The comment at the head of the file.
    fn head(&self, notes: &[String]) -> String {
        let base = self.base.name();
        let mut head = format!(
            "# The network {}, imported from files of a planner, which comments below name. Everything else is from the network\n\
             # {base}, with its comments.\n",
            shortened(self.name, 40).escape_debug(),
        );
        if !notes.is_empty() {
            let _ = writeln!(head, "#\n# Left out of {base}:");
        }
        for note in notes {
            let _ = writeln!(head, "# - {note}");
        }
        head.push('\n');
        head
    }

    fn put_time_zone(&self, file: &mut DocumentMut) {
        let Some(zone) = self.time_zone else { return };
        file.insert("time_zone", value(zone));
        if let Some(mut key) = file.key_mut("time_zone") {
            key.leaf_decor_mut().set_prefix("# The time zone that the import was given.\n");
        }
    }

    fn put_vertiports(&self, file: &mut DocumentMut) {
        let position = match file.remove("vertiports") {
            Some(Item::ArrayOfTables(tables)) => tables.get(0).and_then(Table::position),
            _ => None,
        };
        let FromFile { what: vertiports, path } = &self.vertiports;
        let mut comment = format!("\n# Vertiports from {}.\n", file_name(path));
        let assumed = vertiports.list.iter().filter(|vertiport| vertiport.stands.is_none()).count();
        if assumed > 0 {
            let _ = writeln!(
                comment,
                "# assumption: {ASSUMED_STANDS} stands at each of the {assumed} vertiports for which it gives none."
            );
        }
        let mut tables = ArrayOfTables::new();
        for vertiport in &vertiports.list {
            let mut table = vertiport_table(vertiport);
            table.set_position(position);
            table.decor_mut().set_prefix(std::mem::replace(&mut comment, "\n".to_owned()));
            tables.push(table);
        }
        file.insert("vertiports", Item::ArrayOfTables(tables));
    }

    fn put_corridors(&self, file: &mut DocumentMut) {
        let Some(FromFile { what: corridors, path }) = &self.corridors else { return };
        let entries = corridors.iter().map(|corridor| {
            let mut entry = self.ends(corridor.ends);
            entry.insert("both_ways", corridor.both_ways.into());
            entry.insert("length_mi", number((corridor.length_mi * 1e4).ceil() / 1e4));
            entry
        });
        let comment = format!(
            "\n# Corridors from {}, with the lengths of their lines between the vertiports, in miles.\n",
            file_name(path)
        );
        put(file.as_table_mut(), "corridors", list(entries), &comment);
    }

    fn put_tariffs(&self, file: &mut DocumentMut, periods: &[Time]) -> Result<(), Error> {
        let Some(item) = file.get_mut("tariffs") else { return Ok(()) };
        // Comments need separate lines, which an inline table does not have.
        if let Ok(table) = std::mem::take(item).into_table() {
            *item = Item::Table(table);
        }
        let Some(tariffs) = item.as_table_mut() else { return Ok(()) };
        for member in ["fare_factors", "energy_price_usd_per_kwh"] {
            self.adapt_to_periods(tariffs, member, periods);
        }
        if let Some(FromFile { what: prices, path }) = &self.energy_prices {
            let operations = self.base.operations();
            let mut comment = format!("# Prices of the demand periods from {}.\n", file_name(path));
            if prices.warning(periods, operations).is_some() {
                comment.push_str(
                    "# A period in which the price changes has the mean over its time.\n",
                );
            }
            let prices = prices.of_periods(periods, operations)?;
            let prices = prices.into_iter().map(number).collect::<Array>();
            put(tariffs, "energy_price_usd_per_kwh", prices, &comment);
        }
        self.put_pairs(tariffs);
        Ok(())
    }

    fn put_pairs(&self, tariffs: &mut Table) {
        let Some(FromFile { what: pairs, path }) = &self.pair_tariffs else { return };
        let entries = pairs.iter().map(|pair| {
            let mut entry = self.ends(pair.ends);
            for (member, amount) in
                [("fare_usd", pair.fare_usd), ("passenger_cost_usd", pair.passenger_cost_usd)]
            {
                if let Some(amount) = amount {
                    entry.insert(member, number(amount));
                }
            }
            entry
        });
        let comment = format!(
            "# Fares and passenger costs of pairs from {}. The factors, the boarding fee and the level of fares that this\n\
             # section has apply to these fares too.\n",
            file_name(path)
        );
        put(tariffs, "pairs", list(entries), &comment);
    }

    /// Gives each new demand period the entry that the base has for the time when it starts, if the
    /// member is a list by period and the periods are others.
    fn adapt_to_periods(&self, tariffs: &mut Table, member: &str, periods: &[Time]) {
        let of_base = self.base.period_starts();
        let Some(entries) = tariffs.get(member).and_then(Item::as_array) else { return };
        if of_base == periods {
            return;
        }
        let entry = |start: &Time| {
            let at = of_base.partition_point(|of_base| of_base <= start).saturating_sub(1);
            let mut entry = entries.get(at)?.clone();
            entry.decor_mut().clear();
            Some(entry)
        };
        let adapted: Array = periods.iter().filter_map(entry).collect();
        let comment = format!(
            "# The value of each demand period is the one that {} has when the period starts.\n",
            self.base.name()
        );
        let before = tariffs.key(member).and_then(|key| key.leaf_decor().prefix()?.as_str());
        let comment = format!("{}{comment}", before.unwrap_or_default());
        put(tariffs, member, adapted, &comment);
    }

    /// Adds the section of the demand, which is much the longest and therefore the last.
    fn put_demand(&self, text: &mut String, demand: &HourlyDemand, source: &[String]) {
        text.push('\n');
        for line in source {
            let _ = writeln!(text, "# {line}");
        }
        text.push_str("[hourly_demand]\nperiods = [");
        for (at, period) in demand.periods.iter().enumerate() {
            let part = if at == 0 {
                ""
            } else if at.is_multiple_of(8) {
                ",\n    "
            } else {
                ", "
            };
            let _ = write!(text, "{part}\"{period}\"");
        }
        text.push_str("]\ndistribution = \"poisson\"\npairs = [\n");
        for (&ends, means) in &demand.pairs {
            let _ = write!(
                text,
                "    {{ {}, passengers = [",
                self.ends(ends).to_string().trim_matches(['{', '}', ' '])
            );
            for (at, mean) in means.iter().enumerate() {
                let part = if at == 0 { "" } else { ", " };
                // Whole numbers without a fraction and small ones with an exponent keep the text
                // short.
                let _ = if mean.fract() == 0.0 {
                    write!(text, "{part}{mean}")
                } else {
                    write!(text, "{part}{mean:?}")
                };
            }
            text.push_str("] },\n");
        }
        text.push_str("]\n");
    }

    /// An inline table with the ids of two vertiports.
    fn ends(&self, (from, to): (usize, usize)) -> InlineTable {
        let id = |at: usize| self.vertiports.what.list[at].id.as_str();
        let mut table = InlineTable::new();
        table.insert("from", id(from).into());
        table.insert("to", id(to).into());
        table
    }
}

/// By how much the surges of a network raise the demand in the mean, percent.
fn surges_percent(file: &DocumentMut) -> f64 {
    let error = file.get("disturbances").and_then(|section| section.get("forecast_error"));
    let number = |name: &str| {
        let value = error.and_then(|error| error.get(name)).and_then(Item::as_value);
        let whole = value.and_then(Value::as_integer).map(|whole| whole as f64);
        value.and_then(Value::as_float).or(whole).unwrap_or(0.0)
    };
    100.0 * number("surge_probability") * (number("surge_factor") - 1.0).max(0.0)
}

/// A text without the comment at its head, which is about the file as a whole.
fn without_head(text: &str) -> &str {
    let is_head = |line: &&str| line.trim().is_empty() || line.starts_with('#');
    let head: usize = text.split_inclusive('\n').take_while(is_head).map(str::len).sum();
    &text[head..]
}

/// Removes the member that a path leads to, and returns whether it was there.
fn remove(table: &mut dyn TableLike, path: &[&str]) -> bool {
    match path {
        [] => false,
        [member] => table.remove(member).is_some(),
        [section, rest @ ..] => table
            .get_mut(section)
            .and_then(Item::as_table_like_mut)
            .is_some_and(|section| remove(section, rest)),
    }
}

/// Puts a list under a name, with a comment above it.
fn put(table: &mut Table, member: &str, list: Array, comment: &str) {
    table.insert(member, value(list));
    if let Some(mut key) = table.key_mut(member) {
        key.leaf_decor_mut().set_prefix(comment);
    }
}

/// A list with an entry on each line.
fn list(entries: impl Iterator<Item = InlineTable>) -> Array {
    let mut list = Array::new();
    for entry in entries {
        let mut entry = Value::from(entry);
        entry.decor_mut().set_prefix("\n    ");
        list.push_formatted(entry);
    }
    list.set_trailing_comma(true);
    list.set_trailing("\n");
    list
}

/// A number, without a fraction if it is whole.
fn number(number: f64) -> Value {
    #[expect(clippy::cast_possible_truncation, reason = "whole, and bounded by the readers")]
    if number.fract() == 0.0 { Value::from(number as i64) } else { Value::from(number) }
}

fn vertiport_table(vertiport: &Vertiport) -> Table {
    let mut table = Table::new();
    table.insert("id", value(&vertiport.id));
    table.insert("latitude", Item::Value(number(vertiport.place.latitude)));
    table.insert("longitude", Item::Value(number(vertiport.place.longitude)));
    table.insert("stands", value(i64::from(vertiport.stands.unwrap_or(ASSUMED_STANDS))));
    if let Some(chargers) = vertiport.chargers {
        table.insert("chargers", value(i64::from(chargers)));
    }
    if let Some(charger_kw) = vertiport.charger_kw {
        table.insert("charger_kw", Item::Value(number(charger_kw)));
    }
    table.insert("busy", value(vertiport.busy));
    if let Some(name) = &vertiport.name {
        table.decor_mut().set_suffix(format!("  # {name}"));
    }
    table
}
