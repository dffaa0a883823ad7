//! A search as tables for a terminal.

use vertifleet_picture::numbers::{grouped, signed};

use super::{DesignSummary, SizeReport, headline};
use crate::table::{append_aligned, estimate};

/// What varied, the designs that matter, and the headline.
pub(super) fn text(report: &SizeReport) -> String {
    let mut text = String::new();
    append_aligned(&mut text, &dimensions(report));
    text.push('\n');
    append_aligned(&mut text, &designs(report));
    text + "\n" + &headline::text(report)
}

fn dimensions(report: &SizeReport) -> Vec<Vec<String>> {
    let unit = if report.goal == "profit" { "$" } else { "passengers" };
    let worth = format!("one more adds at most, {unit} a day");
    let head = ["member", "searched", "now", "found"].map(str::to_owned);
    let mut rows = vec![[head.to_vec(), vec![worth]].concat()];
    for one in &report.dimensions {
        let step = if one.step > 1 { format!(" by {}", one.step) } else { String::new() };
        rows.push(vec![
            one.member.clone(),
            format!("{} to {}{step}", one.lowest, one.highest),
            one.now.to_string(),
            one.found.to_string() + if one.is_at_limit() { " (limit)" } else { "" },
            signed(one.one_more_is_worth_at_most, usize::from(unit != "$")),
        ]);
    }
    rows
}

fn designs(report: &SizeReport) -> Vec<Vec<String>> {
    let head = [
        "",
        "aircraft",
        "stands",
        "fixed cost, $ a day",
        "profit, $ a day",
        "passengers a day",
        "served",
    ];
    let row = |name: &str, design: &DesignSummary| {
        vec![
            name.to_owned(),
            design.size.aircraft.to_string(),
            design.size.stands.to_string(),
            grouped(design.size.fixed_cost_usd, 0),
            estimate(&design.profit_usd, |usd| grouped(usd, 0)),
            grouped(design.passengers, 0),
            format!("{:.1} %", 100.0 * design.served_share),
        ]
    };
    let (start, found) = (report.name_of_start(), report.name_of_best());
    vec![
        head.map(str::to_owned).to_vec(),
        row(start, report.as_it_is()),
        row(found, report.found()),
        row(&format!("{start}, further days"), &report.now_on_holdout),
        row(&format!("{found}, further days"), &report.best_on_holdout),
    ]
}
