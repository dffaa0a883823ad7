//! The study in a sentence or two, made from its numbers.

use super::Summary;
use crate::numbers::{counted, grouped, p_statement, signed, typeset};

/// Who does best, and whether its lead over the first-named policy is more than chance.
pub(super) fn text(summary: &Summary) -> String {
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
    let lead = match test.difference.interval_95() {
        None => format!("{} points beside {first}", points(test.difference.mean)),
        Some((low, high)) => format!(
            "{} points beside {first} (95 % interval {} to {}; paired t-test, {})",
            points(test.difference.mean),
            points(low),
            points(high),
            p_statement(test.p_value)
        ),
    };
    format!("{earns}: {lead}. It earns more than {first} on {} of them.", test.first_larger)
}
