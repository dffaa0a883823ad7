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
    ] {
        let error = run_table(&Folder::new(), table).expect_err(table);
        assert_eq!(error.code().0, code, "{table}: {error}");
        assert!(error.to_string().contains("demand.csv"), "{error}");
    }
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
fn a_stated_end_that_the_next_period_contradicts_brings_a_warning() {
    let table = "period,from,to,passengers\n06:00-09:00,JRB,JFK,14\n07:00-22:00,JRB,JFK,9\n";
    let found = warnings(table);
    assert!(
        found.iter().any(|one| one.contains("06:00:00 ends at 09:00:00 in the table")),
        "{found:?}"
    );
}

#[test]
fn columns_that_split_a_demand_are_named() {
    for column in ["date", "scenario", "day_type", "Month", "weekday"] {
        let table = format!(
            "period,from,to,passengers,{column},note\n6,JRB,JFK,14,one,a\n7,JRB,JFK,9,two,b\n"
        );
        let found = warnings(&table);
        let is_named = |one: &String| {
            one.starts_with("V740 ") && one.contains(&format!("the column {column:?} is not read"))
        };
        assert!(found.iter().any(is_named), "{column}: {found:?}");
        assert!(!found.iter().any(|one| one.contains("note")), "{found:?}");
        // One value splits nothing.
        assert!(!warnings(&table.replace("two", "one")).iter().any(is_named), "{column}");
        // Where rows collide, the error names the column.
        let twice = table.replace("\n7,", "\n6,");
        let error = run_table(&Folder::new(), &twice).expect_err("given twice");
        assert_eq!(error.code().0, 704);
        assert!(error.hint().is_some_and(|hint| hint.contains(column)), "{:?}", error.hint());
    }
}
