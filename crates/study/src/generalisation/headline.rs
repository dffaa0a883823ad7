//! The result of the study in a sentence or two.

use vertifleet_picture::numbers::{counted, grouped, p_statement, signed, typeset};

use super::GeneralisationReport;

/// Says which policy does best, and whether its lead over the first-named policy is more than chance.
pub(super) fn text(summary: &GeneralisationReport) -> String {
    let best = &summary.policies[summary.best_position()];
    let count = summary.networks.len();
    let earns = format!(
        "{} earns {} % of the proven upper bound on average over a day each of {}",
        best.name,
        grouped(100.0 * best.bound_share.mean, 1),
        counted(count, "random network", "random networks"),
    );
    let Some(test) = &best.minus_first else { return earns + "." };
    let first = &summary.first().name;
    let points = |share: f64| typeset(&signed(100.0 * share, 1));
    let mean = test.difference.mean;
    let apart = grouped(100.0 * mean.abs(), 1);
    let lead = format!("{apart} points {} than {first}", if mean < 0.0 { "less" } else { "more" });
    let trust = test.difference.interval_95().map_or_else(String::new, |(low, high)| {
        let (low, high, p) = (points(low), points(high), p_statement(test.p_value));
        format!(" (95 % interval {low} to {high}; paired t-test, {p})")
    });
    format!("{earns}, {lead}{trust}, and more than {first} on {} of them.", test.first_larger)
}
