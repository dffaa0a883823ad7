//! Suites are what was frozen, evaluations count as comparisons do, and a result that claims too
//! much is found out.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use vertifleet_core::{Coded, Stop};
use vertifleet_optimize::{Step, upper_bound};
use vertifleet_study::competitor::Selection;
use vertifleet_study::evaluation::{
    Evaluation, EvaluationRecords, EvaluationReport, ResultFile, verify,
};
use vertifleet_study::{SUITES, Suite, Unwatched};

fn evaluated(suite: &str, policies: &[&str]) -> EvaluationRecords {
    let policies: Vec<String> = policies.iter().map(|&name| name.to_owned()).collect();
    let selection = Selection { policies: &policies, models: &[], seed: 1 };
    let (suite, stop) = (Suite::find(suite).expect("a suite"), Stop::default());
    let evaluation = Evaluation::new(suite, &selection, &stop).expect("days and policies");
    evaluation.run("a test".to_owned(), &stop, &Unwatched).expect("every day is played")
}

static HONEST: LazyLock<ResultFile> = LazyLock::new(|| {
    let records = evaluated("paper-100", &["greedy"]);
    let about = BTreeMap::from([("training".to_owned(), "none".to_owned())]);
    records.results(&about, &BTreeMap::new()).expect("runs without names").remove(0)
});

#[test]
fn every_suite_is_what_was_frozen() {
    for suite in SUITES {
        let days = suite.draw(&Stop::default()).expect("the frozen days");
        assert_eq!(days.len(), suite.days, "{}", suite.name);
        assert_eq!(Suite::find(&suite.name).expect("a suite"), suite);
    }
    let unknown = Suite::find("paper-10").expect_err("no suite");
    assert_eq!(
        (unknown.code().to_string(), unknown.hint()),
        ("V411".to_owned(), Some("did you mean paper-100?"))
    );
}

/// One day of some suites; the rest is as `make suites` left it.
#[test]
fn the_bounds_of_a_suite_are_those_that_are_proven_anew() {
    for (name, at) in [("paper-100", 41), ("random-places-100", 7), ("paper-quick-20", 3)] {
        let suite = Suite::find(name).expect("a suite");
        let day = suite.draw(&Stop::default()).expect("the frozen days").remove(at);
        let step = Step::from_minutes(suite.step_minutes).expect("a step");
        let proven_usd = upper_bound(&day.scenario, step).expect("a bound").upper_bound_usd();
        let above_usd = day.upper_bound_usd.expect("it is frozen") - proven_usd;
        assert!((0.0..=1e-4 + 1e-9).contains(&above_usd), "{name}: {above_usd}");
    }
}

#[test]
fn random_networks_are_those_of_the_suite_with_bounds_that_are_proven() {
    let asked = Suite::find("random:2").expect("two networks");
    let frozen = Suite::find("random-50").expect("a suite");
    let (asked, frozen) = (asked.draw_with_bounds(&Stop::default()), frozen.draw(&Stop::default()));
    let (asked, frozen) = (asked.expect("two days"), frozen.expect("the frozen days"));
    assert_eq!(asked.len(), 2);
    for (asked, frozen) in asked.iter().zip(&frozen) {
        assert_eq!((&asked.scenario, &asked.hash), (&frozen.scenario, &frozen.hash));
        let (asked_usd, frozen_usd) = (asked.upper_bound_usd, frozen.upper_bound_usd);
        let looser = asked_usd.expect("it is proven") / frozen_usd.expect("it is frozen");
        assert!((1.0..1.01).contains(&looser), "slices of three minutes in place of one: {looser}");
    }
    let records = evaluated("random:2", &["greedy", "random"]);
    let results = records.results(&BTreeMap::new(), &BTreeMap::new());
    let result = results.expect("runs without names").remove(0);
    let verification = verify(&result, &Stop::default()).expect("networks by number");
    assert!(verification.valid, "{verification}");
    let many = ResultFile { suite: "random:1000000".to_owned(), ..result };
    let refused = verify(&many, &Stop::default()).expect("networks by number");
    assert_eq!(refused.findings, ["days: 2 in the file, 1000000 in the suite"]);
    assert!(!refused.valid && refused.bound_share.is_none());
    for name in ["random:0", "random:", "random:x", "random:1000001"] {
        assert_eq!(Suite::find(name).expect_err("no suite").code().to_string(), "V411", "{name}");
    }
}

#[test]
fn an_honest_result_is_verified() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(ResultFile::file_name("paper-100", "greedy"));
    let result = HONEST.clone();
    result.write(&path).expect("a file");
    let read = ResultFile::read(&path).expect("the same file");
    assert_eq!(read, result);
    let verification = verify(&read, &Stop::default()).expect("a known suite");
    assert!(verification.valid, "{verification}");
    assert_eq!(verification.bound_share, Some(result.bound_share));
    assert!(
        verification.to_string().starts_with("verified: greedy on paper-100, 100 days: 91.26 ")
    );
}

#[test]
fn whatever_is_claimed_too_much_is_found() {
    type Change = fn(&mut ResultFile);
    let honest = HONEST.clone();
    let changes: [(&str, Change); 10] = [
        ("a profit", |result| result.days[3].profit_usd += 1.0),
        ("a bound", |result| result.days[3].upper_bound_usd -= 1.0),
        ("a mean", |result| result.bound_share.mean += 1e-6),
        ("an interval", |result| result.profit_usd.half_width_95 = None),
        ("the lowest share", |result| result.lowest_bound_share += 1e-6),
        ("a missing day", |result| drop(result.days.remove(50))),
        ("a day twice", |result| result.days[9] = result.days[8].clone()),
        ("a choice less", |result| {
            let choices = &mut result.days[0].choices;
            choices.truncate(choices.rfind(' ').expect("many choices"));
        }),
        ("a choice more", |result| result.days[0].choices.push_str(" 0")),
        ("no such vertiport", |result| result.days[0].choices = "8".to_owned()),
    ];
    for (what, change) in changes {
        let mut result = honest.clone();
        change(&mut result);
        let verification = verify(&result, &Stop::default()).expect("a known suite");
        assert!(!verification.valid && !verification.findings.is_empty(), "{what}");
    }
    let mut other = honest;
    other.suite = "paper-1000".to_owned();
    assert_eq!(verify(&other, &Stop::default()).expect_err("no suite").code().to_string(), "V411");
}

#[test]
fn other_files_are_no_results() {
    for text in [
        "",
        "[]",
        "{\"format\": \"vertifleet-scenario/1\"}",
        "{\"format\": \"vertifleet-result/1\"}",
    ] {
        let error = ResultFile::from_json(text.as_bytes(), "here").expect_err("no result");
        assert_eq!(error.code().to_string(), "V413", "{text}");
    }
}

#[test]
fn policies_that_cannot_play_a_suite_are_left_out() {
    let records = evaluated("random-50", &["greedy", "gcaps", "random"]);
    let report = EvaluationReport::of(&[records]).expect("records of one run");
    let [suite] = &report.suites[..] else { panic!("one suite") };
    let names: Vec<&str> = suite.policies.iter().map(|policy| &*policy.share.name).collect();
    assert_eq!(names, ["greedy", "random"]);
    assert_eq!(suite.left_out[0].policy, "gcaps");
    assert!(suite.policies[1].p_value_holm.is_some_and(|p| p < 0.001));
    assert!(report.suites[0].left_out.iter().any(|one| one.policy == "gcaps"));

    let policies = ["gcaps".to_owned()];
    let selection = Selection { policies: &policies, models: &[], seed: 1 };
    let suite = Suite::find("random-50").expect("a suite");
    let error =
        Evaluation::new(suite, &selection, &Stop::default()).err().expect("no policy can play");
    assert_eq!(error.code().to_string(), "V307");
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(24))]

    /// Random damage to a good file leads to an error or to a verdict, never to a panic; and a
    /// verdict of validity only where no claim has changed.
    #[test]
    fn a_damaged_result_never_panics(at in 0.0..1.0_f64, byte: u8, cut: bool) {
        let good = serde_json::to_vec_pretty(&*HONEST).expect("plain data");
        let mut bytes = good.clone();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 <= at < 1")]
        let at = (at * bytes.len() as f64) as usize;
        if cut {
            bytes.truncate(at);
        } else {
            bytes[at] = byte;
        }
        if let Ok(result) = ResultFile::from_json(&bytes, "damaged") {
            let verdict = verify(&result, &Stop::default());
            let is_valid = verdict.is_ok_and(|verification| verification.valid);
            let same_days = result.days.iter().zip(&HONEST.days).all(|(one, other)| {
                (&one.day, &one.choices) == (&other.day, &other.choices)
            });
            proptest::prop_assert!(!is_valid || same_days);
        }
    }
}

#[test]
fn values_that_the_schema_refuses_are_refused() {
    type Change = fn(&mut serde_json::Value);
    let changes: [(&str, Change); 8] = [
        ("a member less", |result| {
            result["policy"].as_object_mut().expect("an object").remove("weights_sha256");
        }),
        ("an interval less", |result| {
            result["profit_usd"].as_object_mut().expect("an object").remove("half_width_95");
        }),
        ("a member more", |result| {
            result["policy"]["decision_ns"] =
                serde_json::json!({"median_ns": 1, "p99_ns": 2, "mean_ns": 1});
        }),
        ("no hash", |result| result["policy"]["weights_sha256"] = "abc".into()),
        ("a hash in capitals", |result| {
            let hash = result["days"][0]["hash"].as_str().expect("a text").to_uppercase();
            result["days"][0]["hash"] = ("A".to_owned() + &hash[1..]).into();
        }),
        ("a median above the 99th percentile", |result| {
            result["policy"]["decision_ns"] = serde_json::json!({"median_ns": 3, "p99_ns": 2});
        }),
        ("a negative width", |result| result["bound_share"]["half_width_95"] = (-0.1).into()),
        ("tabs between choices", |result| {
            let choices = result["days"][0]["choices"].as_str().expect("a text").replace(' ', "\t");
            result["days"][0]["choices"] = choices.into();
        }),
    ];
    let honest = serde_json::to_value(&*HONEST).expect("plain data");
    for (what, change) in changes {
        let mut result = honest.clone();
        change(&mut result);
        let error = ResultFile::from_json(result.to_string().as_bytes(), "here").expect_err(what);
        assert_eq!(error.code().to_string(), "V413", "{what}");
    }
}
