//! The study as plain text for a terminal, with one row per policy.

use vertifleet_picture::numbers::{counted, grouped, minutes, p_value, signed};

use super::GeneralisationReport;
use crate::sees::SEES;
use crate::share::PolicyShare;
use crate::table::{append_aligned, estimate};

/// The text that `generalise` prints, without a line end after the last line.
pub(super) fn text(summary: &GeneralisationReport) -> String {
    let first = &summary.first().name;
    let networks = counted(summary.networks.len(), "random network", "random networks");
    let mut text = format!("{networks}, a day of each\n\n");
    let heading = [
        "policy".to_owned(),
        "sees".to_owned(),
        "of bound, %".to_owned(),
        "lowest, %".to_owned(),
        format!("above {first}"),
        format!("minus {first}, points"),
        "p".to_owned(),
    ];
    let mut rows = vec![heading.to_vec()];
    rows.extend(summary.policies.iter().map(|policy| row(policy, summary.networks.len())));
    append_aligned(&mut text, &rows);
    text.push_str("means over the networks; ± is the 95 % interval of the mean; p is of paired t-tests, two-sided\n");
    text.push_str("of bound: share of the certified bound, which no schedule passes (slices of ");
    text.push_str(&minutes(summary.bound_step_s));
    text.push(')');
    text.push('\n');
    text.push_str(SEES);
    text
}

fn row(policy: &PolicyShare, networks: usize) -> Vec<String> {
    let percent = |share: f64| grouped(100.0 * share, 2);
    let [above, minus, p] = match &policy.minus_first {
        None => [const { String::new() }; 3],
        Some(test) => {
            let half = test.difference.half_width_95.map(|half| format!(" ± {}", percent(half)));
            [
                format!("{} of {networks}", test.first_larger),
                signed(100.0 * test.difference.mean, 2) + &half.unwrap_or_default(),
                p_value(test.p_value),
            ]
        }
    };
    vec![
        policy.name.clone(),
        policy.sees.to_string(),
        estimate(&policy.bound_share, percent),
        percent(policy.lowest_bound_share),
        above,
        minus,
        p,
    ]
}
