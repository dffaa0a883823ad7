//! A report as a folder: a page, figures and tables.

use std::fs;
use std::path::{Path, PathBuf};

use vertifleet_core::{FolderKind, OutputKind, replace_folder, write_atomically};
use vertifleet_study::{Error, make_folder, size, sweep};

use crate::report::{Files, Report};

/// A file of a report: its name and its content.
pub type File = (String, Vec<u8>);

/// The paths of a report that was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The page.
    pub page: PathBuf,
    /// The new path of a folder with other content, which was moved away.
    pub kept: Option<PathBuf>,
}

/// The kind of a `summary.json` whose format begins with this text, in any version.
const fn summary_of(opening: &'static str) -> OutputKind {
    OutputKind { name: "report", skipped: 0, opening }
}

/// Whether a file of this name belongs to the report of every kind.
fn is_common(name: &str) -> bool {
    let end = Path::new(name).extension();
    let is_figure =
        name.starts_with("figure-") && end.is_some_and(|end| end == "svg" || end == "png");
    is_figure || name == "report.html" || name == "summary.json"
}

/// The folder of the report of a comparison or a board.
pub const REPORT: FolderKind = FolderKind {
    name: "report",
    mark: (
        "summary.json",
        &[
            summary_of("{\n  \"format\": \"vertifleet-comparison/"),
            summary_of("{\n  \"format\": \"vertifleet-board/"),
        ],
    ),
    holds: |name| is_common(name) || ["replay.html", "days.csv", "board.md"].contains(&name),
};

/// The folder of a sweep, with its journal.
pub const SWEEP: FolderKind = FolderKind {
    name: "sweep",
    mark: (sweep::JOURNAL, &[sweep::JOURNAL_KIND]),
    holds: |name| {
        is_common(name)
            || [sweep::JOURNAL, "cells.csv", "cells.parquet", "days.csv", "days.parquet"]
                .contains(&name)
    },
};

/// The folder of a search for a design, with its journal.
pub const SIZE: FolderKind = FolderKind {
    name: "search for a design",
    mark: (size::JOURNAL, &[size::JOURNAL_KIND]),
    holds: |name| is_common(name) || [size::JOURNAL, "designs.csv", "best.toml"].contains(&name),
};

/// Checks, before the days are played, that a report may be written to this folder. It must be
/// empty, contain an earlier report, or not exist yet; or `force` must be given. The check leaves
/// no folder behind.
///
/// # Errors
/// Returns [`Error::CannotMakeFolder`], or [`Error::Core`] for a folder that contains anything else
/// (V143) or is read-only (V144).
pub fn check(folder: &Path, force: bool) -> Result<(), Error> {
    let missing =
        folder.ancestors().take_while(|path| !path.as_os_str().is_empty() && !path.exists());
    let missing: Vec<&Path> = missing.collect();
    let made = make_folder(folder);
    for path in missing {
        // Another program may have written to the folder in the meantime; then it stays.
        let _ = fs::remove_dir(path);
    }
    made?;
    Ok(vertifleet_core::check_folder(folder, &REPORT, force)?)
}

/// Writes the whole report of a comparison or a board into `folder`, or nothing; the folder is
/// created if it does not exist. An earlier report in it is replaced. With `force`, a folder with
/// other content is renamed and kept in the same place.
///
/// # Errors
/// The same as those of [`check`], and [`Error::Core`] (V102) if the report cannot be written. An
/// error leaves all files as they were.
pub fn write(report: &Report<'_>, folder: &Path, force: bool) -> Result<Written, Error> {
    let files = files(report);
    check(folder, force)?;
    let kept = replace_folder(folder, &REPORT, force, &files)?;
    Ok(Written { page: folder.join("report.html"), kept })
}

/// Writes a report into the folder of its journal and returns the path of the page. Each file is
/// written completely or not at all.
///
/// # Errors
/// Returns [`Error::Core`] (V102) if a file cannot be written.
pub fn write_beside_journal(report: &Report<'_>, folder: &Path) -> Result<PathBuf, Error> {
    for (name, content) in files(report) {
        write_atomically(&folder.join(name), &content)?;
    }
    Ok(folder.join("report.html"))
}

/// All files of a report; `report.html` is the page.
pub fn files(report: &Report<'_>) -> Vec<File> {
    let mut files: Vec<File> = Vec::new();
    for figure in report.figures() {
        files.push((format!("{}.svg", figure.slug), figure.svg.clone().into_bytes()));
        files.push((format!("{}.png", figure.slug), vertifleet_picture::png(&figure.svg)));
    }
    if let Files::Beside(data) = &report.files {
        files.extend(data.iter().map(|file| (file.name.to_owned(), (file.content)())));
    }
    let replay = (!report.replayed.is_empty()).then(|| crate::replay::page(report.replayed));
    files.push(("report.html".to_owned(), report.page_with(replay.as_deref()).into_bytes()));
    files.extend(replay.map(|page| ("replay.html".to_owned(), page.into_bytes())));
    files
}
