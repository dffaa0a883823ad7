//! Money in whole micro-dollars, rounded to the safe side, so that sums are exact and bounds remain
//! valid.
//!
//! Numbers of a day are within bounds (`vertifleet_core`): no passenger, and no flight with its
//! charge, is worth 8,000,000 dollars, which are 2^43 micro-dollars. `f64` holds such amounts to
//! less than a hundredth of a micro-dollar, even after the few operations that computed them.
//! Rounding outwards *and* by one more micro-dollar is therefore always outwards.

/// Micro-dollars in a dollar.
const MICRO: f64 = 1e6;

/// Dollars in micro-dollars, rounded to no less than the true amount.
pub(super) fn up(usd: f64) -> i64 {
    whole((usd * MICRO).ceil()) + 1
}

/// Dollars in micro-dollars, rounded to no more than the true amount.
pub(super) fn down(usd: f64) -> i64 {
    whole((usd * MICRO).floor()) - 1
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "`as` saturates, and makes 0 of what is no number"
)]
fn whole(micro: f64) -> i64 {
    micro as i64
}

/// Micro-dollars in dollars, for display and for floating-point work.
pub(super) fn usd(micro: i64) -> f64 {
    micro as f64 / MICRO
}

/// An exact sum in dollars, rounded to no less than the true amount.
pub(super) fn usd_up(micro: i128) -> f64 {
    if micro == 0 {
        return 0.0;
    }
    // Conversion and division are each off by at most half a unit in the last place.
    (micro as f64 / MICRO).next_up().next_up()
}
