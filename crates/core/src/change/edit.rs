//! Sets members of a TOML document by path and leaves everything else, comments too, as it was
//! written.

use toml_edit::{Array, ArrayOfTables, InlineTable, Item, Table, TableLike, Value};

use super::member_path::position;

/// Sets the members that a path leads to. The error is the part of the path that leads nowhere.
pub(crate) fn set(members: &mut dyn TableLike, path: &[&str], value: &Value) -> Result<(), String> {
    let [part, rest @ ..] = path else { return Ok(()) };
    if rest.is_empty() {
        // The file may lack a member that the format allows, so a missing one is inserted. Reading
        // the result refuses the others.
        match members.get_mut(part) {
            Some(Item::Value(member)) => replace(member, value),
            Some(member) => *member = Item::Value(value.clone()),
            None => drop(members.insert(part, Item::Value(value.clone()))),
        }
        return Ok(());
    }
    // A network without a market has the market that changes nothing.
    if *part == "market" && !members.contains_key(part) {
        members.insert(part, Item::Table(Table::new()));
    }
    match members.get_mut(part) {
        Some(member) => set_below(member, rest, value),
        None => Err((*part).to_owned()),
    }
}

fn set_below(member: &mut Item, path: &[&str], value: &Value) -> Result<(), String> {
    match member {
        Item::Table(members) => set(members, path, value),
        Item::ArrayOfTables(entries) => set_in_tables(entries, path, value),
        Item::Value(member) => set_in_value(member, path, value),
        Item::None => Err(path[0].to_owned()),
    }
}

fn set_in_value(member: &mut Value, path: &[&str], value: &Value) -> Result<(), String> {
    let [part, rest @ ..] = path else {
        replace(member, value);
        return Ok(());
    };
    match member {
        Value::InlineTable(members) => set(members, path, value),
        Value::Array(entries) => {
            for at in chosen(&names(entries), part)? {
                let entry = entries.get_mut(at).expect("a position of the list");
                set_in_value(entry, rest, value)?;
            }
            Ok(())
        }
        _ => Err((*part).to_owned()),
    }
}

fn set_in_tables(entries: &mut ArrayOfTables, path: &[&str], value: &Value) -> Result<(), String> {
    let [part, rest @ ..] = path else { return Ok(()) };
    let names: Vec<Option<String>> = entries.iter().map(|entry| name_of(entry)).collect();
    for at in chosen(&names, part)? {
        let entry = entries.get_mut(at).expect("a position of the list");
        match (rest, value) {
            ([_, ..], _) => set(entry, rest, value)?,
            ([], Value::InlineTable(members)) => *entry = members.clone().into_table(),
            // An entry that is no table becomes an empty one, which is refused when the file is
            // read.
            ([], _) => *entry = Table::new(),
        }
    }
    Ok(())
}

/// A whole number of every entry of a list, if all have one.
pub(crate) fn whole_numbers(file: &Table, list: &str, member: &str) -> Option<Vec<i64>> {
    let number = |entry: &dyn TableLike| entry.get(member)?.as_integer();
    match file.get(list)? {
        Item::ArrayOfTables(entries) => entries.iter().map(|entry| number(entry)).collect(),
        entries => {
            let entries = entries.as_array()?.iter();
            entries.map(|entry| number(entry.as_inline_table()?)).collect()
        }
    }
}

/// Puts a value where another one was, with the comments around that.
fn replace(member: &mut Value, value: &Value) {
    let decor = member.decor().clone();
    *member = value.clone();
    *member.decor_mut() = decor;
}

/// The positions of the entries that a part of a path names. The error is that part.
fn chosen(names: &[Option<String>], part: &str) -> Result<Vec<usize>, String> {
    if part == "*" {
        return Ok((0..names.len()).collect());
    }
    let names = names.iter().map(Option::as_deref);
    position(names, part).map(|at| vec![at]).ok_or_else(|| part.to_owned())
}

fn names(entries: &Array) -> Vec<Option<String>> {
    let name =
        |entry: &Value| entry.as_inline_table().and_then(|entry: &InlineTable| name_of(entry));
    entries.iter().map(name).collect()
}

/// The id of an entry, or, in the fleet, its type.
fn name_of(entry: &dyn TableLike) -> Option<String> {
    let name = entry.get("id").or_else(|| entry.get("type"));
    name.and_then(Item::as_str).map(str::to_owned)
}
