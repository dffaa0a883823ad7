//! The result of the comparison in one or two sentences.

use vertifleet_picture::numbers::{counted, dollars, grouped, p_statement, signed_dollars};

use vertifleet_study::comparison::{PairedDifference, PolicySummary};
use vertifleet_study::{ComparisonReport, NetworkOrigin};

/// States the profit of the best policy, and whether its lead over the reference is significant.
pub(crate) fn headline(summary: &ComparisonReport) -> String {
    let best = summary.best();
    let earns = format!(
        "{} earns {} a day on average over {}{}",
        best.name,
        dollars(best.profit_usd.mean),
        days(summary),
        of_bound(best)
    );
    match summary.best_against_reference() {
        None => format!("{earns}."),
        Some(comparison) => format!("{earns}{}", lead(summary, comparison)),
    }
}

/// A text such as `100 unseen days of the “paper” network`.
fn days(summary: &ComparisonReport) -> String {
    let changed = summary.network_origin == NetworkOrigin::Changed;
    let copy = if changed { "a changed copy of " } else { "" };
    let network = &summary.network;
    match &summary.days_from {
        None => {
            let days = counted(summary.days, "unseen day", "unseen days");
            format!("{days} of {copy}the “{network}” network")
        }
        Some(from) if from == network => {
            format!("{} from {from}", counted(summary.days, "day", "days"))
        }
        Some(from) => {
            let days = counted(summary.days, "day", "days");
            format!("{days} from {from}, of {copy}the “{network}” network")
        }
    }
}

/// A text such as `, 95.2 % of the proven upper bound`, if bounds were asked for.
fn of_bound(policy: &PolicySummary) -> String {
    policy.bound_share.map_or_else(String::new, |share| {
        format!(", {} % of the proven upper bound", grouped(100.0 * share.mean, 1))
    })
}

fn lead(summary: &ComparisonReport, comparison: &PairedDifference) -> String {
    let test = &comparison.profit_usd;
    let difference = test.difference;
    let other = &summary.policies[comparison.pair.1];
    let share = share(difference.mean, other.profit_usd.mean);
    let p = p_statement(test.p_value);
    match difference.interval_95() {
        None => format!(", {share} {}.", other.name),
        Some(_) if !test.is_significant() => format!(
            ". Its lead over {}, {}, is not significant (paired t-test, {p}).",
            other.name,
            signed_dollars(difference.mean)
        ),
        Some((low, high)) => format!(
            ", {share} {} (95 % interval of the difference {} to {}; paired t-test, {p}).",
            other.name,
            signed_dollars(low),
            signed_dollars(high)
        ),
    }
}

/// A text such as `1.3 % more than`, or one in dollars if a share of the other mean has no meaning.
fn share(difference: f64, other_mean: f64) -> String {
    if difference == 0.0 {
        "as much as".to_owned()
    } else if other_mean > 0.0 {
        format!("{} % more than", grouped(100.0 * difference / other_mean, 1))
    } else {
        format!("{} more than", dollars(difference))
    }
}

#[cfg(test)]
mod tests {
    use super::share;

    #[test]
    fn a_lead_is_a_share_only_of_a_positive_profit() {
        assert_eq!(share(13.0, 1_000.0), "1.3 % more than");
        assert_eq!(share(13.0, -5.0), "$13 more than");
        assert_eq!(share(0.0, 1_000.0), "as much as");
    }
}
