//! The bytes of a planner's file, unpacked if the file is compressed with gzip or is a zip archive
//! of one file.
//!
//! Files are recognised by their first bytes, so that a workbook with a name in `.csv` is refused
//! as a workbook.

use std::fs::File;
use std::io::{Cursor, Read, Seek};

use flate2::read::MultiGzDecoder;
use vertifleet_core::FormatError;
use zip::ZipArchive;
use zip::result::ZipError;

use crate::Error;
use crate::error::shortened;
use crate::input_file::InputFile;
use crate::table::without_mark;

/// The longest file that is read whole, packed or unpacked.
pub(crate) const LONGEST: u64 = 16 << 20;
/// Number of first bytes by which a file is recognised.
const OPENING: u64 = 4_096;

/// Files that planners have and that hold no table or map that can be read: their first bytes, what
/// they are, and what to do with them.
const OTHERS: [(&[u8], &str); 19] = [
    (
        b"\x89HDF\r\n\x1a\n",
        "an HDF5 file, perhaps an OMX matrix: write its table as CSV with period,from,to,passengers",
    ),
    (b"fgb\x03", "a FlatGeobuf file: export GeoJSON from it, in longitude and latitude (WGS 84)"),
    (b"FEA1", "a Feather file: write it as Parquet or CSV"),
    (b"CDF\x01", "a NetCDF file: write its table as CSV"),
    (b"CDF\x02", "a NetCDF file: write its table as CSV"),
    (b"Obj\x01", "an Avro file: write it as Parquet or CSV"),
    (b"\x93NUMPY", "a NumPy array: write it as CSV with the names of its columns"),
    (b"\xd0\xcf\x11\xe0", "an Excel workbook: save its sheet as CSV"),
    (b"BZh", "compressed with bzip2: unpack it, or compress it with gzip"),
    (b"\x28\xb5\x2f\xfd", "compressed with Zstandard: unpack it, or compress it with gzip"),
    (b"\xfd7zXZ\0", "compressed with xz: unpack it, or compress it with gzip"),
    (b"7z\xbc\xaf", "a 7-Zip archive: unpack it, or compress it with gzip"),
    (b"SQLite format 3", "a SQLite database, perhaps a GeoPackage: export CSV or GeoJSON from it"),
    (b"\0\0\x27\x0a", "a shapefile: export GeoJSON from it, in longitude and latitude (WGS 84)"),
    (b"ARROW1", "an Arrow file (Feather): write it as Parquet or CSV"),
    (b"\xff\xff\xff\xff", "an Arrow IPC stream: write it as Parquet or CSV"),
    (b"%PDF", "a PDF document: save the table as CSV"),
    (b"<", "an XML or HTML document: export CSV or GeoJSON"),
    (b"{\\rtf", "a document of a word processor: save the table as CSV"),
];

const TNTP: &str = "a TNTP file: write its trip table as CSV with period,from,to,passengers, and its nodes as CSV with id,latitude,longitude";

/// The name and remedy of a file that begins with these bytes and holds neither a table nor a map.
fn other_format(opening: &[u8]) -> Option<&'static str> {
    let text = without_mark(opening).trim_ascii_start();
    let begins = |(first, _): &(&[u8], &str)| opening.starts_with(first) || text.starts_with(first);
    if is_tntp(text) {
        return Some(TNTP);
    }
    // A name of a column may begin with the same letters.
    if opening.starts_with(b"ORC") && is_binary(opening) {
        return Some("an ORC file: write it as Parquet or CSV");
    }
    OTHERS.into_iter().find(begins).map(|(_, problem)| problem)
}

/// Whether a text is a file of the Transportation Networks for Research: metadata in angle
/// brackets, comments that begin with a tilde, and columns between blanks with a semicolon at the
/// end of each line.
fn is_tntp(text: &[u8]) -> bool {
    let lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let mut lines = lines.filter(|line| !line.is_empty());
    let first = lines.find(|line| !line.starts_with(b"~")).unwrap_or_default();
    let has_metadata =
        ["<NUMBER OF", "<TOTAL OD", "<FIRST THRU", "<ORIGINAL HEADER", "<END OF METADATA"]
            .iter()
            .any(|name| first.to_ascii_uppercase().starts_with(name.as_bytes()));
    let blanks = first.iter().any(u8::is_ascii_whitespace);
    let one_semicolon = first.iter().position(|&byte| byte == b';') == first.len().checked_sub(1);
    let of_columns = one_semicolon && !first.is_empty() && blanks && !first.contains(&b',');
    let of_trips = first.starts_with(b"Origin") && lines.any(|line| line.contains(&b':'));
    has_metadata || of_columns || of_trips && !first.contains(&b',')
}

/// Whether bytes are no text: they have control characters that no text has.
pub(crate) fn is_binary(bytes: &[u8]) -> bool {
    bytes.iter().any(|byte| byte.is_ascii_control() && !byte.is_ascii_whitespace())
}

/// The name and remedy of JSON that is neither GeoJSON nor a table, by what it begins with and
/// contains; `None` if the text is no JSON.
pub(crate) fn other_json(text: &[u8]) -> Option<&'static str> {
    let text = text.trim_ascii_start();
    // GeoJSON text sequences (RFC 8142) begin each feature with this.
    if !matches!(text.first(), Some(b'{' | b'[' | 0x1e)) {
        return None;
    }
    let has = |name: &str| {
        let name = format!("\"{name}\"");
        let begin = &text[..text.len().min(LONGEST_HEAD)];
        begin.windows(name.len()).any(|part| part == name.as_bytes())
    };
    let lines = || text.split(|&byte| byte == b'\n').filter(|line| !line.trim_ascii().is_empty());
    let by_lines = text[0] == 0x1e
        || lines().count() > 1
            && lines().take(2).all(|line| line.trim_ascii().starts_with(b"{"))
            && lines().take(2).all(|line| line.trim_ascii().ends_with(b"}"));
    Some(match () {
        () if has("Topology") => "it is TopoJSON: export GeoJSON from it (`topo2geo`)",
        () if by_lines && (has("Feature") || text[0] == 0x1e) => {
            "it is newline-delimited GeoJSON, with a feature in each line: write one FeatureCollection (`jq -s '{type:\"FeatureCollection\",features:.}'`)"
        }
        () if has("FeatureCollection") || has("Feature") => {
            "it is GeoJSON, and a table is needed: export CSV"
        }
        () if has("station_id") || has("stations") || has("last_updated") => {
            "it is a GBFS feed: write its stations as CSV with id,latitude,longitude"
        }
        () if has("esriGeometryPoint")
            || has("esriGeometryPolygon")
            || has("esriGeometryPolyline") =>
        {
            "it is Esri JSON: export GeoJSON (f=geojson), in longitude and latitude (WGS 84)"
        }
        () if by_lines => {
            "it is JSON lines, with an object in each line: write it as CSV or Parquet"
        }
        () if text[0] == b'[' => "it is a JSON list: write it as CSV or Parquet",
        () => "it is JSON: write it as CSV, or a map as GeoJSON",
    })
}

/// How the messages of [`other_json`] begin that name no other format than a map may have.
pub(crate) const GENERAL: [&str; 2] = ["it is GeoJSON", "it is JSON:"];

/// Bytes in which the kind of a text is looked for.
pub(crate) const LONGEST_HEAD: usize = 4_096;

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
        match other_format(opening) {
            Some(problem) => Err(not_a_table(origin, format!("it is {problem}"))),
            None => Ok(Self::None),
        }
    }
}

/// Reads a file whole.
pub(crate) fn read_whole(file: &InputFile<'_>) -> Result<Vec<u8>, Error> {
    let origin = file.origin();
    let bytes = at_most(file.content()?, file)?;
    let packing = Packing::of(beginning(&bytes), &origin)?;
    if matches!(packing, Packing::None) {
        return Ok(bytes);
    }
    unpack(packing, Cursor::new(bytes), &origin, |reader| {
        let bytes = at_most(reader, file)?;
        Packing::of(beginning(&bytes), &origin)?;
        Ok(bytes)
    })
}

/// The first bytes of a file that has been read, by which it is recognised.
fn beginning(bytes: &[u8]) -> &[u8] {
    let most = usize::try_from(OPENING).unwrap_or(usize::MAX);
    &bytes[..bytes.len().min(most)]
}

/// All bytes of a reader of a file, which must not be too many.
fn at_most(reader: impl Read, file: &InputFile<'_>) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    let read = reader.take(LONGEST + 1).read_to_end(&mut bytes);
    read.map_err(|cause| file.cannot_read(cause))?;
    if bytes.len() as u64 > LONGEST {
        return Err(FormatError::FileTooLarge { limit: LONGEST }.in_file(&file.origin()).into());
    }
    Ok(bytes)
}

/// Calls `read` with the unpacked bytes of a long file. `meter` wraps the file and reports how far
/// it has been read.
pub(crate) fn read_through<F, T>(
    file: &InputFile<'_>,
    meter: impl FnOnce(File) -> F,
    read: impl FnOnce(&mut (dyn Read + Send)) -> Result<T, Error>,
) -> Result<T, Error>
where
    F: Read + Seek + Send,
{
    let origin = file.origin();
    let packing = Packing::of(&opening(file)?, &origin)?;
    unpack(packing, meter(file.content()?), &origin, read)
}

/// The first bytes of a file, by which it is recognised.
pub(crate) fn opening(file: &InputFile<'_>) -> Result<Vec<u8>, Error> {
    file.opening(OPENING)
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
