//! Folders that are written as a whole: all files of one run, or what was there before.

use std::fs::{self, Metadata};
use std::io;
use std::path::{Path, PathBuf};

use crate::files::{UNFINISHED, origin, writing};
use crate::output_error::OutputError;
use crate::outputs::folder_of;
use crate::{Error, OutputKind};

/// What a folder holds that this program wrote, and how to know one again.
#[derive(Debug, Clone, Copy)]
pub struct FolderKind {
    /// What people call it, as in "no report".
    pub name: &'static str,
    /// A file that is in every one of them, and the kinds that it may be of.
    pub mark: (&'static str, &'static [OutputKind]),
    /// Whether a file of this name may be in it.
    pub holds: fn(&str) -> bool,
}

impl FolderKind {
    /// Whether all that is in the folder was written by this program, as far as names and the mark tell.
    fn is_of(&self, folder: &Path) -> io::Result<bool> {
        let (mark, kinds) = self.mark;
        let mut empty = true;
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            let name = entry.file_name();
            // The Finder leaves one in every folder that it shows.
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

/// Whether a folder of this kind may be put where this one is, if there is one: it is empty or of the same kind, and nothing in it
/// is read-only, or `force` is given.
///
/// # Errors
/// [`OutputError`], or [`Error::CannotWrite`] where no folder can be or something is in the way.
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

/// The first that is read-only of a folder and its files.
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

/// Why no folder can take this one's place, found before the work is done.
fn irreplaceable(path: &Path, former: &Metadata) -> Option<&'static str> {
    let target = path.canonicalize().ok()?;
    let here = std::env::current_dir().and_then(|here| here.canonicalize());
    if here.is_ok_and(|here| here.starts_with(&target)) {
        return Some("the program runs in this folder; name one inside it");
    }
    let above = fs::metadata(target.parent()?).ok()?;
    is_mounted(former, &above)
        .then_some("another disk begins at this folder; name a folder inside it")
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

/// Puts a folder with these files, by name, in the place of `path`: all of them, or everything is as it was before. A link is followed,
/// and folders above that are not there are made.
///
/// A folder that was there is removed if it is of the same kind. Any other is kept under a name of its own, which is returned; that
/// takes `force`.
///
/// The new folder is made beside the old one and the two change places by two renames. A process that is killed just between them
/// leaves both in a folder whose name begins with `.vertifleet-`.
///
/// # Errors
/// As [`check_folder`]; [`Error::CannotWrite`] where the disk is full, for example.
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
            // Another program may have put something into it by now; then it stays.
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
    // Removed with all that is in it at the end, however that comes. The names of what is in between would only confuse a message,
    // so the kind of error must do.
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

/// `out.old`, or the first such name that is free.
fn free_name(target: &Path) -> PathBuf {
    let name = target.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let numbered = (2..).map(|number| target.with_file_name(format!("{name}.old-{number}")));
    let mut names = std::iter::once(target.with_file_name(format!("{name}.old"))).chain(numbered);
    names.find(|path| !path.exists()).expect("one of endlessly many names is free")
}
