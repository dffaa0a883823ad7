//! Paths of members of a network file, such as `vertiports.JFK.stands`.
//!
//! The names of a path are separated by dots. A name that contains a dot, an equals sign or a quote
//! is written in quotes, with a backslash before each quote and backslash in it:
//! `vertiports."St. John".stands`.

use std::borrow::Cow;

/// The names of a path.
pub(crate) fn names(path: &str) -> Vec<String> {
    let (mut names, mut rest) = (Vec::new(), path);
    while let Some((name, after)) = cut(rest, '.') {
        names.push(unquoted(name));
        rest = after;
    }
    names.push(unquoted(rest));
    names
}

/// A name as it is written in a path.
pub(crate) fn quoted(name: &str) -> Cow<'_, str> {
    if !name.contains(['.', '=', '"']) {
        return Cow::Borrowed(name);
    }
    Cow::Owned(format!("\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\"")))
}

/// The position of the entry whose id (or, in the fleet, type) is `part`, or else the position that
/// `part` is.
pub(crate) fn position<'a>(
    mut names: impl ExactSizeIterator<Item = Option<&'a str>>,
    part: &str,
) -> Option<usize> {
    let length = names.len();
    let counted = || part.parse().ok().filter(|&position| position < length);
    names.position(|name| name == Some(part)).or_else(counted)
}

/// A path and what follows it after an equals sign: `fleet.0.count=30` gives `fleet.0.count` and
/// `30`. An equals sign in quotes belongs to the path.
pub fn split_path(text: &str) -> Option<(&str, &str)> {
    cut(text, '=')
}

/// The text before and after the first separator that is not in quotes.
fn cut(text: &str, separator: char) -> Option<(&str, &str)> {
    let (mut in_quotes, mut escaped) = (false, false);
    for (at, c) in text.char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' if in_quotes => escaped = true,
            '"' => in_quotes = !in_quotes,
            _ if c == separator && !in_quotes => {
                return Some((&text[..at], &text[at + c.len_utf8()..]));
            }
            _ => {}
        }
    }
    None
}

fn unquoted(name: &str) -> String {
    let inner = name.strip_prefix('"').and_then(|name| name.strip_suffix('"'));
    let Some(inner) = inner else { return name.to_owned() };
    let mut text = String::new();
    let mut characters = inner.chars();
    while let Some(c) = characters.next() {
        text.extend(if c == '\\' { characters.next() } else { Some(c) });
    }
    text
}

#[cfg(test)]
mod tests {
    use proptest::prelude::{prop, proptest};

    use super::{names, quoted, split_path};

    #[test]
    fn names_with_dots_stand_in_quotes() {
        assert_eq!(names("vertiports.JFK.stands"), ["vertiports", "JFK", "stands"]);
        assert_eq!(names(r#"vertiports."St. John".stands"#), ["vertiports", "St. John", "stands"]);
        assert_eq!((quoted("JFK"), quoted("St. John")), ("JFK".into(), r#""St. John""#.into()));
        assert_eq!(split_path(r#"a."b=c".d=1=2"#), Some((r#"a."b=c".d"#, "1=2")));
    }

    proptest! {
        #[test]
        fn any_names_come_back_from_their_path(all in prop::collection::vec(r#"[a-c.="\\*]{1,6}"#, 1..4)) {
            let path = all.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(".");
            assert_eq!(names(&path), all, "{path}");
            let text = format!("{path}=1");
            assert_eq!(split_path(&text), Some((path.as_str(), "1")));
        }
    }
}
