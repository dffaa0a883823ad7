//! How the files of this crate begin, so that a command recognises its files before it replaces
//! one.

use vertifleet_core::OutputKind;

/// The beginning of every CSV file of a day.
pub const CSV_FILE: OutputKind =
    OutputKind { name: "table of decisions", skipped: 0, opening: "aircraft,type,kind,from,to," };

/// The beginning of every Parquet file. It does not distinguish our files from others, because
/// Parquet has its metadata at the end.
pub const PARQUET_FILE: OutputKind =
    OutputKind { name: "Parquet file", skipped: 0, opening: "PAR1" };

/// The beginning of every GeoJSON file of a day.
pub const GEOJSON_FILE: OutputKind = OutputKind {
    name: "map of flights",
    skipped: 0,
    opening: r#"{"type":"FeatureCollection","generator":"Vertifleet","features":["#,
};

/// The beginning of every feed of a day: after the 30 bytes that begin each entry of a ZIP archive,
/// the name of the first file and the file itself, which is not compressed.
pub const GTFS_FILE: OutputKind = OutputKind {
    name: "GTFS feed",
    skipped: 30,
    opening: "agency.txtagency_id,agency_name,agency_url,agency_timezone,agency_lang\nvertifleet,",
};

/// The beginning of every calendar of a vertiport.
pub const ICALENDAR_FILE: OutputKind = OutputKind {
    name: "calendar of a vertiport",
    skipped: 0,
    opening: "BEGIN:VCALENDAR\r\nVERSION:2.0\r\nPRODID:-//Vertifleet//Flights//EN\r\n",
};
