//! Directions of random signs, which are functions of the seed alone and are never stored.

use vertifleet_policy::draw;

/// Number of signs in a word.
const WORD: usize = 64;

/// A direction in which weights are moved: +1 or -1 for each weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Direction {
    /// Differs for every generation of every run.
    pub(super) seed: u64,
    /// The number of the pair in its generation.
    pub(super) pair: u64,
}

impl Direction {
    /// Adds `length` times the direction to some numbers.
    pub(super) fn add_to(self, numbers: &mut [f32], length: f32) {
        for (at, numbers) in numbers.chunks_mut(WORD).enumerate() {
            let at = u32::try_from(at).expect("a policy has fewer than 2^38 weights");
            let mut signs = draw(self.seed, self.pair, at);
            for number in numbers {
                *number += if signs & 1 == 0 { length } else { -length };
                signs >>= 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Direction;

    #[test]
    fn directions_are_of_signs_and_nearly_at_right_angles() {
        let direction = |seed, pair| {
            let mut numbers = vec![0.0; 10_000];
            Direction { seed, pair }.add_to(&mut numbers, 1.0);
            numbers
        };
        let some = [direction(1, 0), direction(1, 1), direction(2, 0), direction(2, 1)];
        assert!(some.iter().flatten().all(|number| number.abs() == 1.0));
        for (at, one) in some.iter().enumerate() {
            assert!(one.iter().sum::<f32>().abs() < 500.0, "as many of each sign");
            for other in &some[at + 1..] {
                let product: f32 = one.iter().zip(other).map(|(one, other)| one * other).sum();
                assert!(product.abs() < 500.0, "{product} of 10,000");
            }
        }
    }

    #[test]
    fn a_move_there_and_back_leaves_numbers_where_they_were() {
        let begun = vec![0.5; 130];
        let mut numbers = begun.clone();
        let direction = Direction { seed: 3, pair: 7 };
        direction.add_to(&mut numbers, 0.25);
        assert!(numbers.iter().all(|&number| number == 0.75 || number == 0.25));
        direction.add_to(&mut numbers, -0.25);
        assert_eq!(numbers, begun);
    }
}
