//! Hints never lead from one unit to another, and columns that split fares and prices are named.

use vertifleet_core::Coded;
use vertifleet_import::{Demand, Error, Imported, Request};

use crate::planner::{Folder, new_york, request, run};

/// An import with a table of fares, prices or demand.
fn with(kind: &str, table: &str) -> Result<Imported, Error> {
    let folder = Folder::new();
    let (base, places) = (new_york(), folder.path("vertiports.csv"));
    let file = folder.file("table.csv", table);
    let rows = "period,from,to,passengers\n7,JRB,JFK,14\n";
    let demand = if kind == "demand" { file.clone() } else { folder.file("demand.csv", rows) };
    let mut request: Request<'_> = request(&base, &places, Demand::Table(&demand));
    match kind {
        "fares" => request.tariffs = Some(&file),
        "prices" => request.energy_prices = Some(&file),
        _ => {}
    }
    run(&request)
}

fn hint(kind: &str, header: &str) -> String {
    let error = with(kind, &format!("{header}\n")).expect_err("a missing column");
    assert_eq!(error.code().0, 702, "{error}");
    error.hint().unwrap_or_default().to_owned()
}

#[test]
fn no_hint_takes_a_column_in_another_unit_for_the_wanted_one() {
    for (kind, wanted, names) in [
        (
            "prices",
            "price_usd_per_kwh is in dollars per kWh",
            "lmp_usd_per_mwh price_usd_per_mwh price_eur_per_kwh price_ct_per_kwh priceUSDperMWh price_usdmwh priceUsdPerMwh \
             price_usd_per_gwh price_usd_per_mj price_usd_per_MMBtu price_pence_per_kwh price_yen_per_kwh",
        ),
        (
            "fares",
            "fare_usd is in dollars a passenger",
            "fare_eur fare_usd_per_mi fare_cents fare_usd_per_mile fareEUR fare_yen fare_usd_per_hour",
        ),
        (
            "demand",
            "passengers is the number of passengers of a pair and period",
            "passengers_per_day passengers_per_year passengers_thousands",
        ),
    ] {
        let keys = if kind == "prices" { "period" } else { "period,from,to" };
        for name in names.split_whitespace() {
            let hint = hint(kind, &format!("{keys},{name}"));
            assert!(!hint.contains("did you mean"), "{name}: {hint}");
            assert!(hint.contains("may be in another unit"), "{name}: {hint}");
            assert!(hint.contains(wanted), "{name}: {hint}");
        }
    }
    assert!(hint("prices", "period,lmp_usd_per_mwh").contains("divide prices by 1,000"));
    assert_eq!(hint("prices", "period,price"), "did you mean price?");
    assert_eq!(hint("prices", "period,price_usd_per_khw"), "did you mean price_usd_per_khw?");
    assert_eq!(hint("fares", "from,to,fare"), "did you mean fare?");
}

#[test]
fn electricity_at_the_price_of_a_megawatt_hour_brings_a_warning() {
    let dear = |price: &str| {
        let imported = with("prices", &format!("period,price_usd_per_kwh\n0,{price}\n"));
        let warnings = imported.expect("a network").network.warnings();
        warnings.iter().any(|warning| warning.code().0 == 139)
    };
    assert!(dear("45") && dear("2.5"));
    assert!(!dear("0.045") && !dear("1.5"));
}

#[test]
fn columns_that_split_fares_and_prices_are_named() {
    let warnings = |kind: &str, table: &str| -> String {
        let imported = with(kind, table).expect("a network");
        imported.warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    for (kind, keys, columns) in [
        (
            "fares",
            ["from,to,fare_usd", "JRB,JFK,90", "JFK,JRB,80"],
            "period cabin valid_from currency fareClass",
        ),
        (
            "prices",
            ["period,price_usd_per_kwh", "0,0.1", "8,0.3"],
            "month price_node hub_name season",
        ),
    ] {
        for column in columns.split_whitespace() {
            let [header, first, second] = keys;
            let table = format!("{header},{column}\n{first},a\n{second},b\n");
            let found = warnings(kind, &table);
            let named = format!("the column {column:?} (such as \"a\" and \"b\") is not read");
            assert!(found.contains(&named), "{column}: {found}");
            let same = warnings(kind, &table.replace(",b\n", ",a\n"));
            assert!(!same.contains("is not read"), "{column}: {same}");
        }
    }
    // A column that another warning names is not named twice.
    let found = warnings("fares", "from,to,fare_usd,passenger_cost\nJRB,JFK,90,6\nJFK,JRB,80,7\n");
    assert!(found.contains("rename it to passenger_cost_usd"), "{found}");
    assert_eq!(found.lines().count(), 1, "{found}");
}

#[test]
fn a_stated_end_of_a_price_that_the_next_one_contradicts_brings_a_warning() {
    for (rows, stated) in [
        ("0-9,0.1\n12-24,0.1", Some("the price of 00:00:00 ends at 09:00:00")),
        ("0-9,0.1\n9-12,0.1", Some("the price of 09:00:00 ends at 12:00:00")),
        ("0-9,0.1\n9-24,0.1", None),
        ("0-9,0.1\n9-22,0.1", None),
        ("0:00,0.1\n9:00,0.1", None),
    ] {
        let imported = with("prices", &format!("period,price_usd_per_kwh\n{rows}\n"));
        let imported = imported.expect("a network");
        let found: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(found.len(), usize::from(stated.is_some()), "{rows}: {found:?}");
        assert!(stated.is_none_or(|stated| found[0].contains(stated)), "{found:?}");
    }
}

#[test]
fn a_column_of_chargers_by_another_name_is_named() {
    let folder = Folder::new();
    for column in ["charger_power_kw", "charging_power_kw", "charger_mw", "charger_amps"] {
        let places = folder.file(
            "places.csv",
            format!("id,latitude,longitude,stands,{column}\nJRB,40.70,-74.00,20,150\nJFK,40.64,-73.78,20,150\n"),
        );
        let demand = folder.file("demand.csv", "period,from,to,passengers\n7,JRB,JFK,14\n");
        let base = new_york();
        let imported = run(&request(&base, &places, Demand::Table(&demand))).expect("a network");
        let text: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
        let named = |one: &String| one.contains(&format!("{column:?} is not read"));
        assert!(text.iter().any(named), "{column}: {text:?}");
        let unit = text.iter().any(|one| one.contains("another unit"));
        assert_eq!(unit, !column.ends_with("kw"), "{text:?}");
        assert!(!unit || !text.iter().any(|one| one.contains("rename")), "{text:?}");
        assert!(text.iter().any(|one| one.contains("charger_kw")), "{text:?}");
    }
}
