//! The sweep as a table for a terminal.

use vertifleet_picture::numbers::{counted, grouped, signed};

use super::design::format_value;
use super::{SweepReport, headline};
use crate::table::{append_aligned, estimate};

/// Most rows of the table; the files have all of them.
const MOST_ROWS: usize = 40;

/// The best cells by the first policy, and the headline.
pub(super) fn text(report: &SweepReport) -> String {
    let cells = report.ranked();
    let left_out = report.cells.len() - cells.len();
    let mut head = vec!["cell".to_owned()];
    head.extend(report.factors.iter().cloned());
    head.extend(["aircraft", "stands", "fixed cost, $"].map(str::to_owned));
    for policy in &report.policies {
        head.push(format!("{policy}, $ a day"));
    }
    head.extend(["against the best, $", "served"].map(str::to_owned));
    let mut rows = vec![head];
    for cell in cells.iter().take(MOST_ROWS) {
        let size = cell.size.expect("a cell that was played has a network");
        let mut row = vec![cell.cell.to_string()];
        row.extend(cell.settings.iter().map(format_value));
        row.extend([
            size.aircraft.to_string(),
            size.stands.to_string(),
            grouped(size.fixed_cost_usd, 0),
        ]);
        row.extend(cell.results.iter().map(|one| estimate(&one.profit_usd, |usd| grouped(usd, 0))));
        let first = &cell.results[0];
        let minus = first.minus_best_usd.as_ref();
        row.push(minus.map_or_else(
            || "best".to_owned(),
            |one| estimate(one, |usd| signed(usd, 0).replace('+', "")),
        ));
        row.push(format!("{:.1} %", 100.0 * first.served_share));
        rows.push(row);
    }
    let mut text = String::new();
    append_aligned(&mut text, &rows);
    if cells.len() > MOST_ROWS {
        let more = counted(cells.len() - MOST_ROWS, "more cell", "more cells");
        text = text + "... and " + &more + ", in cells.csv\n";
    }
    if left_out > 0 {
        let cells = counted(left_out, "cell is", "cells are");
        text = text
            + &cells
            + " left out, because the fleet has no place; cells.csv says which
";
    }
    text + "\n" + &headline::text(report)
}
