//! A report as a page that opens offline, follows the reader's light or dark setting, and prints.
//!
//! The template escapes all text that it receives; only the figures and the style sheet, which the
//! program makes, are inserted unescaped. The page loads nothing: it contains its style and
//! figures, and its links lead to files in the same folder.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use vertifleet_picture::numbers::typeset;

use crate::figure::Figure;
use crate::report::{Files, Place, Report, Section, Table};

/// The only script of a page of this crate. It passes an address of a moment of the replay on to
/// the frame of the replay, which is loaded when the reader scrolls to it. The service allows this
/// script in the content security policy of the page.
pub const REPLAY_FRAME_SCRIPT: &str =
    "if (/[#&]at=/.test(location.hash)) document.querySelector('iframe.replay').scrollIntoView()";

impl Report<'_> {
    /// The report as a page.
    pub fn page(&self) -> String {
        let replay = (!self.replayed.is_empty()).then(|| crate::replay::page(self.replayed));
        self.page_with(replay.as_deref())
    }

    /// The report as a page that contains the page of its replay.
    pub(crate) fn page_with(&self, replay: Option<&str>) -> String {
        let sections = self.sections.iter().filter(|section| section.place != Place::Terminal);
        let page = html! {
            @match self.kind {
                Some(kind) => { (PreEscaped(format!("{}1 -->\n", kind.opening))) }
                None => { (DOCTYPE) }
            }
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    style { (PreEscaped(style())) }
                }
                body { main {
                    (self.head())
                    @for part in sections { (section(part, &self.files)) }
                    @if let Some(page) = replay { (self.replay(page)) }
                    (self.footer())
                } }
            }
        };
        page.into_string()
    }

    /// The tables as HTML for notebooks.
    pub fn tables_html(&self) -> String {
        let sections = self.sections.iter().filter(|section| section.place != Place::Page);
        let tables = html! {
            @for (position, section) in sections.filter(|one| one.table.is_some()).enumerate() {
                @if position > 0 || self.opening.is_empty() { p { (section.title) } }
                @if let Some(part) = &section.table { (plain_table(part)) }
            }
        };
        tables.into_string()
    }

    fn head(&self) -> Markup {
        html! {
            p.program { "Vertifleet " (env!("CARGO_PKG_VERSION")) " · " (self.subject) }
            h1 { (self.heading) }
            p.headline { (self.headline) }
            dl { @for (name, value) in &self.facts { div { dt { (name) } dd { (value) } } } }
            @for remark in &self.remarks { p { (remark) } }
            @if !self.command.is_empty() { pre { (self.command) } }
        }
    }

    /// The days that can be watched, in a separate frame, which isolates their style and scripts
    /// from the page.
    fn replay(&self, page: &str) -> Markup {
        let which = match self.replayed {
            [day] if day.plays.len() == 1 => "The day".to_owned(),
            [_] => "The first day as each policy played it".to_owned(),
            days => format!("The first {} days as each policy played them", days.len()),
        };
        html! {
            h2 id="replay" { "Replay" }
            p { (which) ": on a map and along its hours, from decision to decision."
                @if self.replayed.iter().any(|day| day.plays.len() > 1) {
                    " Two policies stand side by side with their first difference."
                }
                @if matches!(self.files, Files::Beside(_)) {
                    " The file " a href="replay.html" { "replay.html" } " shows the same in a whole window."
                } }
            iframe.replay title="Replay" loading="lazy" srcdoc=(page) {}
            script { (PreEscaped(REPLAY_FRAME_SCRIPT)) }
        }
    }

    /// Notes about the page, and links to the files in its folder.
    fn footer(&self) -> Markup {
        html! {
            footer {
                @for paragraph in &self.closing { p { (paragraph) } }
                @if let Files::Beside(files) = &self.files {
                    p { "Files in this folder: "
                        @for (position, file) in files.iter().enumerate() {
                            @if position > 0 { "; " }
                            a href=(file.name) { (file.name) } " (" (file.about) ")"
                        }
                        @for figure in self.figures() {
                            "; " a href={ (&figure.slug) ".svg" } { (&figure.slug) } " (" a href={ (&figure.slug) ".png" } { "PNG" } ")"
                        }
                        "." }
                }
            }
        }
    }

    /// The figures of all sections.
    pub(crate) fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.sections.iter().flat_map(|section| &section.figures)
    }
}

fn style() -> String {
    let figures = vertifleet_picture::palette::style_sheet();
    format!(
        "{}@media screen and (prefers-color-scheme:dark){{{figures}}}\n",
        include_str!("page/style.css")
    )
}

fn section(section: &Section, files: &Files<'_>) -> Markup {
    html! {
        @if !section.title.is_empty() {
            h2 id=[section.figures.first().map(|figure| &figure.slug)] { (section.title) }
        }
        @if !section.notes.is_empty() { p.lead { (sentences(&section.notes)) } }
        @for figure in &section.figures { (picture(figure, files)) }
        @if let Some(part) = &section.table { (table(part)) }
        @if let Some(below) = &section.below { (below) }
    }
}

/// Notes as sentences: each begins with a capital letter and ends with a full stop.
pub(crate) fn sentences(notes: &[String]) -> String {
    let sentence = |note: &String| {
        let mut letters = note.chars();
        let first = letters.next().into_iter().flat_map(char::to_uppercase);
        let end = if note.ends_with('.') { "" } else { "." };
        first.chain(letters).chain(end.chars()).collect::<String>()
    };
    notes.iter().map(sentence).collect::<Vec<_>>().join(" ")
}

/// A figure with its caption.
fn picture(figure: &Figure, files: &Files<'_>) -> Markup {
    html! {
        figure.day[matches!(files, Files::Within(_))] {
            (PreEscaped(&figure.svg))
            figcaption {
                (figure.caption)
                @if let Files::Within(stem) = files {
                    @let name = format!("{stem}-{}", figure.slug);
                    " As a file: "
                    a download={ (name) ".svg" } href=(data_link("image/svg+xml", figure.svg.as_bytes())) { "SVG" } ", "
                    a download={ (name) ".png" } href=(data_link("image/png", &vertifleet_picture::png(&figure.svg))) { "PNG" } "."
                }
            }
        }
    }
}

/// A link that contains its target, so that the page stays one file.
fn data_link(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", STANDARD.encode(bytes))
}

fn table(Table { rows, best }: &Table) -> Markup {
    let Some((names, rows)) = rows.split_first() else { return html! {} };
    html! {
        div.wide { table {
            thead { tr { @for name in names { th scope="col" { (name) } } } }
            tbody { @for (position, row) in rows.iter().enumerate() {
                tr.best[best.contains(&position)] { @for (column, text) in row.iter().enumerate() {
                    @if column == 0 { th scope="row" title=(text) { (cell(text)) } } @else { td { (cell(text)) } }
                } }
            } }
        } }
    }
}

/// A cell as typeset: numbers with a true minus sign, intervals small, pairs with an arrow, names
/// unchanged.
fn cell(text: &str) -> Markup {
    let (mean, interval) = match text.split_once(" ± ") {
        Some((mean, half_width)) => (mean, Some(half_width)),
        None => (text, None),
    };
    let is_number = mean.starts_with('-');
    let mean = if is_number { typeset(mean) } else { mean.replace(" -> ", " → ") };
    html! { (mean) @if let Some(interval) = interval { small { " ± " (interval) } } }
}

fn plain_table(Table { rows, .. }: &Table) -> Markup {
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
