//! Folders that are written as a whole: afterwards a folder has either all files of one run or its
//! former contents.

use std::fs::{self, Metadata};
use std::io;
use std::path::{Path, PathBuf};

use super::files::{UNFINISHED, writing};
use crate::paths::{folder_of, origin};
use crate::{Error, OutputError, OutputKind};

/// A kind of folder that this program writes, and how to recognise one.
#[derive(Debug, Clone, Copy)]
pub struct FolderKind {
    /// The word for it in messages, as in "no report".
    pub name: &'static str,
    /// The name of a file that every folder of this kind has, and the kinds that the file may be
    /// of.
    pub mark: (&'static str, &'static [OutputKind]),
    /// Whether a folder of this kind may hold a file of this name.
    pub holds: fn(&str) -> bool,
}

impl FolderKind {
    /// Whether everything in the folder was written by this program, judged by the names and the
    /// mark.
    fn is_of(&self, folder: &Path) -> io::Result<bool> {
        let (mark, kinds) = self.mark;
        let mut empty = true;
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            let name = entry.file_name();
            // The Finder leaves a `.DS_Store` in every folder that it shows.
            let known = name.to_str().is_some_and(|name| (self.holds)(name) || name == ".DS_Store");
            if !known || !entry.file_type()?.is_file() {
                return Ok(false);
            }
            empty = false;
        }
        let marked = |kind: &OutputKind| kind.is_of(&folder.join(mark)).unwrap_or(false);
        Ok(empty || kinds.iter().any(marked))
    }
}

/// Checks that a folder of this kind may replace the one at `path`, if there is one. It may if the
/// old folder is empty or of the same kind and nothing in it is read-only, or if `force` is given.
///
/// # Errors
/// [`OutputError`], or [`Error::CannotWrite`] where no folder can be written or something is in the
/// way.
pub fn check_folder(path: &Path, kind: &FolderKind, force: bool) -> Result<(), Error> {
    let cannot = |cause| Error::CannotWrite { origin: origin(path), cause };
    let Ok(former) = fs::metadata(path) else { return Ok(()) };
    if !former.is_dir() {
        return Err(cannot(io::ErrorKind::NotADirectory.into()));
    }
    if let Some(why) = irreplaceable(path, &former) {
        return Err(cannot(io::Error::other(why)));
    }
    if force {
        return Ok(());
    }
    if !kind.is_of(path).map_err(cannot)? {
        return Err(OutputError::NotOurs { origin: origin(path), kind: kind.name }.into());
    }
    match read_only_in(path, &former).map_err(cannot)? {
        Some(file) => Err(OutputError::ReadOnly { origin: origin(&file) }.into()),
        None => Ok(()),
    }
}

/// The folder or the first of its files that is read-only.
fn read_only_in(folder: &Path, former: &Metadata) -> io::Result<Option<PathBuf>> {
    if former.permissions().readonly() {
        return Ok(Some(folder.to_owned()));
    }
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.metadata()?.permissions().readonly() {
            return Ok(Some(entry.path()));
        }
    }
    Ok(None)
}

/// The reason why no other folder can replace this one. It is looked for before the work is done.
fn irreplaceable(path: &Path, former: &Metadata) -> Option<&'static str> {
    let target = path.canonicalize().ok()?;
    let here = std::env::current_dir().and_then(|here| here.canonicalize());
    if here.is_ok_and(|here| here.starts_with(&target)) {
        return Some("the program runs in this folder; name one inside it");
    }
    let above = fs::metadata(target.parent()?).ok()?;
    is_mounted(former, &above).then_some("this folder is a mount point; name a folder inside it")
}

#[cfg(unix)]
fn is_mounted(folder: &Metadata, above: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    folder.dev() != above.dev()
}

#[cfg(not(unix))]
fn is_mounted(_: &Metadata, _: &Metadata) -> bool {
    false
}

/// Replaces the folder at `path` by one with these files, given by name. Either all of them are
/// written, or everything stays as it was before. A link is followed, and missing parents are
/// created.
///
/// A former folder is removed if it is of the same kind. Any other is kept under another name,
/// which is returned; that requires `force`.
///
/// The new folder is made next to the old one, and two renames exchange them. A process that is
/// killed just between the renames leaves both in a folder whose name begins with `.vertifleet-`.
///
/// # Errors
/// The errors of [`check_folder`], and [`Error::CannotWrite`], for example where the disk is full.
pub fn replace_folder(
    path: &Path,
    kind: &FolderKind,
    force: bool,
    files: &[(String, Vec<u8>)],
) -> Result<Option<PathBuf>, Error> {
    check_folder(path, kind, force)?;
    let cannot = |cause| Error::CannotWrite { origin: origin(path), cause };
    let target = path.canonicalize().or_else(|_| std::path::absolute(path)).map_err(cannot)?;
    let above = folder_of(&target);
    let missing: Vec<&Path> = above.ancestors().take_while(|folder| !folder.exists()).collect();
    let replaced = fs::create_dir_all(above).and_then(|()| replace(&target, kind, files));
    if replaced.is_err() {
        for folder in missing {
            // Another program may have put something into the folder by now; then it stays.
            let _ = fs::remove_dir(folder);
        }
    }
    replaced.map_err(cannot)
}

fn replace(
    target: &Path,
    kind: &FolderKind,
    files: &[(String, Vec<u8>)],
) -> io::Result<Option<PathBuf>> {
    let _writing = writing();
    let above = folder_of(target);
    // This temporary folder is removed with all its contents when the function returns, also on an
    // error. Its name would only confuse a message, so only the kind of the error is kept.
    let between = tempfile::Builder::new().prefix(UNFINISHED).tempdir_in(above);
    let between = between.map_err(|error| io::Error::from(error.kind()))?;
    let fresh = between.path().join("new");
    fs::create_dir(&fresh)?;
    for (name, contents) in files {
        fs::write(fresh.join(name), contents)?;
    }
    let Ok(former) = fs::metadata(target) else {
        fs::rename(&fresh, target)?;
        return Ok(None);
    };
    fs::set_permissions(&fresh, former.permissions())?;
    let kept = if kind.is_of(target)? { None } else { Some(free_name(target)) };
    let aside = kept.clone().unwrap_or_else(|| between.path().join("former"));
    fs::rename(target, &aside)?;
    if let Err(error) = fs::rename(&fresh, target) {
        fs::rename(&aside, target)?;
        return Err(error);
    }
    Ok(kept)
}

/// `out.old`, or else the first free name of `out.old-2`, `out.old-3` and so on.
fn free_name(target: &Path) -> PathBuf {
    let name = target.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let numbered = (2..).map(|number| target.with_file_name(format!("{name}.old-{number}")));
    let mut names = std::iter::once(target.with_file_name(format!("{name}.old"))).chain(numbered);
    names.find(|path| !path.exists()).expect("one of endlessly many names is free")
}
