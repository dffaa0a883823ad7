//! Means by level where some combinations of levels are missing, so that plain means would compare
//! unlike cells: a fleet for which there is a place only with many stands would owe its profit to
//! the stands.
//!
//! Each number is taken for a sum of one effect for each factor, and the effects are those with the
//! least squares of what is left (Searle, Speed and Milliken, "Population marginal means in the
//! linear model", 1980). They are found by backfitting: one factor after another takes the mean of
//! what the others leave.

/// Rounds after which the effects are taken as they are.
const MOST_ROUNDS: usize = 500;
/// Effects that move less than this share of the numbers have settled.
const SETTLED: f64 = 1e-10;

/// The mean of each level of each factor. `factors` has the positions of the numbers by factor and
/// level.
pub(super) fn plain_means(factors: &[Vec<Vec<usize>>], numbers: &[f64]) -> Vec<Vec<f64>> {
    factors.iter().map(|levels| means(levels, numbers)).collect()
}

/// The mean that each level of each factor would have with all levels of the others alike.
pub(super) fn level_means(factors: &[Vec<Vec<usize>>], numbers: &[f64]) -> Vec<Vec<f64>> {
    let middle = numbers.iter().sum::<f64>() / numbers.len() as f64;
    let mut effects: Vec<Vec<f64>> = factors.iter().map(|levels| vec![0.0; levels.len()]).collect();
    let mut left: Vec<f64> = numbers.iter().map(|number| number - middle).collect();
    let settled = SETTLED * left.iter().fold(1e-9, |most: f64, one| most.max(one.abs()));
    for _ in 0..MOST_ROUNDS {
        let mut moved = 0.0_f64;
        for (levels, effects) in factors.iter().zip(&mut effects) {
            for (level, (shift, effect)) in
                levels.iter().zip(means(levels, &left).into_iter().zip(effects))
            {
                *effect += shift;
                moved = moved.max(shift.abs());
                for &at in level {
                    left[at] -= shift;
                }
            }
        }
        if moved <= settled {
            break;
        }
    }
    effects
        .into_iter()
        .map(|effects| effects.into_iter().map(|effect| middle + effect).collect())
        .collect()
}

fn means(levels: &[Vec<usize>], numbers: &[f64]) -> Vec<f64> {
    let mean =
        |level: &Vec<usize>| level.iter().map(|&at| numbers[at]).sum::<f64>() / level.len() as f64;
    levels.iter().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::{level_means, plain_means};

    /// The cells of a grid that are there, their positions by level, and their numbers.
    fn grid(
        sizes: [usize; 2],
        is_there: impl Fn(usize, usize) -> bool,
        number: impl Fn(usize, usize) -> f64,
    ) -> (Vec<Vec<Vec<usize>>>, Vec<f64>) {
        let cells = (0..sizes[0]).flat_map(|one| (0..sizes[1]).map(move |other| (one, other)));
        let cells: Vec<(usize, usize)> =
            cells.filter(|&(one, other)| is_there(one, other)).collect();
        let of = |level: usize, factor: fn(&(usize, usize)) -> usize| {
            (0..cells.len()).filter(|&at| factor(&cells[at]) == level).collect()
        };
        let rows = (0..sizes[0]).map(|level| of(level, |cell| cell.0)).collect();
        let columns = (0..sizes[1]).map(|level| of(level, |cell| cell.1)).collect();
        let numbers = cells.iter().map(|&(one, other)| number(one, other)).collect();
        (vec![rows, columns], numbers)
    }

    #[test]
    fn effects_of_a_sum_are_found_where_a_corner_is_missing() {
        let sum =
            |row: usize, column: usize| 100.0 + 7.0 * row as f64 - 2.0 * (column * column) as f64;
        let (factors, numbers) = grid([4, 3], |row, column| row < 2 || column > 0, sum);
        let [rows, columns] = &level_means(&factors, &numbers)[..] else { panic!("two factors") };
        for row in 1..4 {
            assert!((rows[row] - rows[row - 1] - 7.0).abs() < 1e-6, "{rows:?}");
        }
        assert!((columns[1] - columns[0] + 2.0).abs() < 1e-6, "{columns:?}");
        assert!((columns[2] - columns[1] + 6.0).abs() < 1e-6, "{columns:?}");
        let [plain, _] = &plain_means(&factors, &numbers)[..] else { panic!("two factors") };
        assert!(
            (plain[2] - plain[1] - 7.0).abs() > 1.0,
            "plain means compare unlike cells: {plain:?}"
        );
    }

    #[test]
    fn in_a_whole_grid_they_are_plain_means() {
        let number = |row: usize, column: usize| ((row * 7 + column * 3) % 5) as f64;
        let (factors, numbers) = grid([5, 4], |_, _| true, number);
        let (fitted, plain) = (level_means(&factors, &numbers), plain_means(&factors, &numbers));
        for (fitted, plain) in fitted.concat().iter().zip(plain.concat()) {
            assert!((fitted - plain).abs() < 1e-9, "{fitted} {plain}");
        }
    }
}
