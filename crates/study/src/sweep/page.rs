//! `report.html` of a sweep.

use maud::{Markup, html};
use vertifleet_picture::numbers::{counted, dollars, grouped, minutes, typeset};

use super::design::format_value;
use super::{CellSummary, SweepReport, headline};
use crate::figure::Figure;
use crate::page::{self, estimate};

/// Most rows of the table of cells; `cells.csv` has all of them.
const MOST_ROWS: usize = 60;

/// The page as HTML.
pub(super) fn text(report: &SweepReport, figures: &[Figure]) -> String {
    let body = html! {
        (opening(report))
        h2 { "How profit follows the settings" }
        p.lead { "Means over all cells that have a value in common. Cells meet the same days, so that curves are far less noisy "
            "against each other than the bands, which are 95 % intervals over the days." }
        @for figure in figures { (page::picture(figure)) }
        (cells(report))
        (closing(report, figures))
    };
    page::document(&format!("A sweep of {}", report.network), &body)
}

fn opening(report: &SweepReport) -> Markup {
    let played = report.ranked().len();
    html! {
        p.program { "Vertifleet " (report.program_version) " · what a change of the network is worth" }
        h1 { (counted(played, "design", "designs")) " of “" (report.network) "”" }
        p.headline { (headline::text(report)) }
        dl {
            div { dt { "Settings varied" } dd { (report.factors.join(", ")) } }
            div { dt { "Policies" } dd { (report.policies.join(", ")) } }
            div { dt { "Days of each design" } dd { (report.days) " (" (report.split) ")" } }
            @if let Some(step_s) = report.bound_step_s {
                div { dt { "Slices of the bounds" } dd { (minutes(step_s)) } }
            }
            @if played < report.cells.len() {
                div { dt { "Left out" } dd { (report.cells.len() - played) } }
            }
        }
        pre { (report.command) }
    }
}

fn cells(report: &SweepReport) -> Markup {
    let cells = report.ranked();
    html! {
        h2 { "Designs" }
        p.lead { "By the mean profit of " (report.policies[0]) ", best first. ± is the 95 % interval of the mean over the days; "
            "differences from the best design are of the same days, so their intervals are narrower. Fixed cost is what fleet, "
            "stands and chargers cost a day whatever is flown; profits are after it."
            @if cells.len() > MOST_ROWS { " The first " (MOST_ROWS) " of " (cells.len()) " rows." } }
        div.wide { table {
            thead { tr {
                th scope="col" { "cell" }
                @for factor in &report.factors { th scope="col" { (factor) } }
                th scope="col" { "aircraft" }
                th scope="col" { "stands" }
                th scope="col" { "fixed cost" }
                @for policy in &report.policies { th scope="col" { (policy) ", profit" } }
                th scope="col" { "against the best" }
                th scope="col" { "served" }
                th scope="col" { "load factor" }
                @if report.bound_step_s.is_some() { th scope="col" { "of bound" } }
            } }
            tbody { @for cell in cells.iter().take(MOST_ROWS) { (row(report, cell)) } }
        } }
    }
}

fn row(report: &SweepReport, cell: &CellSummary) -> Markup {
    let first = &cell.results[0];
    html! {
        tr.best[cell.cell == report.best] {
            td { (cell.cell) @if cell.cell == report.cheapest { " " small { "cheapest within 1 %" } } }
            @for value in &cell.settings { td { (format_value(value)) } }
            @if let Some(size) = cell.size {
                td { (size.aircraft) }
                td { (size.stands) @if size.chargers > 0 { " + " (size.chargers) " chargers" } }
                td { (dollars(size.fixed_cost_usd)) }
            }
            @for result in &cell.results { td { (estimate(&result.profit_usd, dollars)) } }
            td { @match &first.minus_best_usd { Some(minus) => { (estimate(minus, dollars)) } None => { "best" } } }
            td { (grouped(100.0 * first.served_share, 1)) " %" }
            td { (grouped(100.0 * first.load_factor, 1)) " %" }
            @if let Some(share) = &first.bound_share {
                td { (estimate(share, |share| format!("{} %", grouped(100.0 * share, 1)))) }
            }
        }
    }
}

fn closing(report: &SweepReport, figures: &[Figure]) -> Markup {
    html! {
        footer {
            p { "The best of many designs looks better than it is, since chance helps it. Play it and its neighbours again on "
                "other days (another " code { "--seed" } ") before you decide." }
            p { "Files: " a href="cells.csv" { "cells.csv" } " (means), " a href="days.csv" { "days.csv" }
                " (every day), both also as Parquet (" a href="cells.parquet" { "cells.parquet" } ", "
                a href="days.parquet" { "days.parquet" } "), " a href="summary.json" { "summary.json" } (page::links(figures)) "." }
            p { "Smallest difference that the days of this sweep can tell from the best: " (smallest(report)) "." }
        }
    }
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
