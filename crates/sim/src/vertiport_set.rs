//! A set of vertiports as a few machine words, so that masks cost a handful of instructions and no
//! allocation.

use vertifleet_core::VertiportIx;

const WORDS: usize = 4;

/// A set of vertiports. It can hold all 256 that a scenario may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct VertiportSet {
    words: [u64; WORDS],
}

impl VertiportSet {
    /// The empty set.
    pub const EMPTY: Self = Self { words: [0; WORDS] };

    #[inline]
    fn place(vertiport: VertiportIx) -> (usize, u64) {
        let at = vertiport.at();
        (at / 64, 1 << (at % 64))
    }

    /// Adds a vertiport.
    #[inline]
    pub fn insert(&mut self, vertiport: VertiportIx) {
        let (word, bit) = Self::place(vertiport);
        self.words[word] |= bit;
    }

    /// Removes a vertiport.
    #[inline]
    pub fn remove(&mut self, vertiport: VertiportIx) {
        let (word, bit) = Self::place(vertiport);
        self.words[word] &= !bit;
    }

    /// Whether the vertiport is in the set. An index that no scenario has never is.
    #[inline]
    pub fn contains(&self, vertiport: VertiportIx) -> bool {
        let (word, bit) = Self::place(vertiport);
        self.words.get(word).is_some_and(|word| word & bit != 0)
    }

    /// The vertiports that are in both sets.
    #[inline]
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        Self { words: std::array::from_fn(|word| self.words[word] & other.words[word]) }
    }

    /// The vertiports that are in at least one of the sets.
    #[inline]
    #[must_use]
    pub fn or(&self, other: &Self) -> Self {
        Self { words: std::array::from_fn(|word| self.words[word] | other.words[word]) }
    }

    /// The vertiports of this set that are not in the other.
    #[inline]
    #[must_use]
    pub fn without(&self, other: &Self) -> Self {
        Self { words: std::array::from_fn(|word| self.words[word] & !other.words[word]) }
    }

    /// Number of vertiports in the set.
    #[inline]
    pub fn len(&self) -> u32 {
        // Most networks fit one word; empty words are skipped to save counting their bits.
        self.words.iter().map(|&word| if word == 0 { 0 } else { word.count_ones() }).sum()
    }

    /// Whether no vertiport is in the set.
    pub fn is_empty(&self) -> bool {
        self.words == [0; WORDS]
    }

    /// The member that has `rank` smaller members, or `None` if there are not that many.
    #[inline]
    pub fn nth(&self, mut rank: u32) -> Option<VertiportIx> {
        for (at, &word) in self.words.iter().enumerate() {
            let mut left = word;
            while left != 0 {
                if rank == 0 {
                    return Some(Self::member(at, left));
                }
                rank -= 1;
                left &= left - 1;
            }
        }
        None
    }

    /// The members in ascending order.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = VertiportIx> + use<> {
        let (mut words, mut at) = (self.words, 0);
        std::iter::from_fn(move || {
            while let Some(word) = words.get_mut(at) {
                if *word != 0 {
                    let member = Self::member(at, *word);
                    *word &= *word - 1;
                    return Some(member);
                }
                at += 1;
            }
            None
        })
    }

    /// The smallest member whose bit is set in `word`, the `at`-th word of a set.
    #[inline]
    fn member(at: usize, word: u64) -> VertiportIx {
        VertiportIx::new(at * 64 + word.trailing_zeros() as usize)
    }
}

impl FromIterator<VertiportIx> for VertiportSet {
    fn from_iter<I: IntoIterator<Item = VertiportIx>>(vertiports: I) -> Self {
        let mut set = Self::EMPTY;
        for vertiport in vertiports {
            set.insert(vertiport);
        }
        set
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::{prop_assert_eq, proptest};
    use std::collections::BTreeSet;
    use vertifleet_core::VertiportIx;

    use super::VertiportSet;

    proptest! {
        #[test]
        fn a_set_agrees_with_the_standard_one(
            members in proptest::collection::btree_set(0_u16..256, 0..256), gone in 0_u16..256
        ) {
            let mut set: VertiportSet = members.iter().map(|&at| VertiportIx(at)).collect();
            set.remove(VertiportIx(gone));
            let kept: BTreeSet<u16> = members.iter().copied().filter(|&at| at != gone).collect();

            prop_assert_eq!(set.len() as usize, kept.len());
            prop_assert_eq!(set.is_empty(), kept.is_empty());
            prop_assert_eq!(set.iter().map(|v| v.0).collect::<Vec<_>>(), kept.iter().copied().collect::<Vec<_>>());
            for (rank, &at) in (0..).zip(&kept) {
                prop_assert_eq!(set.nth(rank), Some(VertiportIx(at)));
                assert!(set.contains(VertiportIx(at)));
            }
            prop_assert_eq!(set.nth(set.len()), None);
            assert!(!set.contains(VertiportIx(gone)));
        }
    }
}
