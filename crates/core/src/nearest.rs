//! Finds the name that a mistyped one probably means.

/// The name that differs from `typed` in the fewest letters, if few enough differ for a typing
/// error: at most one in three. Capitals and small letters count as the same.
pub fn nearest<'a>(typed: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let typed = typed.to_lowercase();
    let most = typed.chars().count().div_ceil(3);
    let distance = |name: &&str| letters_that_differ(&typed, &name.to_lowercase());
    names.into_iter().min_by_key(distance).filter(|name| distance(name) <= most)
}

/// The number of letters to insert, remove, exchange or swap with their neighbour to turn one word
/// into the other.
fn letters_that_differ(one: &str, other: &str) -> usize {
    let (one, other): (Vec<char>, Vec<char>) = (one.chars().collect(), other.chars().collect());
    // `rows[i][j]` is the distance between the first `i` letters of `one` and the first `j` letters
    // of `other`.
    let mut rows: Vec<Vec<usize>> = vec![(0..=other.len()).collect()];
    for (i, letter) in one.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, other_letter) in other.iter().enumerate() {
            let exchanged = rows[i][j] + usize::from(letter != other_letter);
            let mut least = exchanged.min(rows[i][j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && one[i - 1] == *other_letter && *letter == other[j - 1] {
                least = least.min(rows[i - 1][j - 1] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[one.len()][other.len()]
}

#[cfg(test)]
mod tests {
    use super::{letters_that_differ, nearest};

    #[test]
    fn what_was_meant_is_found_and_nothing_is_made_up() {
        let names = ["random", "greedy", "prices", "rolling", "gcaps-x"];
        let cases = [
            ("greeedy", Some("greedy")),
            ("Greedy", Some("greedy")),
            ("pirces", Some("prices")),
            ("gcapsx", Some("gcaps-x")),
            ("roll-ing", Some("rolling")),
            ("", None),
            ("fastest", None),
        ];
        for (typed, meant) in cases {
            assert_eq!(nearest(typed, names), meant, "{typed}");
        }
    }

    #[test]
    fn neighbours_that_changed_places_count_once() {
        assert_eq!(letters_that_differ("paepr", "paper"), 1);
        assert_eq!(letters_that_differ("", "paper"), 5);
        assert_eq!(letters_that_differ("new-york", "new-york"), 0);
    }
}
