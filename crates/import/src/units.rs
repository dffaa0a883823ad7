//! Units in the names of columns, so that no hint leads from one unit to another.

/// Units and currencies that names of columns contain as words.
const UNITS: [&str; 29] = [
    "usd", "eur", "gbp", "chf", "cad", "aud", "jpy", "cny", "inr", "cent", "cents", "ct", "kwh",
    "mwh", "wh", "kw", "mw", "w", "mi", "miles", "km", "m", "ft", "nm", "min", "minutes", "share",
    "percent", "pct",
];

/// What turns a number of one unit into one of another: the two units and the step.
const CONVERSIONS: [(&str, &str, &str); 10] = [
    ("mwh", "kwh", "multiply amounts of energy by 1,000, divide prices by 1,000"),
    ("wh", "kwh", "divide amounts of energy by 1,000, multiply prices by 1,000"),
    ("mw", "kw", "multiply its numbers by 1,000"),
    ("w", "kw", "divide its numbers by 1,000"),
    ("km", "mi", "divide distances by 1.609, multiply prices by 1.609"),
    ("m", "mi", "divide distances by 1,609"),
    ("cent", "usd", "divide its numbers by 100"),
    ("cents", "usd", "divide its numbers by 100"),
    ("ct", "usd", "divide its numbers by 100"),
    ("percent", "share", "divide its numbers by 100"),
];

/// The words of a name.
pub(crate) fn words(name: &str) -> impl Iterator<Item = String> + '_ {
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.map(str::to_ascii_lowercase)
}

fn units(name: &str) -> Vec<String> {
    words(name).filter(|word| UNITS.contains(&word.as_str())).collect()
}

/// Whether a name states a unit that the wanted name does not have. A name without a unit may mean
/// the wanted one.
pub(crate) fn differ(wanted: &str, found: &str) -> bool {
    let own = units(wanted);
    units(found).iter().any(|unit| !own.contains(unit))
}

/// The step that turns the numbers of a column into those of the wanted one.
pub(crate) fn conversion(wanted: &str, found: &str) -> &'static str {
    let (own, other) = (units(wanted), units(found));
    let step = CONVERSIONS.into_iter().find(|(from, to, _)| {
        other.iter().any(|unit| unit == from) && own.iter().any(|unit| unit == to)
    });
    step.map_or("convert its numbers", |(.., step)| step)
}

#[cfg(test)]
mod tests {
    use super::{conversion, differ};

    #[test]
    fn a_name_in_another_unit_is_not_the_wanted_one() {
        let price = "price_usd_per_kwh";
        for other in ["lmp_usd_per_mwh", "price_eur_per_kwh", "Price ($/MWh)", "price_ct_per_kwh"] {
            assert!(differ(price, other), "{other}");
        }
        for same in ["price", "lmp_usd_per_kwh", "price_per_kwh", "Price (USD/kWh)"] {
            assert!(!differ(price, same), "{same}");
        }
        assert!(differ("fare_usd", "fare_usd_per_mi") && !differ("fare_usd", "fare"));
        assert!(differ("charger_kw", "charger_mw") && !differ("charger_kw", "charger_power_kw"));
        assert!(conversion(price, "lmp_usd_per_mwh").contains("divide prices by 1,000"));
        assert_eq!(conversion("fare_usd", "fare_eur"), "convert its numbers");
    }
}
