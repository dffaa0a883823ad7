//! The members in which two network files differ, by the paths that changes and sweeps use.

mod hourly_demand;

use serde::Serialize;
use toml::Value;

use super::member_path::quoted;
use crate::Network;

/// A member in which two network files differ.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Difference {
    /// Where it is: `vertiports.JFK.stands`. A number of the hourly demand has the path that leads
    /// to it in the first file, and none if that file does not have its pair.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    /// The value in the first file; `None` if the file does not have the member.
    pub before: Option<String>,
    /// The value in the second file; `None` if the file does not have the member.
    pub after: Option<String>,
    /// The pair and period, where it is a number of the hourly demand.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub demand: Option<DemandCell>,
}

/// A pair and a period of the hourly demand.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DemandCell {
    /// The vertiport where passengers want to start.
    pub from: String,
    /// The vertiport where they want to go.
    pub to: String,
    /// The start of the period.
    pub period: String,
}

impl Network {
    /// The differences between this network's file and another one's, in the order of the members'
    /// names. Comments and the order of members do not count, nor does the order of vertiports and
    /// aircraft types, which have names.
    pub fn differences(&self, other: &Self) -> Vec<Difference> {
        let read = |network: &Self| -> Value {
            toml::from_str(network.toml()).expect("the text has been read before")
        };
        let mut found = Vec::new();
        let (mut before, mut after) = (read(self), read(other));
        let demand = hourly_demand::compare(&mut before, &mut after);
        compare(String::new(), Some(&before), Some(&after), &mut found);
        found.extend(demand);
        found
    }
}

fn compare(
    path: String,
    before: Option<&Value>,
    after: Option<&Value>,
    found: &mut Vec<Difference>,
) {
    let inside = |name: &str| {
        let name = quoted(name);
        if path.is_empty() { name.into_owned() } else { format!("{path}.{name}") }
    };
    match (before, after) {
        (Some(before), Some(after)) if before == after => {}
        (Some(Value::Table(before)), Some(Value::Table(after))) => {
            let added = after.keys().filter(|name| !before.contains_key(*name));
            for name in before.keys().chain(added) {
                compare(inside(name), before.get(name), after.get(name), found);
            }
        }
        (Some(Value::Array(before)), Some(Value::Array(after))) => {
            let Some((before, after)) = named(before).zip(named(after)) else {
                return compare_positions(&path, before, after, found);
            };
            let added = after.iter().filter(|(name, _)| !before.iter().any(|one| one.0 == *name));
            for &(name, _) in before.iter().chain(added) {
                let one = before.iter().find(|one| one.0 == name).map(|one| one.1);
                let other = after.iter().find(|one| one.0 == name).map(|one| one.1);
                compare(inside(name), one, other, found);
            }
        }
        (before, after) => {
            let text =
                |value: Option<&Value>| value.map(|value| value.to_string().trim().to_owned());
            found.push(Difference {
                path: Some(path),
                before: text(before),
                after: text(after),
                demand: None,
            });
        }
    }
}

/// Lists of numbers are one difference, since the position of an entry means little; other lists
/// are compared entry by entry.
fn compare_positions(path: &str, before: &[Value], after: &[Value], found: &mut Vec<Difference>) {
    let are_plain = |list: &[Value]| list.iter().all(|value| !value.is_table());
    if are_plain(before) && are_plain(after) {
        let text = |list: &[Value]| Some(Value::Array(list.to_vec()).to_string());
        let (before, after) = (text(before), text(after));
        found.push(Difference { path: Some(path.to_owned()), before, after, demand: None });
        return;
    }
    for at in 0..before.len().max(after.len()) {
        compare(format!("{path}.{at}"), before.get(at), after.get(at), found);
    }
}

/// The entries of a list by their ids (or, in the fleet, types), if all have one and no two the
/// same.
fn named(list: &[Value]) -> Option<Vec<(&str, &Value)>> {
    let mut entries = Vec::new();
    for entry in list {
        let name = entry.get("id").or_else(|| entry.get("type"))?.as_str()?;
        if entries.iter().any(|&(before, _)| before == name) {
            return None;
        }
        entries.push((name, entry));
    }
    Some(entries)
}
