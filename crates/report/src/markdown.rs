//! A report as a page in Markdown, for books and repositories. Its figures are files next to it.

use std::fmt::Write as _;

use vertifleet_picture::numbers::typeset;

use crate::page::sentences;
use crate::report::{Place, Report, Section, Table};

impl Report<'_> {
    /// The report as Markdown. Days to watch are left out.
    pub fn markdown(&self) -> String {
        let mut text = format!("# {}\n\n{}\n", self.heading, self.headline);
        let paragraphs = |text: &mut String, paragraphs: &[String]| {
            for paragraph in paragraphs {
                let _ = write!(text, "\n{paragraph}\n");
            }
        };
        paragraphs(&mut text, &self.remarks);
        for section in self.sections.iter().filter(|section| section.place != Place::Terminal) {
            append(&mut text, section);
        }
        paragraphs(&mut text, &self.closing);
        text
    }
}

fn append(text: &mut String, section: &Section) {
    if !section.title.is_empty() {
        let _ = write!(text, "\n## {}\n", section.title);
    }
    if let Some(table) = &section.table {
        append_table(text, table);
    }
    if !section.notes.is_empty() {
        let _ = write!(text, "\n{}\n", sentences(&section.notes));
    }
    for figure in &section.figures {
        let _ =
            write!(text, "\n![{}]({}.svg)\n\n*{}*\n", section.title, figure.slug, figure.caption);
    }
}

fn append_table(text: &mut String, Table { rows, .. }: &Table) {
    text.push('\n');
    for (position, row) in rows.iter().enumerate() {
        let cells: Vec<String> = row.iter().map(|cell| escaped(cell)).collect();
        let _ = writeln!(text, "| {} |", cells.join(" | "));
        if position == 0 {
            let _ = writeln!(text, "|{}", "---|".repeat(row.len()));
        }
    }
}

/// A cell whose letters stand for themselves in Markdown.
fn escaped(cell: &str) -> String {
    let mut text = String::with_capacity(cell.len());
    let cell = if cell.starts_with('-') { typeset(cell) } else { cell.to_owned() };
    for letter in cell.chars() {
        if letter.is_control() {
            text.push(' ');
            continue;
        }
        if "\\`*_|<>[]#".contains(letter) {
            text.push('\\');
        }
        text.push(letter);
    }
    text
}

#[cfg(test)]
mod tests {
    use crate::report::{Report, Section, Table};

    #[test]
    fn names_cannot_leave_their_cell() {
        let table = Table::new(["method", "share"])
            .with_rows([vec!["a|b\n[c](d)<e>".to_owned(), "-1.50".to_owned()]]);
        let sections = vec![Section::of_table("suite", table).with_note("read it so")];
        let report = Report { heading: "Board".to_owned(), sections, ..Report::default() };
        let expected = "# Board\n\n\n\n## suite\n\n| method | share |\n|---|---|\n\
                        | a\\|b \\[c\\](d)\\<e\\> | −1.50 |\n\nRead it so.\n";
        assert_eq!(report.markdown(), expected);
    }
}
