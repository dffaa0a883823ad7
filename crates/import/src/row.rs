//! A row of a small table, or a feature of a map, with its values by column: every check of a value
//! names the file, the place in it, the column and the rule.

use std::borrow::Cow;

use vertifleet_core::Time;

use crate::Error;
use crate::cell::{Cell, composed};
use crate::clock;
use crate::error::{did_you_mean, shortened};
use crate::globe::Place;
use crate::vertiports::Vertiports;

/// A column that is asked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Column {
    /// Its name, and other names by which it is known. The first that the file has counts.
    pub(crate) names: &'static [&'static str],
    pub(crate) need: Need,
}

/// Whether a file must have a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Need {
    Required,
    /// At least one of the columns of this kind must be there.
    OneOf,
    Optional,
}

/// A column that a file must have.
pub(crate) const fn required(names: &'static [&'static str]) -> Column {
    Column { names, need: Need::Required }
}

/// A column of several, of which a file must have at least one.
pub(crate) const fn one_of(names: &'static [&'static str]) -> Column {
    Column { names, need: Need::OneOf }
}

/// A column that a file may have.
pub(crate) const fn optional(names: &'static [&'static str]) -> Column {
    Column { names, need: Need::Optional }
}

/// The positions of rows in their file.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Positions<'a> {
    /// Positions are first bytes of lines of this text.
    Lines(&'a [u8]),
    /// Positions are numbers of features, from 1.
    Features,
    /// Positions are numbers of rows, from 1.
    Rows,
}

impl Positions<'_> {
    /// The place at a position, in words; that of the names of the columns at 0.
    ///
    /// Lines are counted here, because the parser's own count lags behind where it skips empty
    /// lines or the second half of a CR LF.
    pub(crate) fn place(self, position: usize) -> String {
        match self {
            Self::Lines(text) => {
                let begin = position.min(text.len());
                let skipped = text[begin..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n'));
                let begin = begin + skipped.count();
                format!("line {}", text[..begin].split(|&byte| byte == b'\n').count())
            }
            Self::Features | Self::Rows if position == 0 => "the names of its columns".to_owned(),
            Self::Features => format!("feature {position}"),
            Self::Rows => format!("row {position}"),
        }
    }
}

/// A row or feature.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row<'a> {
    pub(crate) origin: &'a str,
    pub(crate) positions: Positions<'a>,
    pub(crate) position: usize,
    pub(crate) columns: &'a [Column],
    /// One for each column.
    pub(crate) cells: &'a [Cell<'a>],
    /// The values of the columns whose names are values of their rows.
    pub(crate) wide: &'a [Cell<'a>],
}

impl Row<'_> {
    /// The place of this row in its file, in words.
    pub(crate) fn place(&self) -> String {
        self.place_of(self.position)
    }

    /// The place of the row at this position in the same file, in words.
    pub(crate) fn place_of(&self, position: usize) -> String {
        self.positions.place(position)
    }

    /// Whether the row has a value in this column.
    pub(crate) fn has(&self, column: usize) -> bool {
        self.cells[column] != Cell::Missing
    }

    /// The text of a column, which must not be empty, with composed accents.
    pub(crate) fn text(&self, column: usize) -> Result<Cow<'_, str>, Error> {
        match self.cells[column] {
            Cell::Missing => Err(self.wrong(column, "given".to_owned())),
            // Text files are checked as a whole; a column of a Parquet file may hold any bytes.
            Cell::Text(text) if str::from_utf8(text).is_err() => {
                Err(self.wrong(column, "a text in UTF-8".to_owned()))
            }
            cell => Ok(composed(cell.shown())),
        }
    }

    /// An id: 1 to 64 characters, none of them a control character.
    pub(crate) fn id(&self, column: usize) -> Result<String, Error> {
        let id = self.text(column)?;
        if id.chars().count() > 64 || id.chars().any(char::is_control) {
            return Err(self.wrong(column, "1 to 64 characters that can be printed".to_owned()));
        }
        Ok(id.into_owned())
    }

    /// The number of a column, from `least` to `most`.
    pub(crate) fn number(&self, column: usize, least: f64, most: f64) -> Result<f64, Error> {
        let number = self.cells[column].number().filter(|number| (least..=most).contains(number));
        // A zero with a sign would be written as such.
        let number = number.map(|number| number + 0.0);
        number.ok_or_else(|| self.wrong(column, format!("a number from {least} to {most}")))
    }

    /// The number of a column that may be empty.
    pub(crate) fn optional_number(
        &self,
        column: usize,
        least: f64,
        most: f64,
    ) -> Result<Option<f64>, Error> {
        self.has(column).then(|| self.number(column, least, most)).transpose()
    }

    /// The whole number of a column that may be empty.
    pub(crate) fn optional_whole(
        &self,
        column: usize,
        least: i64,
        most: i64,
    ) -> Result<Option<i64>, Error> {
        if !self.has(column) {
            return Ok(None);
        }
        let whole = self.cells[column].whole().filter(|whole| (least..=most).contains(whole));
        let rule = || format!("a whole number from {least} to {most}");
        whole.map(Some).ok_or_else(|| self.wrong(column, rule()))
    }

    /// The truth value of a column that may be empty.
    pub(crate) fn optional_flag(&self, column: usize) -> Result<Option<bool>, Error> {
        if !self.has(column) {
            return Ok(None);
        }
        match self.cells[column].shown().to_ascii_lowercase().as_str() {
            "true" | "1" => Ok(Some(true)),
            "false" | "0" => Ok(Some(false)),
            _ => Err(self.wrong(column, "true or false".to_owned())),
        }
    }

    /// The time of a column, in any form in which planners write the begin of a period.
    pub(crate) fn time(&self, column: usize) -> Result<Time, Error> {
        // No period of a network begins later.
        const LAST: u32 = 36;
        let time = clock::begin(self.cells[column]).filter(|time| time.seconds() <= LAST * 3600);
        let rule = format!(
            "a time as HH:MM, HH:MM:SS, 6:00 AM or 06:00-07:00, or an hour, from 0 to {LAST}:00"
        );
        time.ok_or_else(|| self.wrong(column, rule))
    }

    /// The position of the vertiport that a column names.
    pub(crate) fn vertiport(&self, column: usize, vertiports: &Vertiports) -> Result<usize, Error> {
        let id = self.text(column)?;
        vertiports.find(&id, self.cells[column].whole()).ok_or_else(|| Error::UnknownVertiport {
            origin: self.origin.to_owned(),
            place: self.place(),
            member: self.member(column),
            meant: did_you_mean(&id, vertiports.ids()),
            found: shortened(&id, 64),
        })
    }

    /// The positions of the two different vertiports that two columns name.
    pub(crate) fn pair(
        &self,
        from: usize,
        to: usize,
        vertiports: &Vertiports,
    ) -> Result<(usize, usize), Error> {
        let ends = (self.vertiport(from, vertiports)?, self.vertiport(to, vertiports)?);
        if ends.0 == ends.1 {
            return Err(Error::SameVertiport {
                origin: self.origin.to_owned(),
                place: self.place(),
                vertiport: vertiports.list[ends.0].id.clone(),
            });
        }
        Ok(ends)
    }

    /// The place that two columns give, within `most_latitude` degrees of the equator.
    pub(crate) fn degrees(
        &self,
        latitude: usize,
        longitude: usize,
        most_latitude: f64,
    ) -> Result<Place, Error> {
        Ok(Place {
            latitude: self.number(latitude, -most_latitude, most_latitude)?,
            longitude: self.number(longitude, -180.0, 180.0)?,
        })
    }

    /// The error that `what` is given before, at another position of the file.
    pub(crate) fn given_twice(&self, what: String, before: usize) -> Error {
        Error::GivenTwice {
            origin: self.origin.to_owned(),
            place: self.place(),
            what,
            before: self.place_of(before),
            hint: None,
        }
    }

    /// The error that the value of a column breaks a rule.
    pub(crate) fn wrong(&self, column: usize, rule: String) -> Error {
        Error::WrongValue {
            origin: self.origin.to_owned(),
            place: self.place(),
            member: self.member(column),
            rule,
            found: shortened(&self.cells[column].shown(), 80),
        }
    }

    fn member(&self, column: usize) -> &'static str {
        self.columns[column].names[0]
    }
}
