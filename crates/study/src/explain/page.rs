//! The explanation as a page: the ledger, a picture of the day, and all tables.

use maud::{Markup, PreEscaped, html};
use vertifleet_picture::numbers::{dollars, grouped, minutes, typeset};

use super::{Explanation, table};
use crate::page;

/// Most pairs on the page; JSON has all of them.
const MOST_PAIRS: usize = 40;

/// The page as HTML; `picture` is the day as SVG.
pub(super) fn text(explanation: &Explanation, picture: &str) -> String {
    let totals = &explanation.totals;
    let share = 100.0 * totals.profit_usd / explanation.upper_bound_usd.max(f64::MIN_POSITIVE);
    let spilled: f64 = explanation.periods.iter().map(|one| one.demand.spilled_margin_usd).sum();
    let body = html! {
        p.program { "Vertifleet " (env!("CARGO_PKG_VERSION")) " · where a day’s money is, and where it is lost" }
        h1 { (explanation.day) " with " (explanation.policy) }
        p.headline {
            (explanation.policy) " earns " (dollars(totals.profit_usd)) ", " (grouped(share, 1))
            " % of what no schedule can pass. " (grouped(totals.passengers as f64, 0)) " passengers are carried and "
            (grouped(totals.spilled_passengers as f64, 0)) " are not; these would have brought " (dollars(spilled)) " more than they cost."
        }
        dl {
            div { dt { "Upper bound" } dd { (dollars(explanation.upper_bound_usd)) " (slices of " (minutes(explanation.bound_step_s)) ")" } }
            div { dt { "Flights" } dd { (totals.flights) ", " (totals.repositioning_flights) " empty" } }
            div { dt { "Load factor" } dd { (grouped(100.0 * totals.load_factor, 1)) " %" } }
            div { dt { "Energy" } dd { (grouped(totals.energy_kwh, 0)) " kWh" } }
        }
        h2 { "The day" }
        figure { (PreEscaped(picture)) }
        (section("Ledger", "", &table::ledger(explanation)))
        (section("Demand by hour", "Margin is what passengers would have paid less what carrying them costs, electricity and flights aside.",
            &table::periods(explanation)))
        (section("Where most money is spilled", "By pair, the most first.", &table::pairs(explanation, MOST_PAIRS)))
        (section("Vertiports", "Taken is the mean share of stands and chargers with an aircraft there or on its way there. One more stand is \
            the shadow price of the bound: by how much the bound rises at most.", &table::vertiports(explanation)))
        (section("Aircraft", "Means by type, within operations.", &table::types(explanation)))
        (section("What a change would be worth", "Each day was solved again with the change, by the policy and by the bound. The policy’s \
            difference is that of one day, which chance moves by more than most changes are worth: a sweep measures changes over many days.",
            &table::worth(explanation)))
    };
    let page = page::document(&format!("{} explained", explanation.day), &body);
    page.replacen("<!DOCTYPE html>", "<!DOCTYPE html>\n<!-- vertifleet-explanation/1 -->\n", 1)
}

/// A cell as it is set in type: numbers with a true minus sign, pairs with an arrow, ids as they are.
fn shown(cell: &str) -> String {
    if cell.starts_with('-') { typeset(cell) } else { cell.replace("->", "→") }
}

/// A table with its heading; the first row is that of the columns.
fn section(title: &str, lead: &str, rows: &[Vec<String>]) -> Markup {
    let (head, rows) = rows.split_first().expect("a table has a heading");
    html! {
        h2 { (title) }
        @if !lead.is_empty() { p.lead { (lead) } }
        div.wide { table {
            thead { tr { @for cell in head { th scope="col" { (cell) } } } }
            tbody { @for row in rows { tr { @for cell in row { td { (shown(cell)) } } } } }
        } }
    }
}
