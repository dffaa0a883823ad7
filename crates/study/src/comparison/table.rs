//! The comparison as plain text for a terminal: one row per policy, then the paired t-tests.

use std::fmt::Write as _;

use maud::html;
use vertifleet_core::Purpose;
use vertifleet_picture::numbers::{counted, duration, grouped, minutes, p_value, signed};

use super::summary::{ComparisonReport, PairedDifference, PolicySummary};
use crate::origin::NetworkOrigin;
use crate::sees::SEES;
use crate::statistics::Estimate;
use crate::table::{self, append_aligned, estimate};

/// The column of the share of the bound.
const SHARE_COLUMN: usize = 4;
/// The text that `compare` prints: policies by mean profit, then the t-test of every pair on the
/// daily profit. There is no line end after the last line.
pub(crate) fn text(summary: &ComparisonReport) -> String {
    let changed = if summary.network_origin == NetworkOrigin::Changed { " (changed)" } else { "" };
    let mut text =
        format!("network {}{changed}, {}", summary.network, counted(summary.days, "day", "days"));
    if let Some(first) = summary.seed {
        let _ = match summary.split {
            Purpose::Comparison => write!(text, ", seed {first}"),
            split => write!(text, ", {} days from number {first} on", split.name()),
        };
    }
    if let Some(from) = &summary.days_from {
        let _ = write!(text, " of one's own from {from}");
    }
    text.push_str("\n\n");
    append_aligned(&mut text, &policies(summary));
    text.push_str("means a day; ± is the 95 % interval of the mean");
    if let Some(bound) = &summary.bound {
        let amount = estimate(&bound.upper_bound_usd, |value| grouped(value, 0));
        let _ = write!(
            text,
            "\nof bound: share of the certified bound, which no schedule passes: $ {amount} (slices of {})",
            minutes(bound.step_s)
        );
    }
    let _ = write!(text, "\n{SEES}");
    if summary.comparisons.is_empty() {
        return text;
    }
    text.push_str("\n\npaired t-tests of the daily profit, two-sided\n\n");
    append_aligned(&mut text, &tests(summary));
    text.truncate(text.trim_end().len());
    text
}

/// The tables as HTML for notebooks.
pub(crate) fn html(summary: &ComparisonReport) -> String {
    let tables = html! {
        (table::html(&policies(summary)))
        @if !summary.comparisons.is_empty() {
            p { "paired t-tests of the daily profit, two-sided" }
            (table::html(&tests(summary)))
        }
    };
    tables.into_string()
}

/// A heading, and a row for each policy.
fn policies(summary: &ComparisonReport) -> Vec<Vec<String>> {
    let mut policies = vec![heading([
        "policy",
        "sees",
        "profit, $ a day",
        "sd, $",
        "of bound, %",
        "reward",
        "sd",
        "flights",
        "reposition",
        "holds",
        "passengers",
        "load factor",
        "decision median",
        "p99",
    ])];
    policies.extend(summary.policies.iter().map(policy_row));
    if summary.bound.is_none() {
        for row in &mut policies {
            row.remove(SHARE_COLUMN);
        }
    }
    policies
}

/// A heading, and a row for each pair of policies.
fn tests(summary: &ComparisonReport) -> Vec<Vec<String>> {
    let mut tests =
        vec![heading(["first - second", "difference, $", "t", "df", "p", "first ahead"])];
    tests.extend(summary.comparisons.iter().map(|comparison| test_row(comparison, summary.days)));
    tests
}

fn heading<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}

fn policy_row(policy: &PolicySummary) -> Vec<String> {
    let time = |time: Option<u64>| time.map_or("n/a".to_owned(), duration);
    let share = |share: &Estimate| estimate(share, |value| grouped(100.0 * value, 2));
    vec![
        policy.name.clone(),
        policy.sees.to_string(),
        estimate(&policy.profit_usd, |value| grouped(value, 0)),
        policy.profit_usd.standard_deviation.map_or("n/a".to_owned(), |value| grouped(value, 0)),
        policy.bound_share.as_ref().map_or("n/a".to_owned(), share),
        estimate(&policy.reward, |value| format!("{value:.4}")),
        policy.reward.standard_deviation.map_or("n/a".to_owned(), |value| format!("{value:.5}")),
        grouped(policy.flights, 1),
        grouped(policy.repositioning_flights, 1),
        grouped(policy.holds, 1),
        grouped(policy.passengers, 1),
        format!("{:.3}", policy.load_factor),
        time(policy.decision_ns.map(|time| time.median)),
        time(policy.decision_ns.map(|time| time.p99)),
    ]
}

fn test_row(comparison: &PairedDifference, days: usize) -> Vec<String> {
    let test = &comparison.profit_usd;
    let half_width = test.difference.half_width_95.map(|half| format!(" ± {}", grouped(half, 0)));
    vec![
        format!("{} - {}", comparison.first, comparison.second),
        signed(test.difference.mean, 0) + &half_width.unwrap_or_default(),
        test.t.map_or("n/a".to_owned(), |t| grouped(t, 2)),
        test.degrees_of_freedom.to_string(),
        p_value(test.p_value),
        format!("{} of {}", test.first_larger, counted(days, "day", "days")),
    ]
}
