//! Ids for file names, feeds and web addresses, made from ids that may hold any printable
//! character.

use std::collections::{HashMap, HashSet};

/// An id of ASCII letters, digits, `-` and `_` for each given id. An id of these characters stays
/// as it is. Others have `_` in place of each other character, and a number at the end if the
/// result is another's id. Ids that differ only in capitals get different names too, because file
/// systems may treat them as equal.
pub(crate) fn safe_ids<'a>(ids: impl Iterator<Item = &'a str> + Clone) -> Vec<String> {
    let mut used = HashSet::new();
    // Ids that are safe come first, so that no other id takes theirs.
    let kept: Vec<bool> =
        ids.clone().map(|id| safe(id) == id && used.insert(id.to_ascii_lowercase())).collect();
    // Numbers that were tried are not tried again, because thousands of ids may have the same safe
    // letters.
    let mut tried: HashMap<String, u32> = HashMap::new();
    let mut new_id = |id: &str| {
        let safe = safe(id);
        let number = tried.entry(safe.to_ascii_lowercase()).or_default();
        loop {
            *number += 1;
            let candidate = if *number == 1 { safe.clone() } else { format!("{safe}-{number}") };
            if used.insert(candidate.to_ascii_lowercase()) {
                return candidate;
            }
        }
    };
    ids.zip(kept).map(|(id, kept)| if kept { id.to_owned() } else { new_id(id) }).collect()
}

/// The id with `_` in place of everything but ASCII letters, digits, `-` and `_`.
pub(crate) fn safe(id: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_';
    id.chars().map(|letter| if plain(letter) { letter } else { '_' }).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use proptest::prelude::{prop, prop_assert, prop_assert_eq, proptest};

    use super::{safe, safe_ids};

    #[test]
    fn plain_ids_stay_and_others_are_told_apart() {
        let ids = ["a/b", "a_b", "a b", "A_B", "Zürich", "..", "V1"];
        let expected = ["a_b-2", "a_b", "a_b-3", "A_B-4", "Z_rich", "__", "V1"];
        assert_eq!(safe_ids(ids.into_iter()), expected);
    }

    proptest! {
        #[test]
        fn ids_are_safe_and_unique(ids in prop::collection::vec("[aA ,_-]{1,3}|\\PC{1,4}", 0..30)) {
            let safe_ids = safe_ids(ids.iter().map(String::as_str));
            prop_assert_eq!(safe_ids.len(), ids.len());
            let unique: HashSet<String> = safe_ids.iter().map(|id| id.to_lowercase()).collect();
            prop_assert_eq!(unique.len(), ids.len());
            prop_assert!(safe_ids.iter().all(|id| safe(id) == *id && !id.is_empty()));
        }
    }
}
