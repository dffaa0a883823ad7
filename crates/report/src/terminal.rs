//! A report as plain text for a terminal.

use std::fmt::Write as _;

use crate::report::{Place, Report, Table};

impl Report<'_> {
    /// The report as text: the tables with their notes, and the headline. The last line has no line
    /// end.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let sections = self.sections.iter().filter(|section| section.place != Place::Page);
        let tables = sections.filter_map(|section| Some((section, section.table.as_ref()?)));
        for (position, (section, table)) in tables.enumerate() {
            // The opening stands for the title of the first table.
            let is_opened = position == 0 && !self.opening.is_empty();
            let title = if is_opened { &self.opening } else { &section.title };
            if !title.is_empty() {
                let _ = writeln!(text, "{title}\n");
            }
            append(&mut text, table);
            for note in &section.notes {
                let _ = writeln!(text, "{note}");
            }
            text.push('\n');
        }
        text += &self.headline;
        text.truncate(text.trim_end().len());
        text
    }
}

/// Appends a table with the first column aligned left and the others aligned right, and a rule
/// below the names of the columns.
fn append(text: &mut String, Table { rows, .. }: &Table) {
    let columns = rows.first().map_or(0, Vec::len);
    let widths: Vec<usize> = (0..columns)
        .map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0))
        .collect();
    for (position, row) in rows.iter().enumerate() {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
            if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        let line = cells.collect::<Vec<_>>().join("  ");
        let _ = writeln!(text, "{}", line.trim_end());
        if position == 0 {
            let _ =
                writeln!(text, "{}", "-".repeat(widths.iter().sum::<usize>() + 2 * (columns - 1)));
        }
    }
}
