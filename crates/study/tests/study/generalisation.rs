//! Tests the numbers, the table and the folder of a study of many networks.

use crate::made_up;
use std::fs;

use vertifleet_core::Coded;
use vertifleet_study::generalisation::{
    self, GeneralisationRecords, GeneralisationReport, NetworkRecord,
};
use vertifleet_study::report::{self, Records as _};

/// Random, greedy and gcaps, and a reference that knows the days, on networks of all sizes. Greedy is named first.
fn study(networks: usize) -> GeneralisationRecords {
    let mut policies = made_up::study(networks).policies;
    policies.swap(0, 1);
    let mut plan = policies[4].clone();
    "plan".clone_into(&mut plan.name);
    plan.decision_ns = None;
    plan.sees = vertifleet_study::Sees::WholeDay;
    policies.push(plan);
    for policy in &mut policies {
        for (number, day) in policy.days.iter_mut().enumerate() {
            day.upper_bound_usd = Some(46_000.0 + 100.0 * (number * 7 % 11) as f64);
        }
    }
    let network = |number: usize| NetworkRecord {
        name: format!("random:{number}"),
        vertiports: 5 + number * 5 % 26,
        aircraft: 10 + number * 37 % 141,
    };
    GeneralisationRecords {
        bound_step_s: 180,
        command: "vertifleet generalise --policies greedy,random".to_owned(),
        networks: (0..networks).map(network).collect(),
        policies,
    }
}

#[test]
fn the_table_of_random_networks() {
    insta::assert_snapshot!(study(50).text().expect("a sound study"));
}

#[test]
fn every_policy_is_measured_against_the_first_by_its_shares() {
    let study = study(8);
    let summary = GeneralisationReport::of(&study).expect("a sound study");
    assert!(summary.policies[0].minus_first.is_none());
    let share = |policy: usize, day: usize| study.policies[policy].days[day].bound_share();
    for (position, policy) in summary.policies.iter().enumerate().skip(1) {
        let test = policy.minus_first.expect("a test");
        let above = (0..8).filter(|&day| share(position, day) > share(0, day)).count();
        assert_eq!(test.first_larger, above);
        let shares = (0..8).map(|day| share(position, day).expect("a bound"));
        assert_eq!(policy.lowest_bound_share, shares.fold(1.0, f64::min));
        assert_eq!(policy.knows_the_day, policy.name == "plan");
    }
    let networks = summary.networks.iter().enumerate();
    for (day, network) in networks {
        let shares: Vec<f64> = network.results.iter().map(|result| result.bound_share).collect();
        let records: Vec<f64> = (0..6).filter_map(|policy| share(policy, day)).collect();
        assert_eq!(shares, records);
    }
}

#[test]
fn a_study_of_nothing_or_of_other_days_is_refused() {
    let code = |study: &GeneralisationRecords| {
        GeneralisationReport::of(study).expect_err("no study").code().to_string()
    };
    let whole = study(3);
    assert_eq!(code(&GeneralisationRecords { policies: Vec::new(), ..whole.clone() }), "V402");
    assert_eq!(code(&GeneralisationRecords { networks: Vec::new(), ..whole.clone() }), "V402");
    let mut other = whole;
    other.policies[1].days.swap(0, 1);
    assert_eq!(code(&other), "V403");
}

#[test]
fn the_folder_holds_all_that_the_page_links_to_and_every_network() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let study = study(50);
    let page = report::write(&study, &folder.path().join("new"), false).expect("a report").page;
    let text = fs::read_to_string(&page).expect("the page");
    let links: Vec<&str> =
        text.split("href=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!(links.contains(&"networks.csv") && links.contains(&"figure-share-by-size.png"));
    for link in links {
        assert!(page.with_file_name(link).exists(), "{link}");
    }
    assert!(text.contains("random:49") && text.contains("knows the day"));
    assert!(!text.contains("src=") && !text.contains("NaN"), "whole and with numbers only");
    let csv = fs::read_to_string(page.with_file_name("networks.csv")).expect("the rows");
    assert_eq!(csv.lines().count(), 1 + 50 * 6);
    let summary = fs::read_to_string(page.with_file_name("summary.json")).expect("the numbers");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    assert_eq!(summary["format"], generalisation::FORMAT);
    assert_eq!(summary["networks"][49]["network"], "random:49");
}

#[test]
fn one_network_and_one_policy_make_a_report_too() {
    let mut study = study(1);
    study.policies.truncate(1);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let page = report::write(&study, folder.path(), false).expect("a report").page;
    assert!(fs::read_to_string(page).expect("the page").contains("1 random network"));
    assert!(study.text().expect("a sound study").contains("greedy"));
}
