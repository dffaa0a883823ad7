//! Writes a study of many networks to a folder: page, figure, table of networks, numbers for machines.

use std::path::{Path, PathBuf};

use super::{Study, Summary, networks_csv, page};
use crate::error::Error;
use crate::{figure, report};

/// Writes the whole report into `folder`, which is made if it is not there; says where the page is.
///
/// Every file is replaced at once or not at all; the page comes last, so that it never links to what is not there.
///
/// # Errors
/// [`Error::CannotMakeFolder`], [`Error::Core`] (V102) for a file that cannot be written, or any error of [`Summary::of`];
/// after the last of these nothing is written.
pub fn write(study: &Study, folder: &Path) -> Result<PathBuf, Error> {
    let summary = Summary::of(study)?;
    let figures = [figure::share_by_size(&summary)];
    report::write_figures(&figures, folder)?;
    report::put(folder, "networks.csv", networks_csv::text(&summary).as_bytes())?;
    report::put(folder, "summary.json", (summary.to_json() + "\n").as_bytes())?;
    report::put(folder, "report.html", page::text(&summary, &figures).as_bytes())
}
