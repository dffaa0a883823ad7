//! The passengers that aircraft ask for: the pairs and demand periods whose price, or running mean
//! of the excess, has moved away from where it rests.
//!
//! A fleet asks for a small share of all passengers (a tenth of the pairs, on a day of 100
//! vertiports). As long as no flight asks for the passengers of a pair, their price is zero, the
//! mean of their excess is minus their number to the last bit, and a pass changes neither. So a
//! search looks only at the pairs that are listed here, in the order of all pairs, and every sum
//! over them is the sum over all.

/// A set of positions among all pairs of all demand periods, in ascending order.
#[derive(Debug, Clone)]
pub(super) struct Wanted {
    /// A bit for each position.
    is_listed: Vec<u64>,
    listed: Vec<u32>,
    /// The positions that the latest pass has added, in ascending order once they are
    /// [settled](Self::settle).
    fresh: Vec<u32>,
}

impl Wanted {
    /// No positions, of a given number.
    pub(super) fn none_of(positions: usize) -> Self {
        Self { is_listed: vec![0; positions.div_ceil(64)], listed: Vec::new(), fresh: Vec::new() }
    }

    /// Begins a pass, which has added nothing yet.
    pub(super) fn begin_pass(&mut self) {
        self.fresh.clear();
    }

    /// Adds a position.
    #[inline]
    pub(super) fn add(&mut self, position: usize) {
        let (word, bit) = (position / 64, 1 << (position % 64));
        if self.is_listed[word] & bit == 0 {
            self.is_listed[word] |= bit;
            self.fresh.push(u32::try_from(position).expect("a day has fewer pairs than 2^32"));
        }
    }

    /// Ends a pass: puts what it has added in its place among the others.
    pub(super) fn settle(&mut self) {
        self.fresh.sort_unstable();
        let (mut old, mut new) = (self.listed.len(), self.fresh.len());
        self.listed.resize(old + new, 0);
        // From the back, where there is room.
        while new > 0 {
            let at = old + new - 1;
            if old > 0 && self.listed[old - 1] > self.fresh[new - 1] {
                self.listed[at] = self.listed[old - 1];
                old -= 1;
            } else {
                self.listed[at] = self.fresh[new - 1];
                new -= 1;
            }
        }
    }

    /// All positions, in ascending order.
    #[inline]
    pub(super) fn all(&self) -> impl Iterator<Item = usize> {
        self.listed.iter().map(|&position| position as usize)
    }

    /// The positions that the latest pass has added.
    pub(super) fn fresh(&self) -> impl Iterator<Item = usize> {
        self.fresh.iter().map(|&position| position as usize)
    }

    /// Removes the positions for which `stays` is false.
    pub(super) fn retain(&mut self, mut stays: impl FnMut(usize) -> bool) {
        let is_listed = &mut self.is_listed;
        self.listed.retain(|&position| {
            let position = position as usize;
            let stays = stays(position);
            if !stays {
                is_listed[position / 64] &= !(1 << (position % 64));
            }
            stays
        });
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::Wanted;
    use crate::draw;

    #[test]
    fn positions_are_listed_once_and_in_order() {
        let (mut wanted, mut plain) = (Wanted::none_of(200), BTreeSet::new());
        for pass in 0..20 {
            wanted.begin_pass();
            let before = plain.clone();
            for number in 0..draw(1, pass, 0) % 40 {
                let position = usize::try_from(draw(2, pass, 1) % 97 + number * number % 103)
                    .expect("a small number");
                wanted.add(position);
                plain.insert(position);
            }
            wanted.settle();
            assert!(wanted.fresh().eq(plain.difference(&before).copied()));
            let gone = usize::try_from(pass).expect("a small number") * 9;
            wanted.retain(|position| position != gone);
            plain.remove(&gone);
            assert!(wanted.all().eq(plain.iter().copied()));
        }
    }
}
