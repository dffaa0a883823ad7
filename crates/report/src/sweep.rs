//! The report of a sweep.

use vertifleet_export::{csv_table, typed_table};
use vertifleet_picture::numbers::{counted, dollars, grouped, minutes, signed, typeset};
use vertifleet_study::sweep::{CellSummary, Sweep, SweepReport, format_value};

use crate::figure;
use crate::report::{DataFile, Files, Place, Report, Section, Table, stands};
use crate::sweep_headline::headline;
use crate::sweep_tables::{self, Settings};

/// Largest number of rows in the table of cells; the files have all of them.
const MOST_ROWS: usize = 40;

/// The report of a sweep with its files.
pub fn sweep<'a>(report: &'a SweepReport, sweep: &'a Sweep) -> Report<'a> {
    let effects = Section {
        title: "How profit follows the settings".to_owned(),
        notes: vec![
            "means over all cells that have a value in common".to_owned(),
            "cells meet the same days, so that curves are far less noisy against each other than the bands, which are 95 % \
             intervals over the days"
                .to_owned(),
        ],
        figures: figure::of_sweep(report),
        place: Place::Page,
        ..Section::default()
    };
    Report {
        title: format!("A sweep of {}", report.network),
        subject: "what a change of the network is worth",
        heading: format!("{} of “{}”", counted(report.ranked().len(), "design", "designs"), report.network),
        headline: headline(report),
        facts: facts(report),
        command: report.command.clone(),
        sections: vec![effects, cells(report)],
        closing: vec![
            "The best of many designs looks better than it is, since chance helps it. Play it and its neighbours again on \
             other days (another --seed) before you decide."
                .to_owned(),
            format!(
                "The smallest difference from the best that the days of this sweep can detect: {}.",
                smallest(report)
            ),
        ],
        files: Files::Beside(files(report, sweep)),
        ..Report::default()
    }
}

fn files<'a>(report: &'a SweepReport, sweep: &'a Sweep) -> Vec<DataFile<'a>> {
    let cells = |settings| sweep_tables::cells(report, settings);
    let days = |settings| sweep_tables::days(report, sweep, settings);
    vec![
        DataFile::new("cells.csv", "means", move || csv_table(&cells(Settings::AsGiven))),
        DataFile::new("cells.parquet", "the same", move || {
            typed_table("cells", &cells(Settings::Typed), &[])
        }),
        DataFile::new("days.csv", "every day", move || csv_table(&days(Settings::AsGiven))),
        DataFile::new("days.parquet", "the same", move || {
            typed_table("days", &days(Settings::Typed), &[])
        }),
        DataFile::new("summary.json", "all numbers of this page", || {
            (report.to_json() + "\n").into_bytes()
        }),
    ]
}

fn facts(report: &SweepReport) -> Vec<(&'static str, String)> {
    let mut facts = vec![
        ("Settings varied", report.factors.join(", ")),
        ("Policies", report.policies.join(", ")),
        ("Days of each design", format!("{} ({})", report.days, report.split)),
    ];
    facts.extend(report.bound_step_s.map(|step_s| ("Slices of the bounds", minutes(step_s))));
    let left_out = report.cells.len() - report.ranked().len();
    facts.extend((left_out > 0).then(|| ("Left out", left_out.to_string())));
    facts
}

/// The best cells by the first policy.
fn cells(report: &SweepReport) -> Section {
    let cells = report.ranked();
    let mut columns = vec!["cell".to_owned()];
    columns.extend(report.factors.iter().cloned());
    columns.extend(["aircraft", "stands", "fixed cost, $"].map(str::to_owned));
    columns.extend(report.policies.iter().map(|policy| format!("{policy}, $ a day")));
    columns.extend(["against the best, $", "served", "load factor"].map(str::to_owned));
    columns.extend(report.bound_step_s.map(|_| "of bound, %".to_owned()));
    let rows = cells.iter().take(MOST_ROWS).map(|cell| row(report, cell));
    let mut table = Table::new(columns).with_rows(rows);
    table.best = cells.iter().position(|cell| cell.cell == report.best).into_iter().collect();
    let mut section = Section::of_table("Designs", table);
    if cells.len() > MOST_ROWS {
        let more = counted(cells.len() - MOST_ROWS, "more cell", "more cells");
        section = section.with_note(format!("... and {more}, in cells.csv"));
    }
    let left_out = report.cells.len() - cells.len();
    if left_out > 0 {
        let cells = counted(left_out, "cell is", "cells are");
        let why = "left out, because the fleet has no aircraft or no place; cells.csv lists them";
        section = section.with_note(format!("{cells} {why}"));
    }
    section
        .with_note("± is the 95 % interval of the mean; profits are after the fixed cost, which fleet, stands and chargers cost a day")
}

fn row(report: &SweepReport, cell: &CellSummary) -> Vec<String> {
    let size = cell.size.expect("a cell that was played has a network");
    let is_cheapest = cell.cell == report.cheapest && cell.cell != report.best;
    let mark = if is_cheapest { " (cheapest within 1 %)" } else { "" };
    let mut row = vec![format!("{}{mark}", cell.cell)];
    row.extend(cell.settings.iter().map(format_value));
    row.extend([size.aircraft.to_string(), stands(&size), grouped(size.fixed_cost_usd, 0)]);
    row.extend(cell.results.iter().map(|one| one.profit_usd.written(|usd| grouped(usd, 0))));
    let first = &cell.results[0];
    let minus = first.minus_best_usd.as_ref();
    let minus = minus.map(|one| one.written(|usd| signed(usd, 0).replace('+', "")));
    row.push(minus.unwrap_or_else(|| "best".to_owned()));
    row.push(format!("{:.1} %", 100.0 * first.served_share));
    row.push(format!("{:.3}", first.load_factor));
    let share = first.bound_share.as_ref();
    row.extend(share.map(|share| share.written(|share| grouped(100.0 * share, 1))));
    row
}

/// The median half width of the differences from the best cell.
fn smallest(report: &SweepReport) -> String {
    let cells = report.cells.iter().filter_map(|cell| cell.results.first());
    let mut widths: Vec<f64> =
        cells.filter_map(|result| result.minus_best_usd.as_ref()?.half_width_95).collect();
    widths.sort_by(f64::total_cmp);
    match widths.get(widths.len() / 2) {
        Some(&width) => format!("about {} a day", typeset(&dollars(width))),
        None => "unknown with a single day".to_owned(),
    }
}
