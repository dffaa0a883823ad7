//! How studies are shown: as text, as JSON, and as a folder with a page, figures and tables. The folder is replaced as a whole, so
//! that a page never stands beside figures of another run.

use std::fs;
use std::path::{Path, PathBuf};

use vertifleet_core::{FolderKind, OutputKind, replace_folder};

use crate::error::Error;
use crate::figure::Figure;
use crate::record::ComparisonRecords;
use crate::summary::ComparisonReport;
use crate::{days_csv, figure, page, table};

/// A file of a report: its name and what it holds.
pub type File = (String, Vec<u8>);

/// What a study leaves behind, which can be shown.
pub trait Records {
    /// The study as a table for a terminal. No line end after the last line.
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::Unpaired`] or [`Error::NotFinite`] if the records are not those of policies on the same days.
    fn text(&self) -> Result<String, Error>;

    /// Its numbers for machines.
    ///
    /// # Errors
    /// As [`text`](Self::text).
    fn json(&self) -> Result<String, Error>;

    /// The files of its report, of which `report.html` is the page.
    ///
    /// # Errors
    /// As [`text`](Self::text).
    fn files(&self) -> Result<Vec<File>, Error>;
}

/// Where a report was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The page.
    pub page: PathBuf,
    /// Where a folder is kept that was there before and held something else.
    pub kept: Option<PathBuf>,
}

/// What stands first in the numbers for machines, of any version of the format.
const fn summary_of(opening: &'static str) -> OutputKind {
    OutputKind { name: "report", skipped: 0, opening }
}

/// A folder that holds a report of a comparison or of many networks, and nothing else.
pub(crate) const FOLDER: FolderKind = FolderKind {
    name: "report",
    mark: (
        "summary.json",
        &[
            summary_of("{\n  \"format\": \"vertifleet-comparison/"),
            summary_of("{\n  \"format\": \"vertifleet-generalisation/"),
        ],
    ),
    holds: |name| {
        let end = Path::new(name).extension();
        let picture = end.is_some_and(|end| end == "svg" || end == "png");
        (picture && name.starts_with("figure-"))
            || ["report.html", "summary.json", "days.csv", "networks.csv"].contains(&name)
    },
};

/// Whether a report may be written to this folder, asked before the days are played: it can be made, is empty or holds an earlier
/// report, or `force` is given. Leaves no folder behind that was not there.
///
/// # Errors
/// [`Error::CannotMakeFolder`], or [`Error::Core`] for a folder that holds something else (V143) or is read-only (V144).
pub fn check_folder(folder: &Path, force: bool) -> Result<(), Error> {
    let missing =
        folder.ancestors().take_while(|path| !path.as_os_str().is_empty() && !path.exists());
    let missing: Vec<&Path> = missing.collect();
    let made = fs::create_dir_all(folder)
        .map_err(|cause| Error::CannotMakeFolder { path: folder.to_owned(), cause });
    for path in missing {
        // Another program may have put something into it by now; then it stays.
        let _ = fs::remove_dir(path);
    }
    made?;
    Ok(vertifleet_core::check_folder(folder, &FOLDER, force)?)
}

/// Writes the whole report of a study into `folder`, or nothing; the folder is made if it is not there. An earlier report in it
/// is replaced, and what else may be there is kept beside it, which takes `force`.
///
/// # Errors
/// As [`check_folder`]; [`Error::Core`] (V102) where it cannot be written, or as [`Records::text`]. Everything is as it was then.
pub fn write(study: &impl Records, folder: &Path, force: bool) -> Result<Written, Error> {
    let files = study.files()?;
    check_folder(folder, force)?;
    let kept = replace_folder(folder, &FOLDER, force, &files)?;
    Ok(Written { page: folder.join("report.html"), kept })
}

impl Records for ComparisonRecords {
    fn text(&self) -> Result<String, Error> {
        Ok(table::text(&ComparisonReport::of(self)?))
    }

    fn json(&self) -> Result<String, Error> {
        Ok(ComparisonReport::of(self)?.to_json())
    }

    fn files(&self) -> Result<Vec<File>, Error> {
        let summary = ComparisonReport::of(self)?;
        let figures = figure::all(&summary);
        let mut files = pictures(&figures);
        files.extend([
            ("days.csv".to_owned(), days_csv::text(self).into_bytes()),
            ("summary.json".to_owned(), (summary.to_json() + "\n").into_bytes()),
            ("report.html".to_owned(), page::text(&summary, &figures).into_bytes()),
        ]);
        Ok(files)
    }
}

/// The figures, each as SVG and as PNG, by the names of their files.
pub(crate) fn pictures(figures: &[Figure]) -> Vec<File> {
    let both = |figure: &Figure| {
        [
            (format!("{}.svg", figure.slug), figure.svg.clone().into_bytes()),
            (format!("{}.png", figure.slug), figure::png(&figure.svg)),
        ]
    };
    figures.iter().flat_map(both).collect()
}
