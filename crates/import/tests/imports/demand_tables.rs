//! The forms of a table of demand, and the columns that would split one.

use vertifleet_core::Coded;
use vertifleet_import::{Error, Imported};

use crate::planner::{Folder, run_table};

/// The demand of an imported table by pair and period, as the network file has it.
fn demand(table: &str) -> String {
    let imported =
        run_table(&Folder::new(), table).unwrap_or_else(|error| panic!("{table}: {error}"));
    let lines = imported.toml.lines().skip_while(|line| *line != "[hourly_demand]");
    let is_demand = |line: &&str| line.contains("periods") || line.contains("from =");
    lines.filter(is_demand).collect::<Vec<_>>().join("\n")
}

/// The warnings of a table without the path of its folder.
fn warnings(table: &str) -> Vec<String> {
    let imported: Result<Imported, Error> = run_table(&Folder::new(), table);
    let imported = imported.unwrap_or_else(|error| panic!("{table}: {error}"));
    let text = |warning: &vertifleet_import::Warning| format!("{} {warning}", warning.code());
    imported.warnings.iter().map(text).collect()
}

const LONG: &str =
    "period,from,to,passengers\n6,JRB,JFK,14\n6,JFK,JRB,3\n7,JRB,JFK,9.5\n7,EWR,JFK,2\n";

#[test]
fn the_same_demand_in_every_form_is_the_same_network() {
    let long = demand(LONG);
    assert!(long.contains("9.5"), "{long}");
    for periods in [
        ["06:00", "07:00"],
        ["6:00 AM", "7:00 AM"],
        ["0600", "0700"],
        ["06:00-07:00", "07:00-08:00"],
        ["6-7", "7-8"],
    ] {
        let table = LONG.replace("\n6,", &format!("\n{},", periods[0]));
        let table = table.replace("\n7,", &format!("\n{},", periods[1]));
        assert_eq!(demand(&table), long, "{table}");
        let wide = format!(
            "from,to,{},{}\nJRB,JFK,14,9.5\nJFK,JRB,3,\nEWR,JFK,,2\nJFK,JFK,0,0\n",
            periods[0], periods[1]
        );
        assert_eq!(demand(&wide), long, "{wide}");
    }
    let by_destination = "period,from,JRB,JFK,EWR,total\n6,JRB,0,14,,14\n6,JFK,3,0,,3\n7,JRB,,9.5,,9.5\n7,EWR,,2,0,2\n";
    assert_eq!(demand(by_destination), long);
}

#[test]
fn wide_tables_keep_the_rules_of_others() {
    for (table, code) in [
        ("from,to,06:00,07:00\nJRB,JFK,14,x\n", 703),
        ("from,to,06:00,07:00\nJRB,JRB,1,0\n", 715),
        ("from,to,06:00,07:00\nJRB,JFK,1,0\nJRB,JFK,1,0\n", 704),
        ("from,to,06:00,6 AM\nJRB,JFK,1,0\n", 704),
        ("from,to,total\nJRB,JFK,1\n", 702),
        ("period,from,Boston\n6,JRB,1\n", 702),
        ("from,to,06:00,40:00\nJRB,JFK,1,2\n", 703),
        ("from,to,06:00,8h\nJRB,JFK,1,2\n", 703),
        ("from,to,06:00,25:61\nJRB,JFK,1,0\n", 703),
        ("from,to,distance_mi,06:00\nJRB,JFK,12.5,1\n", 703),
        ("period,from,JRB,JFX\n6,EWR,1,99\n", 705),
        ("period,from,JRB,JFX\n6,EWR,1,\n7,EWR,1,99\n", 705),
    ] {
        let error = run_table(&Folder::new(), table).expect_err(table);
        assert_eq!(error.code().0, code, "{table}: {error}");
        assert!(error.to_string().contains("demand.csv"), "{error}");
    }
}

#[test]
fn a_mistyped_name_of_a_wide_column_is_named_in_its_header() {
    let error = run_table(&Folder::new(), "period,from,JRB,JFX\n6,EWR,1,99\n").expect_err("JFX");
    assert!(error.to_string().contains("demand.csv: line 1: to names \"JFX\""), "{error}");
    assert_eq!(error.hint(), Some("did you mean JFK?"));
    // Texts are no passengers, and a total is no vertiport.
    let table = "period,from,JRB,JFK,total,note\n6,EWR,1,,1,a\n7,EWR,1,2,3,b\n";
    let found = warnings(table);
    assert!(found.iter().any(|one| one.contains("the column \"note\"")), "{found:?}");
    assert!(!found.iter().any(|one| one.contains("total")), "{found:?}");
}

#[test]
fn a_period_out_of_range_is_named_with_its_file_and_line() {
    for period in ["37", "36:00:01", "noon", "6:00 XM"] {
        let table = format!("period,from,to,passengers\n6,JRB,JFK,1\n{period},JRB,JFK,1\n");
        let error = run_table(&Folder::new(), &table).expect_err(period);
        assert_eq!(error.code().0, 703);
        let message = error.to_string();
        assert!(message.contains("demand.csv: line 3: period must be"), "{message}");
        assert!(message.contains("from 0 to 36:00") && message.contains(period), "{message}");
    }
}

#[test]
fn a_stated_end_that_the_next_period_or_the_end_of_operations_contradicts_brings_a_warning() {
    let header = "period,from,to,passengers";
    for (rows, stated) in [
        ("06:00-09:00,JRB,JFK,14\n07:00-22:00,JRB,JFK,9", Some("06:00:00 ends at 09:00:00")),
        ("06:00-07:00,JRB,JFK,14", Some("06:00:00 ends at 07:00:00")),
        ("06:00-14:00,JRB,JFK,14\n14:00-20:00,JRB,JFK,9", Some("14:00:00 ends at 20:00:00")),
        ("06:00-14:00,JRB,JFK,14\n14:00-22:00,JRB,JFK,9", None),
        ("06:00-22:00,JRB,JFK,14\n22:00-23:00,JRB,JFK,0", None),
    ] {
        let found = warnings(&format!("{header}\n{rows}\n"));
        let is_named = |one: &String| one.starts_with("V718 ") && one.contains("in the table");
        assert_eq!(found.iter().any(is_named), stated.is_some(), "{rows}: {found:?}");
        assert!(stated.is_none_or(|stated| found.concat().contains(stated)), "{found:?}");
    }
}

const NAMES: &str = "date scenario day_type Month travel_date trip_date forecast_year user_class trip_purpose is_weekend holiday tod \
                     model_run run version aircraft_type operator percentile ScenarioName note";

#[test]
fn columns_that_may_split_a_demand_are_named() {
    for column in NAMES.split_whitespace() {
        let table =
            format!("period,from,to,passengers,{column}\n6,JRB,JFK,14,one\n7,JRB,JFK,9,two\n");
        let found = warnings(&table);
        let is_named = |one: &String| {
            let named = format!("the column {column:?} (such as \"one\" and \"two\") is not read");
            one.starts_with("V740 ") && one.contains(&named)
        };
        assert!(found.iter().any(is_named), "{column}: {found:?}");
        // One value splits nothing.
        assert!(!warnings(&table.replace("two", "one")).iter().any(|one| one.contains(column)));
        // Where rows collide, the error names the column.
        let twice = table.replace("\n7,", "\n6,");
        let error = run_table(&Folder::new(), &twice).expect_err("given twice");
        assert_eq!(error.code().0, 704);
        assert!(error.hint().is_some_and(|hint| hint.contains(column)), "{:?}", error.hint());
    }
}

#[test]
fn several_columns_that_are_not_read_are_one_warning() {
    let names: Vec<String> = (0..9).map(|at| format!("c{at}")).collect();
    let row = |value: &str| [value; 9].join(",");
    let table = format!(
        "period,from,to,passengers,{}\n6,JRB,JFK,14,{}\n7,JRB,JFK,9,{}\n",
        names.join(","),
        row("a"),
        row("b")
    );
    let found: Vec<String> =
        warnings(&table).into_iter().filter(|one| one.starts_with("V740")).collect();
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].contains("\"c5\"") && found[0].contains("and 3 more are not read"),
        "{found:?}"
    );
}
