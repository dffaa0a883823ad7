//! Formats numbers for people: grouped thousands, signs, rounded p-values and times. Table, figures
//! and page share it.

/// Rounds to `decimals` and groups the thousands: `-28,747`.
pub fn grouped(value: f64, decimals: usize) -> String {
    let plain = format!("{:.decimals$}", value.abs());
    let (whole, fraction) = plain.split_at(plain.find('.').unwrap_or(plain.len()));
    let mut text = String::with_capacity(plain.len() + 4);
    // A negative value that rounds to zero is written without a sign.
    if value < 0.0 && plain.bytes().any(|digit| matches!(digit, b'1'..=b'9')) {
        text.push('-');
    }
    for (position, digit) in whole.chars().enumerate() {
        if position > 0 && (whole.len() - position).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text + fraction
}

/// A mean of whole numbers: whole where it is large or has no fraction, and else with its first
/// digits.
pub fn mean(value: f64) -> String {
    let decimals = match value.abs() {
        whole if whole.fract() == 0.0 => 0,
        large if large >= 10.0 => 0,
        small if small >= 1.0 => 1,
        small if small >= 0.1 => 2,
        _ => 3,
    };
    grouped(value, decimals)
}

/// Like [`grouped`], with a plus sign before positive values.
pub fn signed(value: f64, decimals: usize) -> String {
    let text = grouped(value, decimals);
    if value > 0.0 && text.bytes().any(|digit| matches!(digit, b'1'..=b'9')) {
        format!("+{text}")
    } else {
        text
    }
}

/// Whole dollars for figures and pages, with a true minus sign: `−$1,234`.
pub fn dollars(value: f64) -> String {
    let text = typeset(&grouped(value, 0));
    match text.strip_prefix('−') {
        Some(amount) => format!("−${amount}"),
        None => format!("${text}"),
    }
}

/// Replaces the hyphen of a number that was written for a terminal by a true minus sign.
pub fn typeset(number: &str) -> String {
    number.replace('-', "−")
}

/// Like [`dollars`], with a plus sign before positive values.
pub fn signed_dollars(value: f64) -> String {
    let text = dollars(value);
    if signed(value, 0).starts_with('+') { format!("+{text}") } else { text }
}

/// A p-value to three decimals, or a statement that it is below them.
pub fn p_value(p: Option<f64>) -> String {
    match p {
        None => "n/a".to_owned(),
        Some(p) if p < 0.001 => "< 0.001".to_owned(),
        Some(p) => format!("{p:.3}"),
    }
}

/// A p-value as a statement: `p = 0.012`, `p < 0.001`.
pub fn p_statement(p: Option<f64>) -> String {
    let value = p_value(p);
    if value.starts_with('<') { format!("p {value}") } else { format!("p = {value}") }
}

/// A time of one decision, to three digits in the unit that suits it.
pub fn duration(nanoseconds: u64) -> String {
    let value = nanoseconds as f64;
    let (scaled, unit) = match nanoseconds {
        0..1_000 => return format!("{nanoseconds} ns"),
        1_000..1_000_000 => (value / 1e3, "µs"),
        1_000_000..1_000_000_000 => (value / 1e6, "ms"),
        _ => (value / 1e9, "s"),
    };
    let decimals = if scaled < 10.0 { 2 } else { usize::from(scaled < 100.0) };
    format!("{scaled:.decimals$} {unit}")
}

/// The length of a bound's slices, which is a number of whole minutes: `3 min`.
pub fn minutes(seconds: u32) -> String {
    format!("{} min", seconds / 60)
}

/// A number with its noun: `1 day`, `100 days`.
pub fn counted(count: usize, singular: &str, plural: &str) -> String {
    format!("{} {}", grouped(count as f64, 0), if count == 1 { singular } else { plural })
}

#[cfg(test)]
mod tests {
    use super::{dollars, duration, grouped, mean, p_value, signed, signed_dollars};

    #[test]
    fn thousands_are_grouped_and_zero_has_no_sign() {
        assert_eq!(grouped(1_234_567.891, 2), "1,234,567.89");
        assert_eq!(grouped(-999.6, 0), "-1,000");
        assert_eq!(grouped(-0.4, 0), "0");
        assert_eq!(signed(0.2, 0), "0");
        assert_eq!(signed(12.0, 0), "+12");
        assert_eq!(dollars(-28_747.0), "−$28,747");
        assert_eq!(signed_dollars(502.4), "+$502");
    }

    #[test]
    fn means_that_are_small_keep_their_first_digits() {
        let written = [0.0, 0.041, 0.66, 2.61, 12.0, 12.6, 2_999.7].map(mean);
        assert_eq!(written, ["0", "0.041", "0.66", "2.6", "12", "13", "3,000"]);
    }

    #[test]
    fn small_p_values_are_bounded_rather_than_rounded_to_zero() {
        assert_eq!(p_value(Some(0.000_4)), "< 0.001");
        assert_eq!(p_value(Some(0.049_6)), "0.050");
        assert_eq!(p_value(None), "n/a");
    }

    #[test]
    fn times_have_the_unit_that_suits_them() {
        assert_eq!(duration(48), "48 ns");
        assert_eq!(duration(1_234), "1.23 µs");
        assert_eq!(duration(110_400), "110 µs");
        assert_eq!(duration(12_340_000), "12.3 ms");
        assert_eq!(duration(2_500_000_000), "2.50 s");
    }
}
