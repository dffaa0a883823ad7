//! Hints never lead from one unit to another, and columns that split fares and prices are named.

use std::path::Path;

use vertifleet_core::Coded;
use vertifleet_import::{Demand, Error, Imported, Request};

use crate::planner::{Folder, new_york, request, run};

/// An import with a table of fares (`fares`) or of prices.
fn with(kind: &str, table: &str) -> Result<Imported, Error> {
    let folder = Folder::new();
    let (base, places) = (new_york(), folder.path("vertiports.csv"));
    let demand = folder.file("demand.csv", "period,from,to,passengers\n7,JRB,JFK,14\n");
    let file = folder.file("table.csv", table);
    let mut request: Request<'_> = request(&base, &places, Demand::Table(&demand));
    let place: &mut Option<&Path> =
        if kind == "fares" { &mut request.tariffs } else { &mut request.energy_prices };
    *place = Some(&file);
    run(&request)
}

fn hint(kind: &str, header: &str) -> String {
    let error = with(kind, &format!("{header}\n")).expect_err("a missing column");
    assert_eq!(error.code().0, 702, "{error}");
    error.hint().unwrap_or_default().to_owned()
}

#[test]
fn no_hint_takes_a_column_in_another_unit_for_the_wanted_one() {
    for (kind, header) in [
        ("prices", "period,lmp_usd_per_mwh"),
        ("prices", "period,price_usd_per_mwh"),
        ("prices", "period,price_eur_per_kwh"),
        ("prices", "period,price_ct_per_kwh"),
        ("fares", "from,to,fare_eur"),
        ("fares", "from,to,fare_usd_per_mi"),
        ("fares", "from,to,fare_cents"),
    ] {
        let hint = hint(kind, header);
        assert!(!hint.contains("did you mean"), "{header}: {hint}");
        assert!(hint.contains("is in another unit"), "{header}: {hint}");
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
    for (kind, column, table) in [
        ("fares", "period", "from,to,fare_usd,period\nJRB,JFK,90,6\nJFK,JRB,80,7\n"),
        ("fares", "fare class", "from,to,fare_usd,fare class\nJRB,JFK,90,a\nJFK,JRB,80,b\n"),
        ("prices", "month", "period,price_usd_per_kwh,month\n0,0.1,1\n8,0.3,2\n"),
        ("prices", "season", "period,price_usd_per_kwh,season\n0,0.1,summer\n8,0.3,winter\n"),
    ] {
        let found = warnings(kind, table);
        assert!(found.contains(&format!("the column {column:?} is not read")), "{column}: {found}");
    }
    let quiet = "from,to,fare_usd,travel_time,note\nJRB,JFK,90,6,a\nJFK,JRB,80,7,b\n";
    assert_eq!(warnings("fares", quiet), "");
}

#[test]
fn a_column_of_chargers_by_another_name_is_named() {
    let folder = Folder::new();
    for column in ["charger_power_kw", "charging_power_kw", "charger_mw"] {
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
        assert_eq!(unit, column == "charger_mw", "{text:?}");
    }
}
