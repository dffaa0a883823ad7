//! `report.html` of a search for a design.

use maud::{Markup, html};
use vertifleet_picture::numbers::{counted, dollars, grouped, minutes, signed};

use super::{DesignSummary, SizeReport, headline};
use crate::figure::Figure;
use crate::page::{self, estimate};

/// The page as HTML.
pub(super) fn text(report: &SizeReport, figures: &[Figure]) -> String {
    let body = html! {
        (opening(report))
        h2 { "DimensionKind was found" }
        (dimensions(report))
        @for figure in figures { (page::picture(figure)) }
        (designs(report))
        (closing(figures))
    };
    page::document(&format!("Sizing {}", report.network), &body)
}

fn opening(report: &SizeReport) -> Markup {
    html! {
        p.program { "Vertifleet " (report.program_version) " · how many aircraft, stands and chargers" }
        h1 { "A design of “" (report.network) "” for the goal " code { (report.goal) } }
        p.headline { (headline::text(report)) }
        dl {
            div { dt { "Policy" } dd { (report.policy) } }
            div { dt { "Designs played" } dd { (report.designs.len()) } }
            div { dt { "Days of each design" } dd { (report.days) " (" (report.split) ")" } }
            div { dt { "Passengers who want to fly" } dd { (grouped(report.wanted_passengers, 0)) " a day" } }
            @if let Some(need) = report.needed_passengers {
                div { dt { "Passengers to carry" } dd { (grouped(need, 0)) " a day" } }
            }
            div { dt { "Slices of the bounds" } dd { (minutes(report.bound_step_s)) } }
        }
        pre { (report.command) }
    }
}

fn dimensions(report: &SizeReport) -> Markup {
    let is_money = report.goal == "profit";
    html! {
        p.lead { "DimensionKind one more adds is proven by the bound: with one more of it, and the rest as found, no schedule of the days "
            @if is_money { "earns more, after its cost, than the bound of this design plus this amount." }
            @else { "carries more than the bound of this design plus this number of passengers." } }
        div.wide { table {
            thead { tr {
                th scope="col" { "member" } th scope="col" { "searched" } th scope="col" { "now" }
                th scope="col" { "found" } th scope="col" { "one more adds at most" }
            } }
            tbody { @for one in &report.dimensions { tr.best[one.found != one.now] {
                td { (one.member) }
                td { (one.lowest) " to " (one.highest) @if one.step > 1 { " by " (one.step) } }
                td { (one.now) }
                td { (one.found) @if one.is_at_limit() { " " small { "limit" } } }
                td { @if is_money { (dollars(one.one_more_is_worth_at_most)) }
                     @else { (signed(one.one_more_is_worth_at_most, 1)) " passengers" } }
            } } }
        } }
    }
}

fn designs(report: &SizeReport) -> Markup {
    html! {
        h2 { "Designs" }
        p.lead { (counted(report.designs.len(), "design was", "designs were")) " played, in this order. ± is the 95 % interval of the mean over the days. "
            "Fixed cost is what fleet, stands and chargers cost a day whatever is flown; profits are after it. The bound holds for "
            "the design under any policy." }
        div.wide { table {
            thead { tr {
                th scope="col" { "design" }
                @for one in &report.dimensions { th scope="col" { (one.member) } }
                th scope="col" { "aircraft" } th scope="col" { "stands" } th scope="col" { "fixed cost a day" }
                th scope="col" { "profit a day" } th scope="col" { "passengers a day" } th scope="col" { "served" }
                th scope="col" { @if report.goal == "profit" { "bound of profit" } @else { "bound of passengers" } }
            } }
            tbody {
                @for (number, design) in report.designs.iter().enumerate() {
                    tr.best[number == report.best] { (row(report, &name(report, number), design)) }
                }
                tr { (row(report, &format!("{}, further days", report.name_of_start()), &report.now_on_holdout)) }
                tr { (row(report, &format!("{}, further days", report.name_of_best()), &report.best_on_holdout)) }
            }
        } }
    }
}

fn name(report: &SizeReport, number: usize) -> String {
    match number {
        _ if number == report.best => format!("{number}, {}", report.name_of_best()),
        _ if number == report.now => format!("{number}, {}", report.name_of_start()),
        _ => number.to_string(),
    }
}

fn row(report: &SizeReport, name: &str, design: &DesignSummary) -> Markup {
    html! {
        td { (name) }
        @for number in &design.numbers { td { (number) } }
        td { (design.size.aircraft) }
        td { (design.size.stands) @if design.size.chargers > 0 { " + " (design.size.chargers) " chargers" } }
        td { (dollars(design.size.fixed_cost_usd)) }
        td { (estimate(&design.profit_usd, dollars)) }
        td { (grouped(design.passengers, 0)) }
        td { (grouped(100.0 * design.served_share, 1)) " %" }
        td { @if report.goal == "profit" { (dollars(design.ceiling)) } @else { (grouped(design.ceiling, 0)) } }
    }
}

fn closing(figures: &[Figure]) -> Markup {
    html! {
        footer {
            p { "The best of many designs looks better than it is on the days that it was chosen on. The rows of further days are "
                "not helped by that." }
            p { "Files: " a href="best.toml" { "best.toml" } " (the network file of the design that was found), "
                a href="designs.csv" { "designs.csv" } ", " a href="summary.json" { "summary.json" } (page::links(figures)) "." }
        }
    }
}
