//! Reads text into raw structs: JSON and TOML, with one shape of error that names member, line and
//! column. No entry of a list and no member is dropped ([`whole_lists`], `deny_unknown_fields`).

mod whole_lists;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer};

use crate::{FileKind, FormatError};
use whole_lists::Whole;

/// The member that every file of this project has. Other members may be anything until the format
/// is known.
#[derive(Deserialize)]
#[serde(expecting = "an object with a member `format`")]
struct Header {
    format: Option<String>,
}

/// Reads an optional member whose absence means its default. Null is the same as leaving it out, as
/// for members whose absence means that there is none.
pub(crate) fn or_default<'de, D, T>(from: D) -> Result<T, D::Error>
where
    D: Deserializer<'de>,
    T: Default + Deserialize<'de>,
{
    Ok(Option::<T>::deserialize(from)?.unwrap_or_default())
}

/// Reads JSON that states this format.
pub(crate) fn json<T: DeserializeOwned>(
    text: &[u8],
    format: &'static str,
) -> Result<T, FormatError> {
    let header: Header = json_value(text)?;
    check_format(&header, format)?;
    json_value(text)
}

/// Reads TOML that states this format.
pub(crate) fn toml<T: DeserializeOwned>(
    text: &str,
    format: &'static str,
) -> Result<T, FormatError> {
    let header: Header = toml_value(text)?;
    check_format(&header, format)?;
    toml_value(text)
}

/// The byte order mark, which some programs write at the start of UTF-8.
pub(crate) const MARK: char = '\u{feff}';

/// A text without the byte order mark at its start, or several of them: a program may add one to a
/// text that has one.
pub(crate) fn without_mark(mut text: &[u8]) -> &[u8] {
    while let Some(rest) = text.strip_prefix("\u{feff}".as_bytes()) {
        text = rest;
    }
    text
}

/// Refuses a network file where a scenario is expected. The text of a scenario can only be JSON.
pub(crate) fn refuse_network(text: &[u8]) -> Result<(), FormatError> {
    let names_format = |line: &[u8]| {
        let value = line.trim_ascii_start().strip_prefix(b"format").map(<[u8]>::trim_ascii_start);
        let value = value.and_then(|value| value.strip_prefix(b"=")).map(<[u8]>::trim_ascii_start);
        value.is_some_and(|value| value[1.min(value.len())..].starts_with(b"vertifleet-network/"))
    };
    let is_json = text.trim_ascii_start().starts_with(b"{");
    if is_json || !text.split(|&byte| byte == b'\n').any(names_format) {
        return Ok(());
    }
    let (found, expected) = ("a network file (TOML)", FileKind::Scenario);
    Err(FormatError::WrongKind { found, expected })
}

/// Refuses JSON where a network is expected. No TOML begins with a brace.
pub(crate) fn refuse_json(text: &str) -> Result<(), FormatError> {
    if !text.trim_ascii_start().starts_with('{') {
        return Ok(());
    }
    let names_format = text.contains("\"vertifleet-scenario/");
    let found = if names_format { "a scenario file (JSON)" } else { "JSON" };
    let expected = FileKind::Network;
    Err(FormatError::WrongKind { found, expected })
}

/// The text of a TOML file, which must be UTF-8.
pub(crate) fn utf8(text: &[u8]) -> Result<&str, FormatError> {
    str::from_utf8(text).map_err(|error| {
        let (line, column) = line_and_column(text, error.valid_up_to());
        let problem = "the text is not UTF-8".to_owned();
        FormatError::NotParsed { line, column, problem }
    })
}

/// The first `most` characters, at most, of a text from outside, for messages.
pub(crate) fn shortened(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

fn check_format(header: &Header, expected: &'static str) -> Result<(), FormatError> {
    match &header.format {
        Some(format) if format == expected => Ok(()),
        Some(format) => Err(FormatError::UnknownFormat { expected, found: shortened(format, 64) }),
        None => Err(FormatError::NoFormat { expected }),
    }
}

fn json_value<T: DeserializeOwned>(text: &[u8]) -> Result<T, FormatError> {
    let refuse = |error: &serde_json::Error, path: &str| {
        let (line, column) = (error.line(), error.column().max(1));
        let message = error.to_string();
        let position = format!(" at line {line} column {}", error.column());
        let problem = message.strip_suffix(&position).unwrap_or(&message);
        let place = Place { line, column };
        // `serde_json` reports a number that no `f64` holds as a syntax error, but it belongs to a
        // member that can be named.
        if error.is_data() || problem == "number out of range" {
            place.wrong_member(path, problem)
        } else {
            place.not_parsed(problem)
        }
    };
    let mut deserializer = serde_json::Deserializer::from_slice(text);
    let value = serde_path_to_error::deserialize(Whole(&mut deserializer))
        .map_err(|error| refuse(error.inner(), &error.path().to_string()))?;
    deserializer.end().map_err(|error| refuse(&error, "."))?;
    Ok(value)
}

fn toml_value<T: DeserializeOwned>(text: &str) -> Result<T, FormatError> {
    let place = |error: &toml::de::Error| {
        let start = error.span().map_or(0, |span| span.start);
        let (line, column) = line_and_column(text.as_bytes(), start);
        Place { line, column }
    };
    let deserializer = toml::Deserializer::parse(text)
        .map_err(|error| place(&error).not_parsed(error.message()))?;
    serde_path_to_error::deserialize(Whole(deserializer)).map_err(|error| {
        place(error.inner()).wrong_member(&error.path().to_string(), error.inner().message())
    })
}

/// The position of an error in a file.
struct Place {
    line: usize,
    column: usize,
}

impl Place {
    fn not_parsed(&self, problem: &str) -> FormatError {
        let Self { line, column } = *self;
        FormatError::NotParsed {
            line,
            column,
            problem: shortened(problem.lines().next().unwrap_or_default(), 300),
        }
    }

    /// `path` is in the form of `serde_path_to_error`, where a lone dot means the file as a whole.
    fn wrong_member(&self, path: &str, problem: &str) -> FormatError {
        let Self { line, column } = *self;
        FormatError::WrongMember {
            line,
            column,
            member: if path == "." { String::new() } else { format!("{}: ", shortened(path, 100)) },
            // The parsers name our type here, which means nothing to authors of files.
            problem: shortened(&problem.replace("expected f64", "expected a number"), 600),
        }
    }
}

/// Line and column of a byte, both from 1; columns count characters.
fn line_and_column(text: &[u8], at: usize) -> (usize, usize) {
    let before = &text[..at.min(text.len())];
    let line = before.split(|&byte| byte == b'\n').count();
    let start = before.iter().rposition(|&byte| byte == b'\n').map_or(0, |newline| newline + 1);
    (line, String::from_utf8_lossy(&before[start..]).chars().count() + 1)
}
