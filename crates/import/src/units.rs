//! What the names of columns say, so that no hint leads from one unit or quantity to another.
//!
//! A name is split into words. A column is taken for a wanted one only if the words that its name
//! has besides those of the wanted name are known to change nothing. So units of which this program
//! does not know are other units.

/// The columns that have numbers of a unit, or of a thing that is counted.
const QUANTITIES: [(&str, &str); 9] = [
    ("price_usd_per_kwh", "in dollars per kWh"),
    ("fare_usd", "in dollars a passenger"),
    ("passenger_cost_usd", "in dollars a passenger"),
    ("passengers", "the number of passengers of a pair and period on the mean"),
    ("charger_kw", "the power of a charger in kW"),
    ("chargers", "the number of chargers"),
    ("stands", "the number of stands"),
    ("latitude", "in degrees"),
    ("longitude", "in degrees"),
];
/// Units and currencies that are found where names join them to other words, as `usdmwh`.
const UNITS: [&str; 23] = [
    "usd", "eur", "gbp", "chf", "cad", "aud", "jpy", "cny", "inr", "cent", "cents", "ct", "kwh",
    "mwh", "wh", "kw", "mw", "miles", "km", "per", "percent", "pct", "minutes",
];
/// Symbols that are words.
const SYMBOLS: [(char, &str); 7] = [
    ('$', "usd"),
    ('€', "eur"),
    ('£', "gbp"),
    ('¥', "jpy"),
    ('¢', "cent"),
    ('%', "percent"),
    ('/', "per"),
];
/// Words that do not change what a column has.
const HARMLESS: [&str; 19] = [
    "number",
    "of",
    "n",
    "num",
    "count",
    "name",
    "the",
    "value",
    "column",
    "mean",
    "average",
    "avg",
    "power",
    "energy",
    "electricity",
    "lmp",
    "tariff",
    "deg",
    "degrees",
];
/// What turns a number of one unit into one of another: the two units and the step.
const CONVERSIONS: [(&str, &str, &str); 9] = [
    ("mwh", "kwh", "divide prices by 1,000"),
    ("wh", "kwh", "multiply prices by 1,000"),
    ("mw", "kw", "multiply its numbers by 1,000"),
    ("w", "kw", "divide its numbers by 1,000"),
    ("cent", "usd", "divide its numbers by 100"),
    ("cents", "usd", "divide its numbers by 100"),
    ("ct", "usd", "divide its numbers by 100"),
    ("thousand", "passengers", "multiply its numbers by 1,000"),
    ("thousands", "passengers", "multiply its numbers by 1,000"),
];

/// Whether a column has the numbers of a wanted one, by their names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Likeness {
    Same,
    /// A like name in another unit, or of another quantity. `is_exact` if it has the very words.
    Other {
        is_exact: bool,
    },
    None,
}

/// What a wanted column has: its unit, or what it counts. `None` if it has other things than
/// numbers.
pub(crate) fn quantity(wanted: &str) -> Option<&'static str> {
    let found = QUANTITIES.into_iter().find(|(column, _)| *column == wanted);
    found.map(|(_, quantity)| quantity)
}

/// Whether a column of this name has the numbers of a wanted one.
pub(crate) fn likeness(wanted: &str, found: &str) -> Likeness {
    let own: Vec<String> = words(wanted).collect();
    let its = split(found, &own);
    let (units, core): (Vec<&String>, Vec<&String>) = own.iter().partition(|word| is_unit(word));
    let has =
        |word: &&String, alike: fn(&str, &str) -> bool| its.iter().any(|its| alike(word, its));
    let has_core = core.iter().all(|word| has(word, are_alike));
    let units_found = units.iter().filter(|word| has(word, are_same_letters)).count();
    let has_kind = units_found > 1;
    let is_own = |word: &String| {
        core.iter().any(|own| are_alike(own, word))
            || units.iter().any(|own| are_same_letters(own, word))
    };
    let changes = its.iter().any(|word| !is_own(word) && !HARMLESS.contains(&word.as_str()));
    if !changes && (has_core || has_kind && units_found == units.len()) {
        return Likeness::Same;
    }
    let is_exact = core.iter().all(|word| its.contains(word));
    if has_core || has_kind { Likeness::Other { is_exact } } else { Likeness::None }
}

/// The step that turns the numbers of a column into those of the wanted one, if it is known.
pub(crate) fn conversion(wanted: &str, found: &str) -> Option<&'static str> {
    let own: Vec<String> = words(wanted).collect();
    let its = split(found, &own);
    let has = |words: &[String], unit: &str| words.iter().any(|word| word == unit);
    let mut steps = CONVERSIONS.into_iter();
    steps.find(|(from, to, _)| has(&its, from) && has(&own, to)).map(|(.., step)| step)
}

/// The words of a name in small letters.
pub(crate) fn words(name: &str) -> impl Iterator<Item = String> + '_ {
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.map(str::to_lowercase)
}

fn is_unit(word: &str) -> bool {
    UNITS.contains(&word)
}

/// The words of a name, also those that are joined, as in `priceUsdPerMWh` and `usdmwh`. `own` are
/// words that it probably has.
fn split(name: &str, own: &[String]) -> Vec<String> {
    let mut found = Vec::new();
    for part in name.split_inclusive(|c: char| !c.is_alphanumeric()) {
        let word = part.trim_end_matches(|c: char| !c.is_alphanumeric());
        match known_parts(&word.to_lowercase(), own) {
            Some(parts) => found.extend(parts),
            None => found.extend(camel_parts(word)),
        }
        let symbol = &part[word.len()..];
        let meaning = SYMBOLS.into_iter().find(|(sign, _)| symbol.contains(*sign));
        match meaning {
            Some((_, meaning)) => found.push(meaning.to_owned()),
            // An unknown sign may be a unit.
            None if !symbol.is_ascii() => found.push(symbol.to_owned()),
            None => {}
        }
    }
    found
}

/// The known words of which a word consists, the longest first.
fn known_parts(word: &str, own: &[String]) -> Option<Vec<String>> {
    if word.is_empty() {
        return Some(Vec::new());
    }
    let known = UNITS.into_iter().chain(HARMLESS).chain(own.iter().map(String::as_str));
    let mut begins: Vec<&str> =
        known.filter(|known| known.len() > 1 && word.starts_with(known)).collect();
    begins.sort_unstable_by_key(|known| std::cmp::Reverse(known.len()));
    begins.into_iter().find_map(|begin| {
        let rest = known_parts(&word[begin.len()..], own)?;
        Some([vec![begin.to_owned()], rest].concat())
    })
}

/// The parts of a word that begin with capitals, in small letters.
fn camel_parts(word: &str) -> Vec<String> {
    let mut parts = Vec::new();
    let mut before_is_small = false;
    for letter in word.chars() {
        if parts.is_empty() || before_is_small && letter.is_uppercase() {
            parts.push(String::new());
        }
        let part = parts.last_mut().expect("just pushed");
        part.extend(letter.to_lowercase());
        before_is_small = !letter.is_uppercase();
    }
    parts
}

/// Whether two words are the same but for an ending, as charger and charging are, the end (`lat`),
/// or one letter that is mistyped.
fn are_alike(own: &str, word: &str) -> bool {
    const STEM: usize = 5;
    let stem = own.get(..STEM).zip(word.get(..STEM));
    let same_stem = own.len() > STEM + 1 && stem.is_some_and(|(own, word)| own == word);
    let is_begin = word.len() > 2 && own.starts_with(word);
    same_stem || is_begin || own.len() > 3 && differ_by_a_letter(own, word)
}

/// Whether two words have the same letters, as khw and kwh do. Another unit has others.
fn are_same_letters(own: &str, word: &str) -> bool {
    let sorted = |word: &str| {
        let mut letters: Vec<char> = word.chars().collect();
        letters.sort_unstable();
        letters
    };
    sorted(own) == sorted(word)
}

/// Whether at most a letter is more, less or another in one of two words, or two are exchanged.
fn differ_by_a_letter(one: &str, other: &str) -> bool {
    let (mut one, mut other): (Vec<char>, Vec<char>) =
        (one.chars().collect(), other.chars().collect());
    for _ in 0..2 {
        let same = one.iter().zip(&other).take_while(|(one, other)| one == other).count();
        one.drain(..same);
        other.drain(..same);
        one.reverse();
        other.reverse();
    }
    match (one.as_slice(), other.as_slice()) {
        ([a, b], [c, d]) => (a, b) == (d, c),
        (one, other) => one.len() <= 1 && other.len() <= 1,
    }
}

#[cfg(test)]
mod tests {
    use super::Likeness::{None, Other, Same};
    use super::{conversion, likeness};

    #[test]
    fn a_name_in_another_unit_is_not_the_wanted_one() {
        for (wanted, others) in [
            (
                "price_usd_per_kwh",
                "lmp_usd_per_mwh price_eur_per_kwh Price_($/MWh) price_ct_per_kwh priceUSDperMWh price_usdmwh \
                 priceUsdPerMwh price_usd_per_gwh price_usd_per_mj price_usd_per_MMBtu price_pence_per_kwh \
                 price_yen_per_kwh pence_per_kwh price_₹_per_kwh price_usd_per_kw price_usd_per_kwh_per_month",
            ),
            (
                "fare_usd",
                "fare_usd_per_mi fare_usd_per_mile fareEUR fare_yen fare_usd_per_hour fare_€ fares_thousands fare_kr \
                 fare_cents fareUsdPerKm",
            ),
            (
                "passengers",
                "passengers_per_day passengers_per_year passengers_thousands passengersPerDay passengers_share \
                 passengers_% passengers_sd",
            ),
            ("charger_kw", "charger_mw charger_amps charger_kwh charging_power_mw chargerMW"),
            ("chargers", "chargers_kw charger_amps chargers_usd"),
            ("latitude", "latitude_m latitude_ft"),
        ] {
            for other in others.split_whitespace() {
                let found = likeness(wanted, other);
                assert!(matches!(found, Other { .. }), "{wanted}, {other}: {found:?}");
            }
        }
    }

    #[test]
    fn a_name_with_harmless_words_or_a_mistyped_one_is_the_wanted_one() {
        for (wanted, names) in [
            (
                "price_usd_per_kwh",
                "price prices lmp_usd_per_kwh price_per_kwh Price(USD/kWh) priceUsdPerKwh price_usdkwh price_usd_per_khw \
                 usd_per_kwh prcie_usd_per_kwh energy_price",
            ),
            ("fare_usd", "fare fares fareUSD Fare($) mean_fare_usd"),
            (
                "passengers",
                "passenger passengrs passenger_count number_of_passengers meanPassengers",
            ),
            ("charger_kw", "charger_power_kw charging_power_kw chargerKW charger"),
            ("latitude", "lat latitudes latitude_deg"),
        ] {
            for name in names.split_whitespace() {
                assert_eq!(likeness(wanted, name), Same, "{wanted}, {name}");
            }
        }
        for (wanted, name) in
            [("price_usd_per_kwh", "month"), ("fare_usd", "distance_km"), ("stands", "standard")]
        {
            assert_eq!(likeness(wanted, name), None, "{wanted}, {name}");
        }
    }

    #[test]
    fn known_units_have_a_conversion() {
        let price = "price_usd_per_kwh";
        for name in ["lmp_usd_per_mwh", "priceUSDperMWh", "usdmwh"] {
            assert_eq!(conversion(price, name), Some("divide prices by 1,000"), "{name}");
        }
        assert_eq!(conversion("fare_usd", "fare_eur"), Option::None);
    }
}
