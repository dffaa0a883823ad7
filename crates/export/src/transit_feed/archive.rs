//! The tables of a feed, and the ZIP archive that holds them. Neither has the time of its writing,
//! so that the same day gives the same bytes.

use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, System, ZipWriter};

/// One CSV file of a feed.
pub(super) struct Table(csv::Writer<Vec<u8>>);

impl Table {
    /// A table with these columns and no rows yet.
    pub(super) fn new<const N: usize>(columns: [&str; N]) -> Self {
        let mut table = Self(csv::Writer::from_writer(Vec::new()));
        table.row(columns);
        table
    }

    /// Adds a row, which is as wide as the header.
    pub(super) fn row<const N: usize>(&mut self, values: [&str; N]) {
        self.0
            .write_record(values)
            .expect("memory takes every byte, and rows are as wide as the header");
    }

    fn into_bytes(self) -> Vec<u8> {
        self.0.into_inner().expect("memory takes every byte")
    }
}

/// A ZIP archive in memory.
pub(super) struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    /// An archive without files.
    pub(super) fn new() -> Self {
        Self(ZipWriter::new(Cursor::new(Vec::new())))
    }

    /// Adds a file as it is. The first file is added in this way, so that the archive can be
    /// recognised.
    pub(super) fn add_uncompressed(&mut self, name: &str, table: Table) {
        self.write(name, table, options().compression_method(CompressionMethod::Stored));
    }

    /// Adds a file, compressed.
    pub(super) fn add(&mut self, name: &str, table: Table) {
        let options = options().compression_method(CompressionMethod::Deflated);
        self.write(name, table, options.compression_level(Some(6)));
    }

    /// The bytes of the archive.
    pub(super) fn finish(self) -> Vec<u8> {
        self.0.finish().expect("memory takes every byte").into_inner()
    }

    fn write(&mut self, name: &str, table: Table, options: SimpleFileOptions) {
        self.0.start_file(name, options).expect("the files of a feed have different names");
        self.0.write_all(&table.into_bytes()).expect("a table of a day is shorter than 4 GiB");
    }
}

/// The attributes that all files share, independent of the system and of the time of writing.
fn options() -> SimpleFileOptions {
    SimpleFileOptions::default()
        .system(System::Unix)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644)
}
