//! The fleet of a base with another number of aircraft: every type keeps its share.

use toml_edit::{DocumentMut, Item, Table, TableLike, Value};

/// Gives the fleet of a network's text `aircraft` aircraft in all, and notes it in a comment above.
pub(crate) fn resize(file: &mut DocumentMut, aircraft: u32, base: &str) {
    let mut entries = entries(file);
    let counts: Vec<u32> = entries.iter().map(|entry| count(*entry)).collect();
    for (entry, count) in entries.iter_mut().zip(shares(&counts, aircraft)) {
        if let Some(Item::Value(value)) = entry.get_mut("count") {
            let decor = value.decor().clone();
            *value = Value::from(i64::from(count));
            *value.decor_mut() = decor;
        }
    }
    let before: u64 = counts.into_iter().map(u64::from).sum();
    let comment = format!(
        "# The import was asked for {aircraft} aircraft; {base} has {before}, and each type keeps its share of them.\n"
    );
    add_comment(file, &comment);
}

/// The entries of the fleet, which are sections or entries of one list.
fn entries(file: &mut DocumentMut) -> Vec<&mut dyn TableLike> {
    match file.get_mut("fleet") {
        Some(Item::ArrayOfTables(tables)) => {
            tables.iter_mut().map(|table| table as &mut dyn TableLike).collect()
        }
        Some(Item::Value(Value::Array(list))) => list
            .iter_mut()
            .filter_map(|entry| Some(entry.as_inline_table_mut()? as &mut dyn TableLike))
            .collect(),
        _ => Vec::new(),
    }
}

/// The number of aircraft of an entry. The base was read, so it is whole and small.
fn count(entry: &dyn TableLike) -> u32 {
    let value = entry.get("count").and_then(Item::as_value);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 10,000")]
    let of_float = |number: f64| number as u32;
    let whole = value.and_then(|value| u32::try_from(value.as_integer()?).ok());
    whole.or_else(|| value?.as_float().map(of_float)).unwrap_or(0)
}

/// Adds a comment above the fleet, below the one that is there.
fn add_comment(file: &mut DocumentMut, comment: &str) {
    if let Some(Item::ArrayOfTables(tables)) = file.get_mut("fleet") {
        let decor = tables.get_mut(0).map(Table::decor_mut);
        if let Some(decor) = decor {
            let before = decor.prefix().and_then(|prefix| prefix.as_str()).unwrap_or("\n");
            decor.set_prefix(format!("{before}{comment}"));
        }
    } else if let Some(mut key) = file.key_mut("fleet") {
        let before = key.leaf_decor().prefix().and_then(|prefix| prefix.as_str());
        let commented = format!("{}{comment}", before.unwrap_or_default());
        key.leaf_decor_mut().set_prefix(commented);
    }
}

/// Whole numbers that add up to `total` in the proportion of `counts`, by largest remainder; the
/// first of equal remainders gets the aircraft.
fn shares(counts: &[u32], total: u32) -> Vec<u32> {
    let all: u64 = counts.iter().copied().map(u64::from).sum::<u64>().max(1);
    let exact = |count: &u32| u64::from(*count) * u64::from(total);
    let mut shares: Vec<u32> = counts
        .iter()
        .map(|count| u32::try_from(exact(count) / all).expect("no share is above the total"))
        .collect();
    let mut by_remainder: Vec<usize> = (0..counts.len()).collect();
    by_remainder.sort_by_key(|&at| std::cmp::Reverse(exact(&counts[at]) % all));
    let left = total.saturating_sub(shares.iter().sum());
    for (at, _) in by_remainder.into_iter().zip(0..left) {
        shares[at] += 1;
    }
    shares
}

#[cfg(test)]
mod tests {
    use proptest::prelude::{prop, proptest};

    use super::shares;

    #[test]
    fn what_is_left_goes_to_the_largest_remainders() {
        assert_eq!(shares(&[16, 16], 7), [4, 3]);
        assert_eq!(shares(&[10, 20, 1], 8), [3, 5, 0]);
        assert_eq!(shares(&[3], 40), [40]);
        assert_eq!(shares(&[0, 5], 0), [0, 0]);
    }

    proptest! {
        #[test]
        fn shares_add_up_and_are_next_to_the_exact_ones(
            counts in prop::collection::vec(1..10_000_u32, 1..9), total in 0..10_000_u32,
        ) {
            let all: u64 = counts.iter().copied().map(u64::from).sum();
            let shares = shares(&counts, total);
            assert_eq!(shares.iter().sum::<u32>(), total);
            for (&count, share) in counts.iter().zip(shares) {
                let exact = u64::from(count) * u64::from(total);
                let least = exact / all;
                assert!((least..=least + 1).contains(&u64::from(share)));
            }
        }
    }
}
