//! Compares the tables of the book's pages with the code.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use vertifleet_observe::{Axis, Observation, PRESETS, Part, preset};

fn shape(axes: &[Axis]) -> String {
    let names = axes.iter().map(|axis| match axis {
        Axis::Vertiports => "N".to_owned(),
        Axis::Aircraft => "A".to_owned(),
        Axis::Types => "T".to_owned(),
        Axis::Periods => "P".to_owned(),
        Axis::Of(entries) => entries.to_string(),
        Axis::PaperNode => "2N + 4".to_owned(),
        Axis::PaperAircraft => "2N + 2".to_owned(),
    });
    format!("[{}]", names.collect::<Vec<_>>().join(", "))
}

/// The table of all parts.
fn table() -> String {
    let mut table = String::from(
        "| part | in a view | shape | unit | scale | meaning | observations |\n|---|---|---|---|---|---|---|\n",
    );
    for part in Part::all() {
        let info = part.info();
        let shown = PRESETS
            .into_iter()
            .filter(|name| preset(name).expect("an observation of ours").contains(&part));
        writeln!(
            table,
            "| `{}` | {} | {} | {} | {} | {} | {} |",
            info.name,
            info.in_views.map_or(String::new(), |name| format!("`{name}`")),
            shape(info.axes),
            info.unit,
            if info.unit.is_empty() { String::new() } else { info.scale.to_string() },
            info.meaning,
            shown.collect::<Vec<_>>().join(", "),
        )
        .expect("memory takes everything");
    }
    table
}

#[test]
fn the_page_has_the_table_of_all_parts() {
    let page =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src/reference/observations.md");
    let page = fs::read_to_string(page).expect("the book has the page");
    assert!(page.contains(&table()), "the page should have this table:\n\n{}", table());
}

/// The names in the first column of the table below a heading.
fn first_column(page: &str, heading: &str) -> Vec<String> {
    let (_, table) = page.split_once(heading).expect("a table");
    let rows = table.lines().skip_while(|line| !line.starts_with("| `"));
    let cells = rows
        .take_while(|line| line.starts_with("| `"))
        .map(|row| row.split('|').nth(1).expect("a first column").split('`').skip(1).step_by(2));
    cells.flatten().map(str::to_owned).collect()
}

#[test]
fn the_page_of_policies_names_every_feature_in_its_order() {
    let page = include_str!("../../../../docs/src/concepts/policies.md");
    let (_, of_full) = page.split_once("\n## gcaps-full\n").expect("a section");
    let (priced, full) =
        (Observation::Priced { charge: false }, Observation::Full { charge: false });
    for (observation, page) in [(priced, page), (full, of_full)] {
        let [nodes, aircraft] = observation.names();
        let heading = |what, count| format!("What {what} shows ({count} numbers)");
        assert_eq!(first_column(page, &heading("a vertiport", nodes.len())), nodes);
        assert_eq!(first_column(page, &heading("the aircraft", aircraft.len())), aircraft);
    }
    let of_charge = ["a vertiport", "the aircraft"]
        .map(|what| first_column(page, &format!("What charge adds to {what} (3 numbers)")));
    for (without, with) in
        [(priced, Observation::Priced { charge: true }), (full, Observation::Full { charge: true })]
    {
        for ((without, with), of_charge) in
            without.names().into_iter().zip(with.names()).zip(&of_charge)
        {
            let expected: Vec<&str> =
                without.into_iter().chain(of_charge.iter().map(String::as_str)).collect();
            assert_eq!(with, expected);
        }
    }
}
