//! Writes a comparison to a folder: page, figures, table of days, numbers for machines.

use std::fs;
use std::path::{Path, PathBuf};

use vertifleet_core::write_atomically;

use crate::error::Error;
use crate::figure::Figure;
use crate::record::Study;
use crate::summary::Summary;
use crate::{days_csv, figure, page};

/// Where everything was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Paths {
    /// The page.
    pub report: PathBuf,
    /// Every policy's every day.
    pub days: PathBuf,
    /// All numbers of the page.
    pub summary: PathBuf,
    /// The figures, each as SVG and as PNG.
    pub figures: Vec<PathBuf>,
}

/// Whether there is or can be a folder of this name for a report, asked before the days are played. Leaves none behind that
/// was not there.
///
/// # Errors
/// [`Error::CannotMakeFolder`].
pub fn check_folder(folder: &Path) -> Result<(), Error> {
    let missing =
        folder.ancestors().take_while(|path| !path.as_os_str().is_empty() && !path.exists());
    let missing: Vec<&Path> = missing.collect();
    let made = make(folder);
    for path in missing {
        // Somebody else may have put something into it by now; then it stays.
        let _ = fs::remove_dir(path);
    }
    made
}

/// Writes the whole report of a study into `folder`, which is made if it is not there.
///
/// Every file is replaced at once or not at all; the page comes last, so that it never links to what is not there.
///
/// # Errors
/// [`Error::CannotMakeFolder`], [`Error::Core`] (V102) for a file that cannot be written, or any error of [`Summary::of`];
/// after the last of these nothing is written.
pub fn write(study: &Study, folder: &Path) -> Result<Paths, Error> {
    let summary = Summary::of(study)?;
    let figures = figure::all(&summary);
    Ok(Paths {
        figures: write_figures(&figures, folder)?,
        days: put(folder, "days.csv", days_csv::text(study).as_bytes())?,
        summary: put(folder, "summary.json", (summary.to_json() + "\n").as_bytes())?,
        report: put(folder, "report.html", page::text(&summary, &figures).as_bytes())?,
    })
}

/// Makes the folder and writes the figures into it, each as SVG and as PNG.
pub(crate) fn write_figures(figures: &[Figure], folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let pngs: Vec<Vec<u8>> = figures.iter().map(|figure| figure::png(&figure.svg)).collect();
    // Only now, so that a program that is ended before leaves no empty folder.
    make(folder)?;
    let mut pictures = Vec::with_capacity(2 * figures.len());
    for (figure, png) in figures.iter().zip(&pngs) {
        pictures.push(put(folder, &format!("{}.svg", figure.slug), figure.svg.as_bytes())?);
        pictures.push(put(folder, &format!("{}.png", figure.slug), png)?);
    }
    Ok(pictures)
}

fn make(folder: &Path) -> Result<(), Error> {
    fs::create_dir_all(folder)
        .map_err(|cause| Error::CannotMakeFolder { path: folder.to_owned(), cause })
}

pub(crate) fn put(folder: &Path, name: &str, contents: &[u8]) -> Result<PathBuf, Error> {
    let path = folder.join(name);
    write_atomically(&path, contents)?;
    Ok(path)
}
