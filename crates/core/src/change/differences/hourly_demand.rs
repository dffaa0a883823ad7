//! The differences of two hourly demands by pair and period.
//!
//! The pairs of a file are a list in any order, and a pair that is absent has no passengers. So the
//! cells are compared, and not the lists.

use std::collections::{BTreeMap, BTreeSet};

use toml::Value;

use super::{DemandCell, Difference};

/// A cell of the demand: its number in its file, and the path that leads to it.
type Cells = BTreeMap<(String, String, String), (f64, String)>;

/// The differences of the hourly demands of two files; removes the pairs from both files. Finds
/// none and removes nothing if a file has another model of demand.
pub(super) fn compare(before: &mut Value, after: &mut Value) -> Vec<Difference> {
    let (Some(one), Some(other)) = (cells(before), cells(after)) else { return Vec::new() };
    for file in [before, after] {
        if let Some(hourly) = file.get_mut("hourly_demand").and_then(Value::as_table_mut) {
            hourly.remove("pairs");
        }
    }
    let all: BTreeSet<_> = one.keys().chain(other.keys()).collect();
    let difference = |cell: &(String, String, String)| {
        let number = |cells: &Cells| cells.get(cell).map_or(0.0, |(number, _)| *number);
        let (before, after) = (number(&one), number(&other));
        let (from, to, period) = cell.clone();
        // A position in the second file is that of another pair in the first.
        let path = one.get(cell).map(|(_, path)| path.clone());
        (before != after).then_some(Difference {
            path,
            before: Some(before.to_string()),
            after: Some(after.to_string()),
            demand: Some(DemandCell { from, to, period }),
        })
    };
    all.into_iter().filter_map(difference).collect()
}

/// The cells of the hourly demand of a file, if it has one.
fn cells(file: &Value) -> Option<Cells> {
    let hourly = file.get("hourly_demand")?;
    let periods: Vec<&str> =
        hourly.get("periods")?.as_array()?.iter().map(Value::as_str).collect::<Option<_>>()?;
    let mut cells = Cells::new();
    for (position, pair) in hourly.get("pairs")?.as_array()?.iter().enumerate() {
        let end = |name: &str| pair.get(name).and_then(Value::as_str).map(str::to_owned);
        let (from, to) = (end("from")?, end("to")?);
        let numbers = pair.get("passengers")?.as_array()?;
        for (at, (period, number)) in periods.iter().zip(numbers).enumerate() {
            let whole = || number.as_integer().map(|whole| whole as f64);
            let number = number.as_float().or_else(whole)?;
            let path = format!("hourly_demand.pairs.{position}.passengers.{at}");
            cells.insert((from.clone(), to.clone(), hour(period)), (number, path));
        }
    }
    Some(cells)
}

/// A time as this program writes it.
fn hour(text: &str) -> String {
    text.parse::<crate::Time>().map_or_else(|_| text.to_owned(), |time| time.to_string())
}
