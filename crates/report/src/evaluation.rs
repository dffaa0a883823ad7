//! The report of an evaluation.

use vertifleet_picture::numbers::{duration, grouped, minutes, p_value};
use vertifleet_study::evaluation::{EvaluatedPolicy, EvaluationReport, SuiteReport};

use crate::comparison::{NONE, SEES};
use crate::report::{Report, Section, Table, difference};

/// The report of an evaluation: a table for each suite, then one with all suites if there are
/// several.
pub fn evaluation(report: &EvaluationReport) -> Report<'static> {
    let mut sections: Vec<Section> = report.suites.iter().map(of_suite).collect();
    if report.suites.len() > 1 {
        sections.push(Section::of_table("share of the certified bound, %", all_suites(report)));
    }
    if let Some(last) = sections.last_mut() {
        last.notes.extend([
            "± is the 95 % interval of the mean; p is of paired t-tests, two-sided, corrected (Holm)".to_owned(),
            "of bound: share of the certified bound, which no schedule passes".to_owned(),
            SEES.to_owned(),
        ]);
    }
    Report {
        title: "Vertifleet evaluation".to_owned(),
        subject: "evaluation of policies",
        sections,
        ..Report::default()
    }
}

fn of_suite(suite: &SuiteReport) -> Section {
    let SuiteReport { suite: name, description, bound_step_s, left_out, policies, .. } = suite;
    let title = format!("{name}: {description}, bounds with slices of {}", minutes(*bound_step_s));
    let first = policies.first().map_or("first", |first| first.share.name.as_str());
    let columns = [
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
    let rows = policies.iter().map(|policy| row(policy, suite.one_network));
    let cannot = left_out
        .iter()
        .map(|one| format!("{}: cannot play these days: {}", one.policy, one.reason));
    Section {
        notes: cannot.collect(),
        ..Section::of_table(title, Table::new(columns).with_rows(rows))
    }
}

fn row(policy: &EvaluatedPolicy, one_network: bool) -> Vec<String> {
    let percent = |share: f64| grouped(100.0 * share, 2);
    let time = |time: Option<u64>| time.map_or(NONE.to_owned(), duration);
    let EvaluatedPolicy { share, p_value_holm, profit_usd, decision_ns } = policy;
    let [minus, p] = match &share.minus_first {
        None => [const { String::new() }; 2],
        Some(test) => [difference(&test.difference, 100.0, 2), p_value(*p_value_holm)],
    };
    vec![
        share.name.clone(),
        share.sees.to_string(),
        share.bound_share.written(percent),
        percent(share.lowest_bound_share),
        // Profits of different networks cannot be averaged.
        if one_network { profit_usd.written(|value| grouped(value, 0)) } else { NONE.to_owned() },
        minus,
        p,
        time(decision_ns.map(|time| time.median_ns)),
        time(decision_ns.map(|time| time.p99_ns)),
    ]
}

/// One row for each policy, one column for each suite.
fn all_suites(report: &EvaluationReport) -> Table {
    let mut names: Vec<&str> = Vec::new();
    for policy in report.suites.iter().flat_map(|suite| &suite.policies) {
        if !names.contains(&policy.share.name.as_str()) {
            names.push(&policy.share.name);
        }
    }
    let columns = ["policy"].into_iter().chain(report.suites.iter().map(|suite| &*suite.suite));
    Table::new(columns).with_rows(names.into_iter().map(|name| {
        let cell = |suite: &SuiteReport| {
            let found = suite.policies.iter().find(|policy| policy.share.name == name);
            found.map_or(NONE.to_owned(), |policy| {
                policy.share.bound_share.written(|share| grouped(100.0 * share, 2))
            })
        };
        [name.to_owned()].into_iter().chain(report.suites.iter().map(cell)).collect()
    }))
}
