//! Finds the requested column of a table, or the requested property of a map's features.

use crate::cell::printable;
use crate::error::shortened;
use crate::row::{Column, Need};
use crate::{Error, Warning};

/// The names of the columns of a table, or of the properties of features.
#[derive(Clone, Copy)]
pub(crate) struct Header<'a> {
    pub(crate) origin: &'a str,
    pub(crate) names: &'a [String],
    pub(crate) of: Named,
}

/// The kind of thing that has names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Named {
    Columns,
    Properties,
}

impl Named {
    pub(crate) fn one(self) -> &'static str {
        match self {
            Self::Columns => "column",
            Self::Properties => "property",
        }
    }
}

impl<'a> Header<'a> {
    /// The position of a name. Upper and lower case are the same.
    pub(crate) fn position(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|has| has.eq_ignore_ascii_case(name.trim()))
    }

    /// The positions of the wanted columns. A name that is used must not occur twice. Names that
    /// are not used, and that look like one of a wanted column that is absent, are warned of.
    pub(crate) fn find(
        &self,
        wanted: &[Column],
        warnings: &mut Vec<Warning>,
    ) -> Result<Vec<Option<usize>>, Error> {
        let first = |column: &Column| column.names.iter().find_map(|name| self.position(name));
        let places: Vec<Option<usize>> = wanted.iter().map(first).collect();
        let used: Vec<usize> = places.iter().flatten().copied().collect();
        used.iter().try_for_each(|&at| self.refuse_twice(at))?;
        let of =
            |need: Need| wanted.iter().zip(&places).filter(move |(column, _)| column.need == need);
        let missing = |like: &[&str]| {
            let column = like.join(" or ");
            self.missing(&Missing { column: &column, like, used: &used, remedy: None })
        };
        if let Some((column, _)) = of(Need::Required).find(|(_, at)| at.is_none()) {
            return Err(missing(&column.names[..1]));
        }
        let one_of: Vec<&str> = of(Need::OneOf).map(|(column, _)| column.names[0]).collect();
        if !one_of.is_empty() && of(Need::OneOf).all(|(_, at)| at.is_none()) {
            return Err(missing(&one_of));
        }
        for (column, _) in wanted.iter().zip(&places).filter(|(_, at)| at.is_none()) {
            warnings.extend(self.overlooked(column.names[0], &used));
        }
        Ok(places)
    }

    /// Refuses a name that another column has too.
    pub(crate) fn refuse_twice(&self, at: usize) -> Result<(), Error> {
        let same = |&other: &usize| self.names[other].eq_ignore_ascii_case(&self.names[at]);
        let Some(second) = (at + 1..self.names.len()).find(same) else { return Ok(()) };
        let place = |at: usize| format!("{} {}", self.of.one(), at + 1);
        Err(Error::GivenTwice {
            origin: self.origin.to_owned(),
            place: place(second),
            what: format!("the name {:?}", shortened(&self.names[second], 64)),
            before: place(at),
        })
    }

    /// The error that names a column that is missing, and those that are there.
    pub(crate) fn missing(&self, missing: &Missing<'_>) -> Error {
        const SHOWN: usize = 30;
        let names: Vec<&String> = self.names.iter().filter(|name| !name.is_empty()).collect();
        let shown = |name: &&String| shortened(&printable(name), 40);
        let mut found: Vec<String> = names.iter().take(SHOWN).map(shown).collect();
        if names.len() > SHOWN {
            found.push("...".to_owned());
        }
        if found.is_empty() {
            found.push("none".to_owned());
        }
        Error::MissingColumn {
            origin: self.origin.to_owned(),
            what: self.of.one(),
            column: missing.column.to_owned(),
            found: found.join(", "),
            hint: other_separator(self.names).or_else(|| self.hint(missing)),
        }
    }

    fn hint(&self, missing: &Missing<'_>) -> Option<String> {
        let similar = |name: &&str| {
            let free = self.free(missing.used);
            self.similar(name, missing.used).or_else(|| nearest(name, free))
        };
        let similar = missing.like.iter().find_map(similar);
        let meant = similar.map(|name| format!("did you mean {}?", shortened(name, 64)));
        match (meant, missing.remedy) {
            (Some(meant), Some(remedy)) => Some(format!("{meant} {remedy}")),
            (meant, remedy) => meant.or_else(|| remedy.map(str::to_owned)),
        }
    }

    /// The warning that a column is absent and one of a similar name is not read.
    fn overlooked(&self, column: &str, used: &[usize]) -> Option<Warning> {
        // Many short words differ in only two letters, such as name and date.
        let nearest = || nearest(column, self.free(used)).filter(|_| column.len() > 4);
        let similar = self.similar(column, used).or_else(nearest)?;
        Some(Warning::Columns {
            origin: self.origin.to_owned(),
            problem: format!(
                "the {} {:?} is not read: rename it to {column} if it means that",
                self.of.one(),
                shortened(&printable(similar), 64),
            ),
        })
    }

    /// A name that is not used and is the beginning of this one (`fare` for `fare_usd`) or has it
    /// as a word (`number of stands`).
    fn similar(&self, column: &str, used: &[usize]) -> Option<&'a str> {
        let begins = |name: &&str| {
            let beginning = column.get(..name.len());
            name.len() > 2 && beginning.is_some_and(|begins| begins.eq_ignore_ascii_case(name))
        };
        let has_word = |name: &&str| {
            let mut words = name.split(|c: char| !c.is_alphanumeric());
            column.len() > 2 && words.any(|word| word.eq_ignore_ascii_case(column))
        };
        let free = || self.free(used);
        free().find(begins).or_else(|| free().find(has_word))
    }

    /// The names that are not used.
    fn free(&self, used: &[usize]) -> impl Iterator<Item = &'a str> {
        let names = self.names.iter().enumerate();
        names.filter(|(at, _)| !used.contains(at)).map(|(_, name)| name.as_str())
    }
}

fn nearest<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    vertifleet_core::nearest(&shortened(name, 64), names)
}

/// A column that is needed and missing.
pub(crate) struct Missing<'a> {
    /// A description of the column.
    pub(crate) column: &'a str,
    /// The names to which similar ones are looked for.
    pub(crate) like: &'a [&'a str],
    /// The columns that are used for other values, so that they cannot be this one.
    pub(crate) used: &'a [usize],
    /// Another remedy.
    pub(crate) remedy: Option<&'a str>,
}

/// A hint that names the separator of a header that has no commas.
fn other_separator(found: &[String]) -> Option<String> {
    let [header] = found else { return None };
    let separators = [(';', "semicolons"), ('\t', "tabs"), ('|', "vertical bars")];
    let (_, name) = separators.into_iter().find(|(separator, _)| header.contains(*separator))?;
    Some(format!(
        "its columns are separated by {name}: save it with commas between the columns, and with decimal points"
    ))
}
