//! Studies: many days in the background, with the numbers of `vertifleet compare`.

use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};
use vertifleet_core::{Network, Purpose, Stop};
use vertifleet_serve::Role;
use vertifleet_study::comparison::{Comparison, DrawnDays};
use vertifleet_study::competitor::Selection;
use vertifleet_study::{ComparisonReport, Unwatched};

use crate::api::service;
use crate::running::{Running, bearers, folder};

/// Makes a study, and returns its path.
fn made(service: &Running, body: &Value) -> String {
    service.post("/v1/studies", body).made("/v1/studies")
}

/// Checks that the content security policy of a page admits its own style sheet and script, and
/// nothing that is not named.
fn assert_runs_under_its_policy(service: &Running, page: &str) {
    let mut answer = ureq::get(format!("{}{page}", service.url)).call().expect("the page");
    let policy = answer.headers()["content-security-policy"].to_str().expect("text").to_owned();
    assert!(!policy.contains("unsafe"), "{policy}");
    let page = answer.body_mut().read_to_string().expect("text");
    for (begin, end) in [("<style>", "</style>"), ("<script>", "</script>")] {
        let inside: Vec<&str> =
            page.split(begin).skip(1).filter_map(|rest| rest.split(end).next()).collect();
        assert!(!inside.is_empty(), "a page with a replay has {begin}");
        for text in inside {
            let hash = BASE64_STANDARD.encode(Sha256::digest(text));
            assert!(policy.contains(&format!("'sha256-{hash}'")), "{policy} forbids {text}");
        }
    }
}

/// Waits until a study is in a state.
fn until(service: &Running, study: &str, state: &str) -> Value {
    when(service, study, |found| found["state"] == state)
}

/// Waits until a condition holds for a study.
fn when(service: &Running, study: &str, is_so: impl Fn(&Value) -> bool) -> Value {
    let begun = Instant::now();
    loop {
        let found = service.get(study).json;
        if is_so(&found) {
            return found;
        }
        assert!(begun.elapsed() < Duration::from_mins(2), "it never is: {found}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn a_study_has_the_numbers_of_compare() {
    let (_folder, service) = service();
    let policies = ["random", "greedy"].map(str::to_owned);
    let body = json!({"network": "paper", "policies": policies, "days": 4, "seed": 7, "split": "validation"});
    let study = made(&service, &body);
    let found = until(&service, &study, "finished");
    let command = "vertifleet compare --network paper --policies random,greedy --days 4 --seed 7 --split validation";
    assert_eq!(found["command"], command);
    assert_eq!((&found["network_origin"], &found["warnings"]), (&json!("shipped"), &json!([])));

    let network = Network::shipped("paper").expect("it is shipped");
    let selection = Selection { policies: &policies, models: &[], seed: 7 };
    let days = DrawnDays { purpose: Purpose::Validation, first: 7, days: 4 };
    let never = Stop::default();
    let comparison = Comparison::new(&network, &selection, days, None, &never).expect("days");
    let records = comparison.run(String::new(), &never, &Unwatched).expect("a result");
    let report = ComparisonReport::of(&records).expect("a result");
    let result = &found["result"];
    assert_eq!(result["first_seed"].as_u64(), report.day_seeds.map(|(first, _)| first));
    for (policy, name) in result["policies"].as_array().expect("a list").iter().zip(&policies) {
        assert_eq!(policy["name"], *name, "they come as they were asked for");
        let same = report.policies.iter().find(|one| one.name == *name).expect("it played");
        assert_eq!(number(&policy["profit_usd"]["mean"]), same.profit_usd.mean);
        assert_eq!(policy["profit_usd"]["half_width_95"].as_f64(), same.profit_usd.half_width_95);
        assert_eq!(number(&policy["passengers"]), same.passengers);
        assert_eq!(number(&policy["spilled_passengers"]), same.spilled_passengers);
        assert_eq!(policy["daily_profit_usd"], json!(same.daily_profit_usd));
    }
    assert_eq!(result["policies"][0]["minus_first"], Value::Null);
    let minus = &result["policies"][1]["minus_first"];
    let test = &report.comparisons[0].profit_usd;
    assert_eq!(number(&minus["profit_usd"]["mean"]), test.difference.mean);
    assert_eq!(minus["p_value"].as_f64(), test.p_value);
    assert_eq!((&minus["days_ahead"], &minus["days_behind"]), (&json!(4), &json!(0)));

    assert_runs_under_its_policy(&service, &format!("{study}/report"));
    let page = service.get(&format!("{study}/report"));
    let page = page.json.as_str().expect("a page").to_owned();
    assert!(page.starts_with("<!DOCTYPE html>") && page.contains("greedy earns"), "{page}");
    assert!(!page.contains("summary.json"), "nothing stands next to it");
    assert!(page.contains("<iframe class=\"replay\"") && !page.contains("href=\"replay.html\""));
    let replay = service.get(&format!("{study}/replay")).json;
    let plays = replay["days"][0]["plays"].as_array().expect("what each policy did");
    let names: Vec<&Value> = plays.iter().map(|play| &play["policy"]).collect();
    assert_eq!(
        names,
        result["policies"]
            .as_array()
            .expect("a list")
            .iter()
            .map(|one| &one["name"])
            .collect::<Vec<_>>()
    );
    assert!(plays[0]["trace"].as_str().is_some_and(|trace| trace.lines().count() > 100));
}

#[test]
fn a_study_has_bounds_and_follows_its_progress() {
    let (_folder, service) = service();
    let town = include_str!("../../../../networks/paper.toml");
    let town =
        town.replace("name = \"paper\"", "name = \"town\"").replace("count = 40", "count = 4");
    let body = json!({"toml": town, "policies": ["greedy", "prices"], "days": 3, "bounds": true});
    let study = made(&service, &body);
    let found = until(&service, &study, "finished");
    assert!(number(&found["took_s"]) > 0.0, "{found}");
    assert_eq!(found["network_origin"], "own");
    let result = &found["result"];
    let bound = number(&result["upper_bound_usd"]["mean"]);
    for policy in result["policies"].as_array().expect("a list") {
        let share = number(&policy["bound_share"]["mean"]);
        assert!(share > 0.3 && share <= 1.0, "{policy}");
        assert!(number(&policy["profit_usd"]["mean"]) < bound, "{policy}");
    }
    let listed = service.get("/v1/studies").json;
    assert_eq!(listed["studies"][0]["id"], found["id"]);
    assert_eq!(listed["studies"][0].get("result"), None, "a list has no results");
}

#[test]
fn studies_wait_for_each_other_and_can_be_ended() {
    let (_folder, service) = service();
    let long = json!({"network": "paper", "policies": ["greedy", "rolling"], "days": 100});
    let first = made(&service, &long);
    let playing = until(&service, &first, "playing");
    assert!(playing["progress"]["share"].is_number(), "{playing}");
    // The result of the first policy is there while the second one plays.
    let playing = when(&service, &first, |found| found["progress"]["doing"] == "rolling");
    let played = &playing["progress"]["played"][0];
    assert_eq!(played["name"], "greedy");
    let (profit_usd, width_usd) =
        (&played["profit_usd"]["mean"], &played["profit_usd"]["half_width_95"]);
    assert!(number(profit_usd) > 34_000.0 && number(width_usd) < 200.0, "{played}");
    assert_eq!(service.get(&format!("{first}/report")).status, 404, "it has no result yet");
    let short = json!({"network": "paper", "policies": ["greedy"], "days": 1});
    let second = made(&service, &short);
    assert_eq!(service.get(&second).json["state"], "waiting");
    // Decisions are taken in the meantime.
    let day = service.new_day("greedy");
    assert_eq!(service.decide(&day, &json!({"aircraft": "A01"})).status, 201);
    assert_eq!(service.get(&first).json["state"], "playing", "the decision did not wait for it");
    for _ in 1..8 {
        made(&service, &short);
    }
    let refused = service.post("/v1/studies", &short);
    assert_eq!(refused.problem(), (409, "V612"), "{refused:?}");
    assert_eq!(service.send("DELETE", &first, &[], b"").status, 204);
    assert_eq!(service.get(&first).status, 404);
    let single = until(&service, &second, "finished");
    assert_eq!(single["result"]["policies"][0]["profit_usd"]["half_width_95"], Value::Null);
    assert_eq!(service.get("/v1/studies").json["studies"].as_array().map(Vec::len), Some(8));
}

#[test]
fn a_study_is_made_once_for_each_key() {
    let (_folder, service) = service();
    let body =
        |days: u32| json!({"network": "paper", "policies": ["greedy"], "days": days}).to_string();
    let asked = |days: u32, key: &str| {
        service.send("POST", "/v1/studies", &[("idempotency-key", key)], body(days).as_bytes())
    };
    let (first, again, other) = (asked(1, "one"), asked(1, "one"), asked(1, "two"));
    assert_eq!((first.status, again.status), (201, 201), "{again:?}");
    assert_eq!(first.json["id"], again.json["id"]);
    assert_ne!(first.json["id"], other.json["id"]);
    assert_eq!(asked(2, "one").json["code"], "V609");
}

#[test]
fn a_study_that_cannot_be_played_is_refused_at_once() {
    let (_folder, service) = service();
    for (body, status, code) in [
        (json!({"network": "paper", "policies": ["greedy"], "days": 0}), 400, "V402"),
        (json!({"network": "paper", "policies": [], "days": 1}), 400, "V402"),
        (json!({"network": "paper", "policies": ["greedy", "greedy"], "days": 1}), 400, "V404"),
        (json!({"network": "paper", "policies": ["ours"], "days": 1}), 404, "V602"),
        (json!({"network": "paper", "policies": ["replay:/etc/passwd"], "days": 1}), 400, "V307"),
        (json!({"network": "atlantis", "policies": ["greedy"], "days": 1}), 404, "V602"),
        (json!({"policies": ["greedy"], "days": 1}), 400, "V601"),
        (json!({"toml": "name = 1", "policies": ["greedy"], "days": 1}), 400, "V107"),
        (json!({"network": "new-york", "policies": ["mlp"], "days": 1}), 400, "V307"),
        (json!({"network": "paper", "policies": ["greedy"], "days": 1_001}), 409, "V612"),
        (json!({"network": "large", "policies": ["greedy"], "days": 1_000}), 409, "V612"),
        (json!({"network": "paper", "policies": vec!["greedy"; 11], "days": 1}), 409, "V612"),
        (json!({"network": "paper", "policies": ["greedy"], "days": 1, "sky": 1}), 400, "V601"),
        (
            json!({"network": "paper", "policies": ["greedy"], "days": 1, "seed": 1_u64 << 41}),
            400,
            "V118",
        ),
    ] {
        let refused = service.post("/v1/studies", &body);
        assert_eq!(refused.problem(), (status, code), "{refused:?}");
    }
    assert_eq!(service.get("/v1/studies").json["studies"], json!([]));
    assert_eq!(service.send("DELETE", "/v1/studies/none", &[], b"").status, 404);
}

#[test]
fn dispatchers_make_and_end_studies_and_readers_read_them() {
    let (folder, location) = folder();
    let token = bearers(&location);
    let (reads, dispatches) = (token("reads", Role::Read), token("dispatches", Role::Dispatch));
    let service = Running::start(folder.path());
    let body = json!({"network": "paper", "policies": ["greedy"], "days": 1}).to_string();
    let as_ = |token: &str, method: &str, path: &str| {
        service.send(method, path, &[("authorization", token)], body.as_bytes())
    };
    assert_eq!(as_(&reads, "POST", "/v1/studies").status, 403);
    let made = as_(&dispatches, "POST", "/v1/studies");
    let study = made.made("/v1/studies");
    assert_eq!(as_(&reads, "GET", &study).status, 200);
    assert_eq!(as_(&reads, "DELETE", &study).status, 403);
    assert_eq!(as_(&dispatches, "DELETE", &study).status, 204);
}
