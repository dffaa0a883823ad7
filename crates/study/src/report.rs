//! How studies are shown: as text, as JSON, and as a folder with a page, figures and tables. The
//! folder is replaced as a whole, so a page never stands beside the figures of another run.

use std::fs;
use std::path::{Path, PathBuf};

use vertifleet_core::{FolderKind, OutputKind, replace_folder};

use crate::error::Error;
use crate::figure::Figure;

/// A file of a report: its name and its content.
pub type File = (String, Vec<u8>);

/// The records of a study, in the forms in which they are shown.
pub trait Records {
    /// The study as a table for a terminal, without a line end after the last line.
    ///
    /// # Errors
    /// Returns [`Error::Empty`], [`Error::Unpaired`] or [`Error::NotFinite`] if the records are not
    /// those of policies on the same days.
    fn text(&self) -> Result<String, Error>;

    /// The numbers of the study as JSON.
    ///
    /// # Errors
    /// The same as those of [`text`](Self::text).
    fn json(&self) -> Result<String, Error>;

    /// The files of the study's report; `report.html` is the page.
    ///
    /// # Errors
    /// The same as those of [`text`](Self::text).
    fn files(&self) -> Result<Vec<File>, Error>;
}

/// The places where a report was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The page.
    pub page: PathBuf,
    /// The new place of a folder that was in the way and held something else.
    pub kept: Option<PathBuf>,
}

/// The kind of a `summary.json` that begins with this format, in any version.
const fn summary_of(opening: &'static str) -> OutputKind {
    OutputKind { name: "report", skipped: 0, opening }
}

/// Whether a file of this name is a picture of a figure.
pub(crate) fn is_figure(name: &str) -> bool {
    let end = Path::new(name).extension();
    name.starts_with("figure-") && end.is_some_and(|end| end == "svg" || end == "png")
}

/// A folder that holds a report and nothing else.
pub(crate) const FOLDER: FolderKind = FolderKind {
    name: "report",
    mark: ("summary.json", &[summary_of("{\n  \"format\": \"vertifleet-comparison/")]),
    holds: |name| {
        is_figure(name)
            || ["report.html", "replay.html", "summary.json", "days.csv"].contains(&name)
    },
};

/// Checks, before the days are played, that a report may be written to this folder: it can be
/// created, is empty, or holds an earlier report, or `force` is given. A folder that did not exist
/// before does not exist afterwards.
///
/// # Errors
/// Returns [`Error::CannotMakeFolder`], or [`Error::Core`] for a folder that holds something else
/// (V143) or is read-only (V144).
pub fn check_folder(folder: &Path, force: bool) -> Result<(), Error> {
    let missing =
        folder.ancestors().take_while(|path| !path.as_os_str().is_empty() && !path.exists());
    let missing: Vec<&Path> = missing.collect();
    let made = fs::create_dir_all(folder)
        .map_err(|cause| Error::CannotMakeFolder { path: folder.to_owned(), cause });
    for path in missing {
        // Another program may have put something into the folder by now; then it stays.
        let _ = fs::remove_dir(path);
    }
    made?;
    Ok(vertifleet_core::check_folder(folder, &FOLDER, force)?)
}

/// Writes the whole report of a study into `folder`, or nothing; the folder is created if it does
/// not exist. An earlier report in it is replaced; with `force`, a folder with other content is
/// kept beside it.
///
/// # Errors
/// The same as those of [`check_folder`] and [`Records::text`], and [`Error::Core`] (V102) if the
/// report cannot be written. After an error everything is as it was.
pub fn write(study: &impl Records, folder: &Path, force: bool) -> Result<Written, Error> {
    let files = study.files()?;
    check_folder(folder, force)?;
    let kept = replace_folder(folder, &FOLDER, force, &files)?;
    Ok(Written { page: folder.join("report.html"), kept })
}

/// The figures, each as SVG and as PNG, with the names of their files.
pub(crate) fn pictures(figures: &[Figure]) -> Vec<File> {
    let both = |figure: &Figure| {
        [
            (format!("{}.svg", figure.slug), figure.svg.clone().into_bytes()),
            (format!("{}.png", figure.slug), vertifleet_picture::png(&figure.svg)),
        ]
    };
    figures.iter().flat_map(both).collect()
}
