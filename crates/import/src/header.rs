//! Finds the requested column of a table, or the requested property of a map's features.

use crate::cell::printable;
use crate::error::shortened;
use crate::row::{Column, Need};
use crate::{Error, Warning, units};

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
    /// The position of a name. Upper and lower case are the same. A name with underscores is also
    /// one with blanks, as `Trip Start Timestamp`.
    pub(crate) fn position(&self, name: &str) -> Option<usize> {
        let same = |has: &String| has.eq_ignore_ascii_case(name.trim());
        let same_words = |has: &String| {
            let words = has.split(' ').filter(|word| !word.is_empty());
            words.collect::<Vec<_>>().join("_").eq_ignore_ascii_case(name)
        };
        let position = self.names.iter().position(same);
        position.or_else(|| self.names.iter().position(same_words))
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
            hint: None,
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
        let found = |wanted: &str| {
            let similar = self.similar(wanted, missing.used);
            similar.or_else(|| self.nearest(wanted, missing.used))
        };
        let similar =
            missing.like.iter().copied().find_map(|wanted| Some((wanted, found(wanted)?)));
        let meant = similar.map(|(wanted, name)| {
            if !units::differ(wanted, name) {
                return format!("did you mean {}?", shortened(name, 64));
            }
            let (name, step) = (shortened(&printable(name), 64), units::conversion(wanted, name));
            format!("{name:?} is in another unit: {step}, and name the column {wanted}")
        });
        match (meant, missing.remedy) {
            (Some(meant), Some(remedy)) => Some(format!("{meant} {remedy}")),
            (meant, remedy) => meant.or_else(|| remedy.map(str::to_owned)),
        }
    }

    /// The warning that a column is absent and one of a similar name is not read.
    fn overlooked(&self, column: &str, used: &[usize]) -> Option<Warning> {
        // Many short words differ in only two letters, such as name and date.
        let nearest = || self.nearest(column, used).filter(|_| column.len() > 4);
        let similar = self.similar(column, used).or_else(nearest)?;
        let name = shortened(&printable(similar), 64);
        let one = self.of.one();
        let problem = if units::differ(column, similar) {
            let step = units::conversion(column, similar);
            format!(
                "the {one} {name:?} is not read, and is in another unit: {step}, and rename it to {column}, if it means that"
            )
        } else {
            format!("the {one} {name:?} is not read: rename it to {column} if it means that")
        };
        Some(Warning::Columns { origin: self.origin.to_owned(), problem })
    }

    /// A name that is not used and is the beginning of this one (`fare` for `fare_usd`), has it as
    /// a word (`number of stands`), or has all its words (`charging_power_kw` for `charger_kw`).
    /// Names in the same unit come first.
    fn similar(&self, column: &str, used: &[usize]) -> Option<&'a str> {
        let begins = |name: &&str| {
            let beginning = column.get(..name.len());
            name.len() > 2 && beginning.is_some_and(|begins| begins.eq_ignore_ascii_case(name))
        };
        let has_word = |name: &&str| {
            let mut words = name.split(|c: char| !c.is_alphanumeric());
            column.len() > 2 && words.any(|word| word.eq_ignore_ascii_case(column))
        };
        let of_column: Vec<String> = units::words(column).collect();
        let has_all_words = |name: &&str| {
            let words: Vec<String> = units::words(name).collect();
            of_column.len() > 1
                && of_column.iter().all(|word| words.iter().any(|other| are_alike(word, other)))
        };
        let free = || self.free(used);
        let in_unit = || free().filter(|name| !units::differ(column, name));
        in_unit()
            .find(begins)
            .or_else(|| in_unit().find(has_word))
            .or_else(|| in_unit().find(has_all_words))
            .or_else(|| free().find(has_all_words))
    }

    /// The nearest name that is not used, of those in the same unit if any is near.
    fn nearest(&self, column: &str, used: &[usize]) -> Option<&'a str> {
        let in_unit = self.free(used).filter(|name| !units::differ(column, name));
        nearest(column, in_unit).or_else(|| nearest(column, self.free(used))).or_else(|| {
            let is_beside = |name: &&str| {
                units::differ(column, name)
                    && units::words(name).next() == units::words(column).next()
            };
            // `lmp_usd_per_mwh` for `price_usd_per_kwh`: the same kind of unit, and another name.
            let kind: Vec<String> = units::words(column).skip(1).collect();
            let has_kind = |name: &&str| {
                let words: Vec<String> = units::words(name).collect();
                let near = |one: &String| {
                    words.iter().any(|word| nearest(one, [word.as_str()].into_iter()).is_some())
                };
                kind.len() > 1 && kind.iter().all(near)
            };
            self.free(used).find(is_beside).or_else(|| self.free(used).find(has_kind))
        })
    }

    /// The names that are not used.
    fn free(&self, used: &[usize]) -> impl Iterator<Item = &'a str> {
        let names = self.names.iter().enumerate();
        names.filter(|(at, _)| !used.contains(at)).map(|(_, name)| name.as_str())
    }
}

/// Whether two words are the same but for an ending, as charger and charging are.
fn are_alike(one: &str, other: &str) -> bool {
    const STEM: usize = 5;
    let stem = one.get(..STEM).zip(other.get(..STEM));
    one == other || stem.is_some_and(|(one, other)| one == other)
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
