//! Trip records of a CSV file, in blocks of whole lines.
//!
//! One thread reads blocks while the others take records from the blocks before. A bounded queue
//! lies between them, so that only a few blocks are in memory at once, for files of any length. A
//! line is a row: a row that is malformed, for example by a quote that is never closed, spoils no
//! other row.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;

use rayon::iter::{ParallelBridge, ParallelIterator};
use vertifleet_core::Stop;

use super::columns::{Layout, Places};
use super::signs::{Position, RowText};
use super::tally::{End, Record};
use super::{Progress, Reading};
use crate::Error;
use crate::cell::Cell;
use crate::input_file::InputFile;
use crate::parquet_file;
use crate::source::read_through;
use crate::table::{self, without_mark, wrong_encoding};
use crate::zones::Zones;

/// Bytes of a block; some more at its end complete its last line.
const BLOCK: usize = 4 << 20;
/// Most blocks that wait to be read.
const MOST_WAITING: usize = 8;
/// The longest line.
const LONGEST_LINE: usize = 64 << 10;

/// Whole lines of a file.
struct Block {
    lines: Vec<u8>,
    /// Position of the first byte in the file.
    begin: u64,
}

/// Adds all records of a file; `number` is its position among the files.
pub(super) fn read(
    input: &InputFile<'_>,
    number: usize,
    reading: &Reading<'_>,
) -> Result<(), Error> {
    let meter = |file| Metered { file, progress: &reading.progress };
    read_through(input, meter, |file| {
        let origin = input.origin();
        let mut source = Source { file, input, rest: Vec::new(), begin: 0 };
        let Some(mut first) = source.next_block()? else {
            return Err(Error::Nothing { origin, what: "rows, as it is empty" });
        };
        let row = RowReader::of_header(&mut first, input, number, reading)?;
        let waiting = rayon::current_num_threads().min(MOST_WAITING);
        thread::scope(|scope| {
            let (sender, blocks) = sync_channel(waiting);
            scope.spawn(move || source.send(first, &sender, reading.stop));
            blocks.into_iter().par_bridge().try_for_each(|block: Result<Block, Error>| {
                reading.stop.check()?;
                row.add_block(&block?, &origin, reading)
            })
        })
    })
}

/// The number of the line that begins at a byte of a file.
pub(super) fn line_number(input: &InputFile<'_>, begin: u64) -> Result<u64, Error> {
    read_through(
        input,
        |file| file,
        |file| {
            let mut before = file.take(begin);
            let (mut line, mut text) = (1, vec![0; 64 << 10]);
            loop {
                match before.read(&mut text).map_err(|cause| input.cannot_read(cause))? {
                    0 => return Ok(line),
                    read => line += count(&text[..read], b'\n') as u64,
                }
            }
        },
    )
}

#[expect(
    clippy::naive_bytecount,
    reason = "the compiler makes it fast enough, without another crate"
)]
fn count(text: &[u8], wanted: u8) -> usize {
    text.iter().filter(|&&byte| byte == wanted).count()
}

/// The error that names the first line of a file that is not UTF-8. In which line a block begins is
/// not known where blocks are read side by side, so the file is read once more.
fn not_text(input: &InputFile<'_>) -> Error {
    let mut line = 1;
    let found = read_through(
        input,
        |file| file,
        |file| {
            let mut text = Vec::new();
            loop {
                let begin = text.len();
                text.resize(begin + BLOCK, 0);
                let read =
                    file.read(&mut text[begin..]).map_err(|cause| input.cannot_read(cause))?;
                text.truncate(begin + read);
                let (valid, wrong) = match str::from_utf8(&text) {
                    Ok(_) => (text.len(), None),
                    Err(error) if error.error_len().is_none() && read > 0 => {
                        (error.valid_up_to(), None)
                    }
                    Err(error) => (error.valid_up_to(), Some(text[error.valid_up_to()])),
                };
                line += count(&text[..valid], b'\n') as u64;
                if wrong.is_some() || read == 0 {
                    return Ok(wrong.unwrap_or_default());
                }
                text.drain(..valid);
            }
        },
    );
    found.map_or_else(|error| error, |byte| wrong_encoding(&input.origin(), "CSV", line, byte))
}

/// A file that reports how far it has been read.
struct Metered<'a> {
    file: File,
    progress: &'a Progress<'a>,
}

impl Read for Metered<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(buffer)?;
        self.progress.add(read as u64);
        Ok(read)
    }
}

impl Seek for Metered<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

/// A file that is read block by block.
struct Source<'a> {
    file: &'a mut (dyn Read + Send),
    input: &'a InputFile<'a>,
    /// The begin of a line that the next block completes.
    rest: Vec<u8>,
    /// Position of the first byte of `rest` in the file.
    begin: u64,
}

impl Source<'_> {
    /// Sends all blocks, the first of which has been read already. Ends when they are no longer
    /// taken.
    fn send(mut self, first: Block, blocks: &SyncSender<Result<Block, Error>>, stop: &Stop) {
        let mut next = Ok(Some(first));
        while !stop.is_requested() {
            let sent = match next {
                Ok(None) => return,
                Ok(Some(block)) => blocks.send(Ok(block)),
                Err(error) => {
                    // The reader of the blocks has ended if this is not taken.
                    let _ = blocks.send(Err(error));
                    return;
                }
            };
            if sent.is_err() {
                return;
            }
            next = self.next_block();
        }
    }

    /// Reads the next whole lines; `None` at the end of the file.
    fn next_block(&mut self) -> Result<Option<Block>, Error> {
        let mut lines = std::mem::take(&mut self.rest);
        lines.reserve(BLOCK);
        let mut limited = (&mut self.file).take(BLOCK as u64);
        let read = loop {
            match limited.read_to_end(&mut lines) {
                Err(cause) if cause.kind() == ErrorKind::Interrupted => {}
                Err(cause) => return Err(self.input.cannot_read(cause)),
                Ok(read) => break read,
            }
        };
        let begin = self.begin;
        if read == BLOCK {
            let end =
                lines.iter().rposition(|&byte| byte == b'\n').map_or(0, |newline| newline + 1);
            if lines.len() - end > LONGEST_LINE {
                return Err(too_long(&self.input.origin(), begin + end as u64));
            }
            self.rest = lines.split_off(end);
        }
        self.begin += lines.len() as u64;
        Ok((!lines.is_empty()).then_some(Block { lines, begin }))
    }
}

fn too_long(origin: &str, begin: u64) -> Error {
    Error::LineTooLong { origin: origin.to_owned(), begin, limit: LONGEST_LINE }
}

/// The values of a row that make a record, in this order: time, passengers, and the places.
const SLOTS: usize = 6;

/// Takes records from lines.
struct RowReader<'a> {
    /// For each column up to the last one that is needed, the slot of its values.
    slots: Vec<Option<usize>>,
    /// Number of columns that the header has.
    columns: usize,
    layout: Layout,
    zones: &'a Zones,
    input: &'a InputFile<'a>,
    /// The number of the file.
    file: usize,
}

impl<'a> RowReader<'a> {
    /// Takes the header from the first block.
    fn of_header(
        block: &mut Block,
        input: &'a InputFile<'a>,
        file: usize,
        reading: &'a Reading<'_>,
    ) -> Result<Self, Error> {
        let origin = &input.origin();
        if block.lines.starts_with(parquet_file::MAGIC) {
            let problem = "it is a Parquet file within a compressed one: unpack it".to_owned();
            return Err(Error::NotParsed { origin: origin.to_owned(), kind: "CSV", problem });
        }
        table::text(&block.lines, "CSV", origin)?;
        let end = block.lines.iter().position(|&byte| byte == b'\n');
        let end = end.map_or(block.lines.len(), |newline| newline + 1);
        if end > LONGEST_LINE {
            return Err(too_long(origin, block.begin));
        }
        let names = Fields::of(without_mark(&block.lines[..end]));
        let names: Vec<String> =
            names.map(|name| String::from_utf8_lossy(name.trim_ascii()).into_owned()).collect();
        let layout = Layout::find(&reading.trips.columns, &names, origin)?;
        let zones = reading.zones_for(&layout, origin)?;
        if let Some(column) = layout.overlooked {
            reading.overlook(origin, &names[column]);
        }
        block.lines.drain(..end);
        block.begin += end as u64;
        let columns = slot_columns(&layout);
        let last = columns.iter().flatten().max().map_or(0, |last| last + 1);
        let slot = |at| columns.iter().position(|column| *column == Some(at));
        let slots = (0..last).map(slot).collect();
        Ok(Self { slots, columns: names.len(), layout, zones, input, file })
    }

    /// Adds all records of a block.
    fn add_block(&self, block: &Block, origin: &str, reading: &Reading<'_>) -> Result<(), Error> {
        if str::from_utf8(&block.lines).is_err() {
            return Err(not_text(self.input));
        }
        reading.tallies.with(|tally, rules| {
            let mut begin = block.begin;
            for line in block.lines.split_inclusive(|&byte| byte == b'\n') {
                if line.len() > LONGEST_LINE {
                    return Err(too_long(origin, begin));
                }
                let position = Position { file: self.file, at: begin };
                begin += line.len() as u64;
                if line.trim_ascii().is_empty() {
                    continue;
                }
                if self.has_too_many_values(line) {
                    tally.add_with_too_many_values(position, line);
                    continue;
                }
                let row = RowText::Line(line);
                tally.add(
                    &record(&self.cells(line), &self.layout, self.zones, (position, row)),
                    rules,
                );
            }
            Ok(())
        })
    }

    /// Whether a line has a value beyond the last column of the header, as where a decimal comma is
    /// not in quotes.
    #[inline]
    fn has_too_many_values(&self, line: &[u8]) -> bool {
        // Commas in quotes make this number too large, but never too small.
        let commas = count(line, b',');
        let beyond = || Fields::of(line).skip(self.columns);
        commas >= self.columns && beyond().any(|field| !field.trim_ascii().is_empty())
    }

    /// The values of a line by slot.
    #[inline]
    fn cells<'line>(&self, line: &'line [u8]) -> [Cell<'line>; SLOTS] {
        let mut cells = [Cell::Missing; SLOTS];
        for (slot, field) in self.slots.iter().zip(Fields::of(line)) {
            if let Some(slot) = *slot {
                cells[slot] = Cell::text(field);
            }
        }
        cells
    }
}

/// The column of each slot.
pub(super) fn slot_columns(layout: &Layout) -> [Option<usize>; SLOTS] {
    let (time, passengers) = (Some(layout.time), layout.passengers);
    match layout.places {
        Places::Coordinates([a, b, c, d]) => [time, passengers, Some(a), Some(b), Some(c), Some(d)],
        Places::Zones([from, to]) => [time, passengers, Some(from), Some(to), None, None],
    }
}

/// The record that a row's values make.
#[inline]
pub(super) fn record<'row>(
    cells: &[Cell<'row>],
    layout: &Layout,
    zones: &Zones,
    (position, row): (Position, RowText<'row>),
) -> Record<'row> {
    let cell = |slot: usize| cells.get(slot).copied().unwrap_or(Cell::Missing);
    let at = |latitude: usize| {
        Some(End::At {
            latitude: cell(latitude).number()?,
            longitude: cell(latitude + 1).number()?,
        })
    };
    let zone = |slot: usize| zones.find(cell(slot)).map(End::Zone);
    let (from, to) = match layout.places {
        Places::Coordinates(_) => (at(2), at(4)),
        Places::Zones(_) => (zone(2), zone(3)),
    };
    let passengers = match layout.passengers {
        Some(_) => cell(1).number(),
        None => Some(1.0),
    };
    Record { position, row, time: cell(0), from, to, passengers }
}

/// The fields of a line, split at commas that are not in quotes. The quotes around a field are left
/// out.
struct Fields<'a> {
    rest: Option<&'a [u8]>,
}

impl<'a> Fields<'a> {
    #[inline]
    fn of(line: &'a [u8]) -> Self {
        Self { rest: Some(line) }
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = &'a [u8];

    #[inline]
    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest?;
        if let [b'"', quoted @ ..] = rest {
            return Some(self.quoted(quoted));
        }
        let end = rest.iter().position(|&byte| byte == b',');
        self.rest = end.map(|end| &rest[end + 1..]);
        Some(&rest[..end.unwrap_or(rest.len())])
    }
}

impl<'a> Fields<'a> {
    /// A field that began with a quote. Two quotes in it stand for one, which no value that is read
    /// here has.
    fn quoted(&mut self, text: &'a [u8]) -> &'a [u8] {
        let mut at = 0;
        let end = loop {
            match text.get(at..) {
                None | Some([]) => break text.len(),
                Some([b'"', b'"', ..]) => at += 2,
                Some([b'"', ..]) => break at,
                Some(_) => at += 1,
            }
        };
        let after = &text[(end + 1).min(text.len())..];
        let comma = after.iter().position(|&byte| byte == b',');
        self.rest = comma.map(|comma| &after[comma + 1..]);
        &text[..end]
    }
}

#[cfg(test)]
mod tests {
    use super::Fields;

    #[test]
    fn commas_in_quotes_part_no_fields_and_a_lost_quote_spoils_only_its_line() {
        let fields = |line: &'static [u8]| Fields::of(line).collect::<Vec<_>>();
        assert_eq!(fields(b"a,,\"b,c\",d"), [b"a".as_slice(), b"", b"b,c", b"d"]);
        assert_eq!(fields(b"\"a\"\"b\",c,"), [b"a\"\"b".as_slice(), b"c", b""]);
        assert_eq!(fields(b"\"a,b"), [b"a,b".as_slice()]);
        assert_eq!(fields(b""), [b"".as_slice()]);
    }
}
