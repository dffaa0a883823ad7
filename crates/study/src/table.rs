//! Tables as plain text for a terminal.

use std::fmt::Write as _;

use maud::{Markup, html};

use crate::statistics::Estimate;

/// The alignment of a cell's text.
#[derive(Clone, Copy)]
enum Align {
    Left,
    Right,
}

/// A mean with its interval.
pub(crate) fn estimate(estimate: &Estimate, written: impl Fn(f64) -> String) -> String {
    match estimate.half_width_95 {
        Some(half_width) => format!("{} ± {}", written(estimate.mean), written(half_width)),
        None => written(estimate.mean),
    }
}

/// Appends rows with the first column aligned left and the others aligned right, and a rule below
/// the first row.
pub(crate) fn append_aligned(text: &mut String, rows: &[Vec<String>]) {
    let columns = rows.first().map_or(0, Vec::len);
    let widths: Vec<usize> = (0..columns)
        .map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0))
        .collect();
    for (position, row) in rows.iter().enumerate() {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
            padded(cell, width, if column == 0 { Align::Left } else { Align::Right })
        });
        let line = cells.collect::<Vec<_>>().join("  ");
        let _ = writeln!(text, "{}", line.trim_end());
        if position == 0 {
            let _ =
                writeln!(text, "{}", "-".repeat(widths.iter().sum::<usize>() + 2 * (columns - 1)));
        }
    }
}

/// The rows as an HTML table for notebooks, with the first row as its heading.
pub(crate) fn html(rows: &[Vec<String>]) -> Markup {
    html! {
        table {
            @for (position, row) in rows.iter().enumerate() {
                tr {
                    @for (column, cell) in row.iter().enumerate() {
                        @let style = if column == 0 { "text-align:left" } else { "text-align:right" };
                        @if position == 0 { th style=(style) { (cell) } } @else { td style=(style) { (cell) } }
                    }
                }
            }
        }
    }
}

fn padded(cell: &str, width: usize, align: Align) -> String {
    match align {
        Align::Left => format!("{cell:<width$}"),
        Align::Right => format!("{cell:>width$}"),
    }
}
