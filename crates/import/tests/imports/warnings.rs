//! Files with contents that are probably unintended: the result is a network and a warning.

use crate::planner::{Folder, run_table};

/// The codes and texts of the warnings that a table of demand and vertiports bring.
fn warnings(vertiports: &str, table: &str) -> Vec<String> {
    let folder = Folder::new();
    if !vertiports.is_empty() {
        folder.file("vertiports.csv", vertiports);
    }
    let imported = run_table(&folder, table).expect("a network");
    let text = |warning: &vertifleet_import::Warning| format!("{} {warning}", warning.code());
    let path = format!("{}/", folder.path("").display());
    let without_folder = |text: String| text.replace(&path.replace("//", "/"), "");
    imported.warnings.iter().map(text).map(without_folder).collect()
}

const TABLE: &str = "period,from,to,passengers\n";

#[test]
fn demand_without_passengers_brings_a_warning() {
    assert_eq!(
        warnings("", &format!("{TABLE}6,JRB,JFK,0\n")),
        ["V718 demand.csv: there are no passengers, so that no flight of any day earns a fare"]
    );
    assert!(warnings("", &format!("{TABLE}6,JRB,JFK,1\n")).is_empty());
}

#[test]
fn a_missing_hour_and_passengers_outside_of_operations_bring_warnings() {
    let hours = |hours: &mut dyn Iterator<Item = u32>| {
        let rows = hours.map(|hour| format!("{hour},JRB,JFK,1.5\n")).collect::<Vec<_>>().concat();
        warnings("", &format!("{TABLE}{rows}"))
    };
    assert!(hours(&mut (6..22)).is_empty());
    // A table may begin after operations do: a period without passengers is put before it.
    assert!(hours(&mut (9..22)).is_empty());
    let lasts = "and others last 01:00:00: if hours are missing, give them rows with 0 passengers";
    assert_eq!(
        hours(&mut (6..22).filter(|&hour| hour != 9)),
        [format!("V718 demand.csv: the period 08:00:00 lasts until 10:00:00, {lasts}")]
    );
    assert_eq!(
        hours(&mut (6..20)),
        [format!("V718 demand.csv: the period 19:00:00 lasts until 22:00:00, {lasts}")]
    );
    assert_eq!(
        hours(&mut (4..24)),
        [
            "V718 demand.csv: 6.0 of 30.0 passengers a day want to fly outside the hours of operation of new-york, \
             06:00:00 to 22:00:00, and hardly any flight takes them"
        ]
    );
}

#[test]
fn vertiports_at_the_same_place_and_near_a_pole_bring_warnings() {
    let table = format!("{TABLE}6,A,B,1\n");
    let same = "id,lat,lng,stands\nA,40.7,-74,20\nC,40.8,-74,20\nB,40.7,-74,20\n";
    assert_eq!(
        warnings(same, &table),
        [r#"V719 vertiports.csv: the vertiports "A" and "B" are at the same place"#]
    );
    let exchanged = "id,latitude,longitude,stands\nA,-74,40.7,20\nB,-74.1,40.6,20\n";
    let found = warnings(exchanged, &table);
    assert_eq!(found.len(), 1);
    assert!(found[0].contains("latitude and longitude may be exchanged"), "{found:?}");
}
