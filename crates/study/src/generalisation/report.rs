//! Writes a study of many networks to a folder: page, figure, table of networks, numbers for machines.

use std::path::{Path, PathBuf};

use super::{GeneralisationRecords, GeneralisationReport, networks_csv, page};
use crate::error::Error;
use crate::{figure, report};

/// Where a report was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The page.
    pub report: PathBuf,
    /// Where a folder is kept that was there before and held something else.
    pub kept: Option<PathBuf>,
}

/// Writes the whole report into `folder`, or nothing, as [`report::write`] does.
///
/// # Errors
/// As [`report::write`].
pub fn write(study: &GeneralisationRecords, folder: &Path, force: bool) -> Result<Written, Error> {
    let summary = GeneralisationReport::of(study)?;
    let figures = [figure::share_by_size(&summary)];
    let mut files = report::pictures(&figures);
    files.extend([
        ("networks.csv".to_owned(), networks_csv::text(&summary).into_bytes()),
        ("summary.json".to_owned(), (summary.to_json() + "\n").into_bytes()),
        ("report.html".to_owned(), page::text(&summary, &figures).into_bytes()),
    ]);
    let kept = report::replace(folder, force, &files)?;
    Ok(Written { report: folder.join("report.html"), kept })
}
