//! The properties that a changed network keeps from its base, so that the days of both are
//! comparable: where aircraft start, and the fares at which the demand was measured. Both are
//! written into the changed file.

use toml_edit::{Array, DocumentMut, Item, Table, Value, value};

use super::edit::whole_numbers;
use crate::Network;

/// The members of `[tariffs]` that fares follow from. The level of all fares is not among them: it
/// is 1 at the reference.
const FARES: [&str; 7] = [
    "passenger_cost_usd_per_mi",
    "fare_usd_per_mi",
    "fare_base",
    "fare_demand_weight",
    "fare_factors",
    "boarding_fee_usd",
    "pairs",
];

/// Makes aircraft start where they start on the base, if the stands of the file are others.
pub(crate) fn keep_start_stands(base: &Network, file: &mut Table) {
    let own: Vec<i64> =
        base.vertiports().iter().map(|vertiport| i64::from(vertiport.stands)).collect();
    // Stands that are no whole numbers are refused when the text is read.
    let stands = whole_numbers(file, "vertiports", "stands");
    let Some(stands) = stands.filter(|stands| stands.len() == own.len()) else { return };
    if stands != own && !file.contains_key("start_stands") {
        file.insert("start_stands", value(own.into_iter().collect::<Array>()));
    }
}

/// Makes the demand that of the base's fares, if passengers respond and the fares of the file are
/// others.
pub(crate) fn keep_reference(base: &Network, file: &mut Table) {
    if !responds(file) {
        return;
    }
    let before: DocumentMut = base.toml().parse().expect("the text has been read before");
    let of = |file: &Table, member: &str| file.get("tariffs")?.get(member).cloned();
    let text = |member: Option<&Item>| member.map(|member| member.to_string().trim().to_owned());
    for member in FARES {
        let (own, now) = (of(before.as_table(), member), of(file, member));
        if text(own.as_ref()) == text(now.as_ref()) {
            continue;
        }
        let own = own.and_then(|own| own.into_value().ok());
        let own = own.unwrap_or_else(|| absent(member, base.periods()));
        let Some(market) = file.get_mut("market").and_then(Item::as_table_like_mut) else { return };
        let reference = market.entry("reference").or_insert_with(|| Item::Table(Table::new()));
        let Some(reference) = reference.as_table_like_mut() else { return };
        if !reference.contains_key(member) {
            reference.insert(member, Item::Value(own.decorated(" ", "")));
        }
    }
}

/// Whether passengers respond to fares in a file.
fn responds(file: &Table) -> bool {
    let Some(market) = file.get("market").and_then(Item::as_table_like) else { return false };
    let number = |member: &Item| member.as_float().or(member.as_integer().map(|one| one as f64));
    let elasticity = market.get("elasticity").and_then(number);
    elasticity.is_some_and(|elasticity| elasticity != 0.0) || market.contains_key("elasticities")
}

/// The default of a member of the tariffs, for a file that does not have it.
fn absent(member: &str, periods: usize) -> Value {
    match member {
        "fare_factors" => Value::Array((0..periods).map(|_| 1.0).collect()),
        "pairs" => Value::Array(Array::new()),
        _ => Value::from(0.0),
    }
}
