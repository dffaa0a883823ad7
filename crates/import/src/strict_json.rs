//! JSON in which no object has a member twice. Readers of JSON keep the last one and drop the
//! others silently.

use std::collections::HashSet;
use std::fmt;

use serde::de::{self, Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};

use crate::error::shortened;

/// Checks that no object of a JSON text has a member twice.
///
/// # Errors
/// Returns the error of the reader, with line and column.
pub(crate) fn check(text: &[u8]) -> Result<(), serde_json::Error> {
    serde_json::from_slice::<Checked>(text).map(drop)
}

/// Any value, of which nothing is kept.
struct Checked;

impl<'de> Deserialize<'de> for Checked {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Each)
    }
}

struct Each;

impl<'de> Visitor<'de> for Each {
    type Value = Checked;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a JSON value")
    }

    fn visit_bool<E>(self, _: bool) -> Result<Checked, E> {
        Ok(Checked)
    }

    fn visit_i64<E>(self, _: i64) -> Result<Checked, E> {
        Ok(Checked)
    }

    fn visit_u64<E>(self, _: u64) -> Result<Checked, E> {
        Ok(Checked)
    }

    fn visit_f64<E>(self, _: f64) -> Result<Checked, E> {
        Ok(Checked)
    }

    fn visit_str<E>(self, _: &str) -> Result<Checked, E> {
        Ok(Checked)
    }

    fn visit_unit<E>(self) -> Result<Checked, E> {
        Ok(Checked)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Checked, A::Error> {
        while values.next_element::<Checked>()?.is_some() {}
        Ok(Checked)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<Checked, A::Error> {
        let mut names = HashSet::new();
        while let Some(name) = members.next_key::<String>()? {
            if names.contains(&name) {
                let name = shortened(&name, 64);
                return Err(de::Error::custom(format!("the member {name:?} is there twice")));
            }
            names.insert(name);
            members.next_value::<Checked>()?;
        }
        Ok(Checked)
    }
}

#[cfg(test)]
mod tests {
    use super::check;

    #[test]
    fn a_member_that_is_there_twice_is_found_at_any_depth() {
        let text = br#"{"a": [{"b": 1.5, "c": null}, {"b": -1, "c": "b"}], "b": {"a": true}}"#;
        check(text).expect("no member is there twice");
        for text in [r#"{"a": 1, "a": 1}"#, r#"[{"a": {"b": [], "c": 1, "b": {}}}]"#] {
            let error = check(text.as_bytes()).expect_err("a member is there twice");
            assert!(error.to_string().contains("is there twice at line 1"), "{error}");
        }
    }
}
