//! A deserializer that refuses entries of a list beyond those that are read.
//!
//! Readers of a list of fixed length, such as `[f64; 2]` or the members of a struct without their
//! names, stop after the last entry that they need. Some parsers, among them that of TOML, then
//! drop the rest silently. The wrapper here looks for that rest behind every list of a file, so no
//! type that is read has to.

use std::fmt;

use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, Error, IgnoredAny, MapAccess, SeqAccess,
    VariantAccess, Visitor,
};

/// A deserializer, or a part of one, whose lists are read to their ends.
pub(super) struct Whole<T>(pub(super) T);

/// A list that counts the entries that are read.
struct Entries<A> {
    list: A,
    read: usize,
}

impl<'de, A: SeqAccess<'de>> Entries<A> {
    /// Refuses entries that have not been read.
    fn end(mut self) -> Result<(), A::Error> {
        let expected = self.read;
        while self.list.next_element::<IgnoredAny>()?.is_some() {
            self.read += 1;
        }
        if self.read == expected {
            return Ok(());
        }
        let entries = if expected == 1 { "entry" } else { "entries" };
        Err(A::Error::custom(format!(
            "expected a list of {expected} {entries}, found {}",
            self.read
        )))
    }
}

impl<'de, A: SeqAccess<'de>> SeqAccess<'de> for &mut Entries<A> {
    type Error = A::Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, A::Error> {
        let entry = self.list.next_element_seed(Whole(seed))?;
        self.read += usize::from(entry.is_some());
        Ok(entry)
    }

    fn size_hint(&self) -> Option<usize> {
        self.list.size_hint()
    }
}

/// Methods that pass their arguments on, with the visitor wrapped.
macro_rules! deserialize {
    ($($method:ident($($argument:ident: $kind:ty),*);)*) => {
        $(fn $method<V: Visitor<'de>>(
            self,
            $($argument: $kind,)*
            visitor: V,
        ) -> Result<V::Value, D::Error> {
            self.0.$method($($argument,)* Whole(visitor))
        })*
    };
}

impl<'de, D: Deserializer<'de>> Deserializer<'de> for Whole<D> {
    type Error = D::Error;

    deserialize! {
        deserialize_any();
        deserialize_bool();
        deserialize_i8();
        deserialize_i16();
        deserialize_i32();
        deserialize_i64();
        deserialize_i128();
        deserialize_u8();
        deserialize_u16();
        deserialize_u32();
        deserialize_u64();
        deserialize_u128();
        deserialize_f32();
        deserialize_f64();
        deserialize_char();
        deserialize_str();
        deserialize_string();
        deserialize_bytes();
        deserialize_byte_buf();
        deserialize_option();
        deserialize_unit();
        deserialize_unit_struct(name: &'static str);
        deserialize_newtype_struct(name: &'static str);
        deserialize_seq();
        deserialize_tuple(entries: usize);
        deserialize_tuple_struct(name: &'static str, entries: usize);
        deserialize_map();
        deserialize_struct(name: &'static str, members: &'static [&'static str]);
        deserialize_enum(name: &'static str, variants: &'static [&'static str]);
        deserialize_identifier();
        deserialize_ignored_any();
    }

    fn is_human_readable(&self) -> bool {
        self.0.is_human_readable()
    }
}

/// Methods that pass a value on as it is.
macro_rules! visit {
    ($($method:ident($kind:ty);)*) => {
        $(fn $method<E: Error>(self, value: $kind) -> Result<V::Value, E> {
            self.0.$method(value)
        })*
    };
}

impl<'de, V: Visitor<'de>> Visitor<'de> for Whole<V> {
    type Value = V::Value;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.expecting(formatter)
    }

    visit! {
        visit_bool(bool);
        visit_i8(i8);
        visit_i16(i16);
        visit_i32(i32);
        visit_i64(i64);
        visit_i128(i128);
        visit_u8(u8);
        visit_u16(u16);
        visit_u32(u32);
        visit_u64(u64);
        visit_u128(u128);
        visit_f32(f32);
        visit_f64(f64);
        visit_char(char);
        visit_str(&str);
        visit_borrowed_str(&'de str);
        visit_string(String);
        visit_bytes(&[u8]);
        visit_borrowed_bytes(&'de [u8]);
        visit_byte_buf(Vec<u8>);
    }

    fn visit_none<E: Error>(self) -> Result<V::Value, E> {
        self.0.visit_none()
    }

    fn visit_unit<E: Error>(self) -> Result<V::Value, E> {
        self.0.visit_unit()
    }

    fn visit_some<D: Deserializer<'de>>(self, value: D) -> Result<V::Value, D::Error> {
        self.0.visit_some(Whole(value))
    }

    fn visit_newtype_struct<D: Deserializer<'de>>(self, value: D) -> Result<V::Value, D::Error> {
        self.0.visit_newtype_struct(Whole(value))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<V::Value, A::Error> {
        let mut entries = Entries { list, read: 0 };
        let value = self.0.visit_seq(&mut entries)?;
        entries.end()?;
        Ok(value)
    }

    fn visit_map<A: MapAccess<'de>>(self, members: A) -> Result<V::Value, A::Error> {
        self.0.visit_map(Whole(members))
    }

    fn visit_enum<A: EnumAccess<'de>>(self, value: A) -> Result<V::Value, A::Error> {
        self.0.visit_enum(Whole(value))
    }
}

impl<'de, S: DeserializeSeed<'de>> DeserializeSeed<'de> for Whole<S> {
    type Value = S::Value;

    fn deserialize<D: Deserializer<'de>>(self, value: D) -> Result<S::Value, D::Error> {
        self.0.deserialize(Whole(value))
    }
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for Whole<A> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, A::Error> {
        self.0.next_key_seed(seed)
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, A::Error> {
        self.0.next_value_seed(Whole(seed))
    }

    fn size_hint(&self) -> Option<usize> {
        self.0.size_hint()
    }
}

impl<'de, A: EnumAccess<'de>> EnumAccess<'de> for Whole<A> {
    type Error = A::Error;
    type Variant = Whole<A::Variant>;

    fn variant_seed<S: DeserializeSeed<'de>>(
        self,
        seed: S,
    ) -> Result<(S::Value, Self::Variant), A::Error> {
        let (value, variant) = self.0.variant_seed(seed)?;
        Ok((value, Whole(variant)))
    }
}

impl<'de, A: VariantAccess<'de>> VariantAccess<'de> for Whole<A> {
    type Error = A::Error;

    fn unit_variant(self) -> Result<(), A::Error> {
        self.0.unit_variant()
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value, A::Error> {
        self.0.newtype_variant_seed(Whole(seed))
    }

    fn tuple_variant<V: Visitor<'de>>(
        self,
        entries: usize,
        visitor: V,
    ) -> Result<V::Value, A::Error> {
        self.0.tuple_variant(entries, Whole(visitor))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        members: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, A::Error> {
        self.0.struct_variant(members, Whole(visitor))
    }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::Whole;

    #[derive(Debug, Deserialize, PartialEq)]
    struct Named {
        one: f64,
        two: f64,
    }

    #[derive(Debug, Deserialize, PartialEq)]
    enum Variant {
        Tuple(f64, f64),
        Newtype([f64; 1]),
    }

    /// Every form in which a list of fixed length may be part of a type.
    #[derive(Debug, Default, Deserialize, PartialEq)]
    #[serde(default)]
    struct File {
        array: Option<[f64; 2]>,
        tuple: Option<(f64, String)>,
        list: Vec<[f64; 2]>,
        named: Option<Named>,
        variant: Option<Variant>,
    }

    fn toml(text: &str) -> Result<File, String> {
        let file = toml::Deserializer::parse(text).expect("TOML");
        File::deserialize(Whole(file)).map_err(|error| error.message().to_owned())
    }

    #[test]
    fn no_entry_is_dropped_from_a_list_of_any_form() {
        let whole = [
            "array = [1, 2]",
            "tuple = [1, 'a']",
            "list = [[1, 2], [3, 4], [5, 6]]",
            "named = [1, 2]",
            "variant = { Tuple = [1, 2] }",
            "variant = { Newtype = [1] }",
        ];
        for text in whole {
            assert!(toml(text).is_ok_and(|file| file != File::default()), "{text}");
            let text = text.replacen(']', ", 9]", 1);
            let problem = toml(&text).expect_err("an entry too many");
            // The parser itself refuses a variant with more values than it has.
            let (list, variant) = ("expected a list of ", "expected tuple with length ");
            assert!(problem.starts_with(list) || problem.starts_with(variant), "{text}: {problem}");
        }
        assert_eq!(
            toml("array = [1, 2, 3, 4]"),
            Err("expected a list of 2 entries, found 4".to_owned())
        );
    }

    #[test]
    fn json_reports_the_list_and_not_a_syntax_error() {
        let mut text = serde_json::Deserializer::from_str(r#"{"list": [[1, 2], [3, 4, 5]]}"#);
        let error = File::deserialize(Whole(&mut text)).expect_err("an entry too many");
        assert!(error.is_data(), "{error}");
        assert_eq!(error.to_string(), "expected a list of 2 entries, found 3 at line 1 column 27");
    }
}
