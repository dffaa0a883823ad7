//! The contents of a report of any kind.

use maud::Markup;
use vertifleet_core::OutputKind;
use vertifleet_picture::numbers::{grouped, signed};
use vertifleet_study::record::ReplayedDay;
use vertifleet_study::statistics::Estimate;
use vertifleet_study::sweep::Size;

use crate::figure::Figure;

/// A report that can be shown in a terminal, in a notebook, as a page and as a folder.
#[derive(Default)]
pub struct Report<'a> {
    /// The title of the page's window.
    pub title: String,
    /// The days and the network in a line, which a terminal shows first; may be empty.
    pub opening: String,
    /// The kind of report in a few words, above the page's heading.
    pub subject: &'static str,
    /// The heading of the page.
    pub heading: String,
    /// The result in a few sentences.
    pub headline: String,
    /// The inputs, as names and values, at the head of the page.
    pub facts: Vec<(&'static str, String)>,
    /// The command line that made the report; empty if there is none.
    pub command: String,
    /// Notes before the first section.
    pub remarks: Vec<String>,
    /// Tables and figures in their order.
    pub sections: Vec<Section>,
    /// The days that the page replays.
    pub replayed: &'a [ReplayedDay],
    /// Notes about the numbers, at the end of the page.
    pub closing: Vec<String>,
    /// The files that the page links to.
    pub files: Files<'a>,
    /// The format of the page, if the program recognises it by its first bytes.
    pub kind: Option<&'static OutputKind>,
}

/// The files of a report other than its page.
#[derive(Default)]
pub enum Files<'a> {
    /// None; the page needs no other file.
    #[default]
    None,
    /// The page contains its figures as files to download. Their names begin with this text.
    Within(String),
    /// Figures and data are files in the folder of the page.
    Beside(Vec<DataFile<'a>>),
}

/// A file with the data of a report.
pub struct DataFile<'a> {
    /// Its name.
    pub name: &'static str,
    /// What it contains, in a few words.
    pub about: &'static str,
    /// Creates its content.
    pub content: Box<dyn Fn() -> Vec<u8> + 'a>,
}

impl<'a> DataFile<'a> {
    /// A file of this name.
    pub fn new(
        name: &'static str,
        about: &'static str,
        content: impl Fn() -> Vec<u8> + 'a,
    ) -> Self {
        Self { name, about, content: Box::new(content) }
    }
}

/// A table, figures, or both, under a heading.
#[derive(Default)]
pub struct Section {
    /// The heading; may be empty.
    pub title: String,
    /// How to read it, one statement each, without a full stop.
    pub notes: Vec<String>,
    /// The figures.
    pub figures: Vec<Figure>,
    /// The table.
    pub table: Option<Table>,
    /// Content below them that only the page shows.
    pub below: Option<Markup>,
    /// Where it is shown.
    pub place: Place,
}

/// Where a section is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Place {
    /// Everywhere; figures only on the page.
    #[default]
    Everywhere,
    /// On the page.
    Page,
    /// In a terminal and in notebooks.
    Terminal,
}

/// A table: the first row names the columns, and the first cell of each row names the row.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Table {
    /// The rows with their cells.
    pub rows: Vec<Vec<String>>,
    /// The positions of the highlighted rows, not counting the header.
    pub best: Vec<usize>,
}

impl Table {
    /// A table with these columns and no row.
    pub fn new<T: Into<String>>(columns: impl IntoIterator<Item = T>) -> Self {
        Self { rows: vec![columns.into_iter().map(Into::into).collect()], best: Vec::new() }
    }

    /// The table with these further rows.
    #[must_use]
    pub fn with_rows(mut self, rows: impl IntoIterator<Item = Vec<String>>) -> Self {
        self.rows.extend(rows);
        self
    }
}

impl Section {
    /// A section with a table.
    pub fn of_table(title: impl Into<String>, table: Table) -> Self {
        Self { title: title.into(), table: Some(table), ..Self::default() }
    }

    /// The section with this further note.
    #[must_use]
    pub fn with_note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }
}

/// A difference with its interval, `scale` times as large, as a cell.
pub(crate) fn difference(estimate: &Estimate, scale: f64, decimals: usize) -> String {
    let half = estimate.half_width_95.map(|half| format!(" ± {}", grouped(scale * half, decimals)));
    signed(scale * estimate.mean, decimals) + &half.unwrap_or_default()
}

/// Stands, and the chargers that are counted separately from them, as a cell.
pub(crate) fn stands(size: &Size) -> String {
    match size.chargers {
        0 => size.stands.to_string(),
        chargers => format!("{} + {chargers} chargers", size.stands),
    }
}
