//! Money in whole micro-dollars, rounded to the safe side, so that sums are exact and a bound stays one.
//!
//! Numbers of a day are within bounds (`vertifleet_core`): no passenger, and no flight with its charge, is worth 8,000,000 dollars, 2^43
//! micro-dollars. `f64` holds such amounts to less than a hundredth of a micro-dollar, also after the few operations
//! that made them. Rounding outwards *and* by one more micro-dollar is therefore always outwards.

/// Micro-dollars of a dollar.
const MICRO: f64 = 1e6;

/// At least as many micro-dollars as these dollars.
pub(super) fn up(usd: f64) -> i64 {
    whole((usd * MICRO).ceil()) + 1
}

/// At most as many micro-dollars as these dollars.
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

/// Dollars, for people and for floating-point work.
pub(super) fn usd(micro: i64) -> f64 {
    micro as f64 / MICRO
}

/// The dollars of an exact sum, or a number just above them.
pub(super) fn usd_up(micro: i128) -> f64 {
    if micro == 0 {
        return 0.0;
    }
    // Conversion and division are each off by half a unit in the last place at most.
    (micro as f64 / MICRO).next_up().next_up()
}
