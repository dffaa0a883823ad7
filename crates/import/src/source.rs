//! The bytes of a planner's file, unpacked if the file is compressed with gzip or is a zip archive
//! of one file.
//!
//! Files are recognised by their first bytes, so that a workbook with a name in `.csv` is refused
//! as a workbook.

use std::fs::File;
use std::io::{Cursor, ErrorKind, Read, Seek};
use std::path::Path;

use flate2::read::MultiGzDecoder;
use vertifleet_core::{Error as CoreError, FormatError, read_at_most};
use zip::ZipArchive;
use zip::result::ZipError;

use crate::Error;
use crate::error::shortened;

/// The longest file that is read whole, packed or unpacked.
pub(crate) const LONGEST: u64 = 16 << 20;
/// Number of first bytes by which a file is recognised.
const OPENING: usize = 16;

/// Files that planners have and that hold no table or map that can be read: their first bytes, what
/// they are, and what to do with them.
const OTHERS: [(&[u8], &str); 11] = [
    (b"\xd0\xcf\x11\xe0", "an Excel workbook: save its sheet as CSV"),
    (b"BZh", "compressed with bzip2: unpack it, or compress it with gzip"),
    (b"\x28\xb5\x2f\xfd", "compressed with Zstandard: unpack it, or compress it with gzip"),
    (b"\xfd7zXZ\0", "compressed with xz: unpack it, or compress it with gzip"),
    (b"7z\xbc\xaf", "a 7-Zip archive: unpack it, or compress it with gzip"),
    (b"SQLite format 3", "a SQLite database, perhaps a GeoPackage: export CSV or GeoJSON from it"),
    (b"\0\0\x27\x0a", "a shapefile: export GeoJSON from it, in longitude and latitude (WGS 84)"),
    (b"ARROW1", "an Arrow file (Feather): write it as Parquet or CSV"),
    (b"%PDF", "a PDF document: save the table as CSV"),
    (b"<", "an XML or HTML document: export CSV or GeoJSON"),
    (b"{\\rtf", "a document of a word processor: save the table as CSV"),
];

/// How a file is compressed.
#[derive(Debug, Clone, Copy)]
enum Packing {
    None,
    Gzip,
    Zip,
}

impl Packing {
    /// The packing of a file that begins with these bytes. Refuses files that hold neither a table
    /// nor a map.
    fn of(opening: &[u8], origin: &str) -> Result<Self, Error> {
        if opening.starts_with(b"\x1f\x8b") {
            return Ok(Self::Gzip);
        }
        if opening.starts_with(b"PK\x03\x04") || opening.starts_with(b"PK\x05\x06") {
            return Ok(Self::Zip);
        }
        match OTHERS.into_iter().find(|(first, _)| opening.starts_with(first)) {
            Some((_, problem)) => Err(not_a_table(origin, format!("it is {problem}"))),
            None => Ok(Self::None),
        }
    }
}

/// Reads a file whole.
pub(crate) fn read_whole(path: &Path) -> Result<Vec<u8>, Error> {
    let origin = path.display().to_string();
    let bytes = read_at_most(path, LONGEST)?;
    let packing = Packing::of(&bytes, &origin)?;
    if matches!(packing, Packing::None) {
        return Ok(bytes);
    }
    unpack(packing, Cursor::new(bytes), &origin, |reader| {
        let mut bytes = Vec::new();
        let read = reader.take(LONGEST + 1).read_to_end(&mut bytes);
        read.map_err(|cause| cannot_read(path, cause))?;
        if bytes.len() as u64 > LONGEST {
            return Err(FormatError::FileTooLarge { limit: LONGEST }.in_file(&origin).into());
        }
        Packing::of(&bytes, &origin)?;
        Ok(bytes)
    })
}

/// Calls `read` with the unpacked bytes of a long file. `meter` wraps the file and reports how far
/// it has been read.
pub(crate) fn read_through<F, T>(
    path: &Path,
    meter: impl FnOnce(File) -> F,
    read: impl FnOnce(&mut (dyn Read + Send)) -> Result<T, Error>,
) -> Result<T, Error>
where
    F: Read + Seek + Send,
{
    let origin = path.display().to_string();
    let opening = opening(path)?;
    let packing = Packing::of(&opening, &origin)?;
    let file = File::open(path).map_err(|cause| cannot_read(path, cause))?;
    unpack(packing, meter(file), &origin, read)
}

/// The first bytes of a file.
pub(crate) fn opening(path: &Path) -> Result<Vec<u8>, Error> {
    let mut opening = Vec::new();
    let file = File::open(path).map_err(|cause| cannot_read(path, cause))?;
    match file.take(OPENING as u64).read_to_end(&mut opening) {
        Err(cause) if cause.kind() != ErrorKind::UnexpectedEof => Err(cannot_read(path, cause)),
        _ => Ok(opening),
    }
}

pub(crate) fn cannot_read(path: &Path, cause: std::io::Error) -> Error {
    CoreError::CannotRead { origin: path.display().to_string(), cause }.into()
}

fn unpack<T>(
    packing: Packing,
    mut file: impl Read + Seek + Send,
    origin: &str,
    read: impl FnOnce(&mut (dyn Read + Send)) -> Result<T, Error>,
) -> Result<T, Error> {
    match packing {
        Packing::None => read(&mut file),
        Packing::Gzip => read(&mut MultiGzDecoder::new(file)),
        Packing::Zip => {
            let damaged = |error: ZipError| {
                not_a_table(origin, format!("its zip archive is damaged: {error}"))
            };
            let mut archive = ZipArchive::new(file).map_err(damaged)?;
            let only = only_file(&archive, origin)?;
            read(&mut archive.by_index(only).map_err(damaged)?)
        }
    }
}

/// The position of the only file of an archive.
fn only_file<R: Read + Seek>(archive: &ZipArchive<R>, origin: &str) -> Result<usize, Error> {
    let refuse = |problem: String| Err(not_a_table(origin, problem));
    let names = || (0..archive.len()).filter_map(|at| Some((at, archive.name_for_index(at)?)));
    let has = |wanted: &str| names().any(|(_, name)| name.eq_ignore_ascii_case(wanted));
    if has("[Content_Types].xml") {
        return refuse("it is an Excel workbook: save its sheet as CSV".to_owned());
    }
    if has("content.xml") {
        return refuse("it is an OpenDocument file: save its sheet as CSV".to_owned());
    }
    // macOS adds a folder `__MACOSX` to the archives that it makes.
    let plain = |name: &str| !name.ends_with('/') && !name.starts_with("__MACOSX/");
    let files: Vec<(usize, &str)> = names().filter(|(_, name)| plain(name)).collect();
    let of_map = |(_, name): &(usize, &str)| name.to_ascii_lowercase().ends_with(".shp");
    if files.iter().any(of_map) {
        let problem =
            "it is a shapefile: export GeoJSON from it, in longitude and latitude (WGS 84)";
        return refuse(problem.to_owned());
    }
    match files.as_slice() {
        [(at, _)] => Ok(*at),
        [] => refuse("its zip archive has no file".to_owned()),
        [(_, first), (_, second), ..] => refuse(format!(
            "its zip archive has {} files, such as {:?} and {:?}: unpack the one that is meant",
            files.len(),
            shortened(first, 60),
            shortened(second, 60),
        )),
    }
}

fn not_a_table(origin: &str, problem: String) -> Error {
    Error::NotParsed { origin: origin.to_owned(), kind: "a table or map", problem }
}
