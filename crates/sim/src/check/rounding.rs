//! Rounding to whole seconds and milliwatt-hours, and where it is in doubt.
//!
//! Two correct ways to compute the same number differ in the last bits, which matters where the
//! number is exactly between two whole ones. Only there a schedule may choose.

/// Two ways to compute the same `f64` may differ by this share of it: far more than a handful of
/// roundings, and far less than the precision of any input.
pub(super) const ROUNDING: f64 = 1e-12;

/// An amount rounded to the nearest whole number, halves up. Where the amount is a half and `f64`
/// does not show which side is nearer, `stated` is taken if it is one of the two neighbours.
pub(super) fn nearest(amount: f64, stated: Option<u64>) -> u64 {
    nearest_within(amount, amount * ROUNDING, stated)
}

/// The same for an amount that is known to within `doubt`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "finite and never negative"
)]
pub(super) fn nearest_within(amount: f64, doubt: f64, stated: Option<u64>) -> u64 {
    let past_half = amount.fract() - 0.5;
    let in_doubt = past_half.abs() <= doubt;
    let down = amount as u64;
    match stated {
        Some(stated) if in_doubt && (down..=down + 1).contains(&stated) => stated,
        _ if past_half >= 0.0 => down + 1,
        _ => down,
    }
}

/// Kilowatt-hours in whole milliwatt-hours.
pub(super) fn whole_mwh(kwh: f64) -> u64 {
    nearest(1e6 * kwh, None)
}

/// The one or two whole numbers that are nearest to an amount which is known to within `doubt`, the
/// lower one first.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "finite and never negative"
)]
pub(super) fn both_nearest(amount: f64, doubt: f64) -> [u64; 2] {
    let down = amount as u64;
    [down, down + 1].map(|neighbour| nearest_within(amount, doubt, Some(neighbour)))
}

#[cfg(test)]
mod tests {
    use super::{ROUNDING, both_nearest, nearest};

    #[test]
    fn durations_go_to_the_nearest_second_and_halves_go_up() {
        for (seconds, rounded) in [
            (0.0, 0),
            (0.4, 0),
            (0.499_999, 0),
            (0.5, 1),
            (1.6, 2),
            (562.5, 563),
            (3.6e9, 3_600_000_000),
        ] {
            assert_eq!(nearest(seconds, None), rounded, "{seconds}");
        }
    }

    #[test]
    fn only_at_half_a_second_may_a_schedule_choose_the_rounding() {
        // 12.3 miles at 80 mph take half a second exactly, which in binary is on one side or the
        // other.
        let half = 3600.0 * 12.3 / 80.0;
        assert_eq!(nearest(half, Some(553)), 553);
        assert_eq!(nearest(half, Some(554)), 554);
        assert_eq!(nearest(half, Some(555)), 554);
        assert_eq!(nearest(553.499_999, Some(554)), 553);
        assert_eq!(nearest(553.500_001, Some(553)), 554);
        assert_eq!(both_nearest(half, half * ROUNDING), [553, 554]);
        assert_eq!(both_nearest(553.499_999, 1e-9), [553, 553]);
        assert_eq!(both_nearest(553.500_001, 1e-9), [554, 554]);
    }
}
