//! An evaluation as plain text for a terminal.

use std::fmt::Write as _;

use maud::html;
use vertifleet_picture::numbers::{duration, grouped, minutes, p_value, signed};

use super::{EvaluatedPolicy, EvaluationReport, SuiteReport};
use crate::sees::SEES;
use crate::table::{self, append_aligned, estimate};

const NONE: &str = "n/a";

/// A table for each suite, then one with all suites if there are several.
pub(super) fn text(report: &EvaluationReport) -> String {
    let mut text = String::new();
    for suite in &report.suites {
        append_suite(&mut text, suite);
        text.push('\n');
    }
    if report.suites.len() > 1 {
        text.push_str("share of the certified bound, %\n\n");
        append_aligned(&mut text, &all_suites(report));
        text.push('\n');
    }
    text.push_str(
        "± is the 95 % interval of the mean; p is of paired t-tests, two-sided, corrected (Holm)\n",
    );
    text.push_str("of bound: share of the certified bound, which no schedule passes\n");
    text.push_str(SEES);
    text
}

/// The tables as HTML for notebooks.
pub(super) fn html(report: &EvaluationReport) -> String {
    let tables = html! {
        @for suite in &report.suites {
            p { b { (suite.suite) } ": " (suite.description) }
            (table::html(&suite_rows(suite)))
        }
        @if report.suites.len() > 1 {
            p { "share of the certified bound, %" }
            (table::html(&all_suites(report)))
        }
    };
    tables.into_string()
}

fn append_suite(text: &mut String, suite: &SuiteReport) {
    let SuiteReport { suite: name, description, bound_step_s, left_out, .. } = suite;
    let _ =
        writeln!(text, "{name}: {description}, bounds with slices of {}\n", minutes(*bound_step_s));
    append_aligned(text, &suite_rows(suite));
    for one in left_out {
        let _ = writeln!(text, "{}: cannot play these days: {}", one.policy, one.reason);
    }
}

/// A heading, and a row for each policy.
fn suite_rows(suite: &SuiteReport) -> Vec<Vec<String>> {
    let policies = &suite.policies;
    let first = policies.first().map_or("first", |first| first.share.name.as_str());
    let heading = [
        "policy",
        "sees",
        "of bound, %",
        "lowest, %",
        "profit, $ a day",
        &format!("minus {first}, points"),
        "p",
        "decision median",
        "p99",
    ];
    let mut rows = vec![heading.map(str::to_owned).to_vec()];
    rows.extend(policies.iter().map(|policy| row(policy, suite.one_network)));
    rows
}

fn row(policy: &EvaluatedPolicy, one_network: bool) -> Vec<String> {
    let percent = |share: f64| grouped(100.0 * share, 2);
    let time = |time: Option<u64>| time.map_or(NONE.to_owned(), duration);
    let EvaluatedPolicy { share, p_value_holm, profit_usd, decision_ns } = policy;
    let [minus, p] = match &share.minus_first {
        None => [const { String::new() }; 2],
        Some(test) => {
            let half = test.difference.half_width_95.map(|half| format!(" ± {}", percent(half)));
            [
                signed(100.0 * test.difference.mean, 2) + &half.unwrap_or_default(),
                p_value(*p_value_holm),
            ]
        }
    };
    vec![
        share.name.clone(),
        share.sees.to_string(),
        estimate(&share.bound_share, percent),
        percent(share.lowest_bound_share),
        // Profits of different networks cannot be averaged.
        if one_network { estimate(profit_usd, |value| grouped(value, 0)) } else { NONE.to_owned() },
        minus,
        p,
        time(decision_ns.map(|time| time.median_ns)),
        time(decision_ns.map(|time| time.p99_ns)),
    ]
}

/// One row for each policy, one column for each suite.
fn all_suites(report: &EvaluationReport) -> Vec<Vec<String>> {
    let mut names: Vec<&str> = Vec::new();
    for policy in report.suites.iter().flat_map(|suite| &suite.policies) {
        if !names.contains(&policy.share.name.as_str()) {
            names.push(&policy.share.name);
        }
    }
    let heading = ["policy"].into_iter().chain(report.suites.iter().map(|suite| &*suite.suite));
    let mut rows = vec![heading.map(str::to_owned).collect()];
    rows.extend(names.into_iter().map(|name| {
        let cell = |suite: &SuiteReport| {
            let found = suite.policies.iter().find(|policy| policy.share.name == name);
            found.map_or(NONE.to_owned(), |policy| {
                estimate(&policy.share.bound_share, |share| grouped(100.0 * share, 2))
            })
        };
        [name.to_owned()].into_iter().chain(report.suites.iter().map(cell)).collect()
    }));
    rows
}
