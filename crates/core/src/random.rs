//! Draws that demand and disturbances share.

use rand::Rng;
use rand_chacha::ChaCha8Rng;

use crate::limits::MOST_PASSENGERS;

/// A uniform draw from [0, 1) with 53 random bits.
pub(crate) fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// The nearest whole number, not below 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative, and means and sds are bounded"
)]
pub(crate) fn to_whole(drawn: f64) -> u32 {
    drawn.round().max(0.0) as u32
}

/// Rounds `passengers` up or down by chance, so that the mean is `passengers`. A negative number
/// gives 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative, and bounded"
)]
pub(crate) fn rounded_by_chance(passengers: f64, random: &mut ChaCha8Rng) -> u32 {
    (passengers.clamp(0.0, MOST_PASSENGERS - 1.0) + uniform(random)) as u32
}
