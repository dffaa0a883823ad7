//! Finds the requested column of a table, or the requested property of a map's features.

use crate::cell::printable;
use crate::error::shortened;
use crate::row::{Column, Need};
use crate::units::{self, Likeness};
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

/// The columns that were found.
pub(crate) struct Found {
    /// The position of each wanted column, if it is there.
    pub(crate) places: Vec<Option<usize>>,
    /// The positions of columns that a warning names.
    pub(crate) named: Vec<usize>,
}

impl Header<'_> {
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
    ) -> Result<Found, Error> {
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
        let absent = wanted.iter().zip(&places).filter(|(_, at)| at.is_none());
        let absent: Vec<&str> = absent.map(|(column, _)| column.names[0]).collect();
        let overlooked = self.overlooked(&absent, &used);
        warnings.extend(overlooked.iter().map(|similar| self.not_read(similar)));
        let named = overlooked.iter().map(|similar| similar.at).collect();
        Ok(Found { places, named })
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
        let similar = missing.like.iter().find_map(|wanted| self.similar(wanted, missing.used));
        let meant = similar.map(|similar| {
            let name = self.shown(similar.at);
            match similar.likeness {
                Likeness::Same => {
                    format!("did you mean {}?", shortened(&self.names[similar.at], 64))
                }
                _ => format!("{name:?} {}", similar.difference(&name)),
            }
        });
        match (meant, missing.remedy) {
            (Some(meant), Some(remedy)) => Some(format!("{meant} {remedy}")),
            (meant, remedy) => meant.or_else(|| remedy.map(str::to_owned)),
        }
    }

    fn shown(&self, at: usize) -> String {
        shortened(&printable(&self.names[at]), 64)
    }

    /// The columns that are not read and have a name like that of one of the absent columns. A
    /// column that is another quantity than several of them is named once.
    fn overlooked<'w>(&self, absent: &[&'w str], used: &[usize]) -> Vec<Similar<'w>> {
        // Many short words differ in only two letters, such as name and date.
        let is_typo = |similar: &Similar<'_>| similar.is_typo && similar.wanted.len() <= 4;
        let similar = absent.iter().filter_map(|wanted| self.similar(wanted, used));
        let all: Vec<Similar<'w>> = similar.filter(|similar| !is_typo(similar)).collect();
        let rank = |similar: &Similar<'_>| match similar.likeness {
            Likeness::Same => 0,
            Likeness::Other { is_exact: true } => 1,
            _ => 2,
        };
        let is_best = |similar: &&Similar<'w>| {
            let mut same = all.iter().filter(|other| other.at == similar.at);
            same.all(|other| rank(similar) <= rank(other))
        };
        all.iter().filter(is_best).copied().collect()
    }

    /// The warning that a column is absent and one of a similar name is not read.
    fn not_read(&self, similar: &Similar<'_>) -> Warning {
        let (one, name, wanted) = (self.of.one(), self.shown(similar.at), similar.wanted);
        let problem = match similar.likeness {
            Likeness::Same => {
                format!("the {one} {name:?} is not read: rename it to {wanted} if it means that")
            }
            _ => format!("the {one} {name:?} is not read: it {}", similar.difference(&name)),
        };
        Warning::Columns { origin: self.origin.to_owned(), problem }
    }

    /// A name that is not used and is like a wanted one. Names for the same come first.
    fn similar<'w>(&self, wanted: &'w str, used: &[usize]) -> Option<Similar<'w>> {
        let free = || (0..self.names.len()).filter(|at| !used.contains(at));
        let similar = |likeness| move |at| Similar { wanted, at, likeness, is_typo: false };
        if units::quantity(wanted).is_some() {
            let like = |at: &usize| units::likeness(wanted, &self.names[*at]);
            let same = free().find(|at| like(at) == Likeness::Same);
            let other = || free().find(|at| like(at) != Likeness::None);
            let at = same.or_else(other)?;
            return Some(similar(like(&at))(at));
        }
        let name = |at: &usize| self.names[*at].as_str();
        let begins = |at: &usize| {
            let beginning = wanted.get(..name(at).len());
            let is_begin = |begin: &str| begin.eq_ignore_ascii_case(name(at));
            name(at).len() > 2 && beginning.is_some_and(is_begin)
        };
        let has_words = |at: &usize| {
            let words: Vec<String> = units::words(name(at)).collect();
            wanted.len() > 2 && units::words(wanted).all(|word| words.contains(&word))
        };
        let found = free().find(begins).or_else(|| free().find(has_words));
        let typo = || {
            let nearest = nearest(wanted, free().map(|at| self.names[at].as_str()))?;
            let at = free().find(|at| name(at) == nearest)?;
            Some(Similar { is_typo: true, ..similar(Likeness::Same)(at) })
        };
        found.map(similar(Likeness::Same)).or_else(typo)
    }
}

/// A column whose name is like that of a wanted one.
#[derive(Debug, Clone, Copy)]
struct Similar<'w> {
    wanted: &'w str,
    /// The position of the column.
    at: usize,
    likeness: Likeness,
    /// Whether only letters are mistyped.
    is_typo: bool,
}

impl Similar<'_> {
    /// The difference of a column of this name, and the remedy.
    fn difference(&self, name: &str) -> String {
        let quantity = units::quantity(self.wanted).unwrap_or_default();
        let step = units::conversion(self.wanted, name);
        let step = step.map(|step| format!(" ({step})")).unwrap_or_default();
        format!(
            "may be in another unit or mean something else: {} is {quantity}{step}",
            self.wanted
        )
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
