//! The alternatives of a proposal: the advised one has the highest value that a policy compares.

use serde_json::{Value, json};

use crate::api::service;
use crate::running::Running;

/// Decisions of each day that every policy is asked for.
const DECISIONS: usize = 24;

/// Names of all policies that can decide, and of one with roll-outs.
fn policies(service: &Running) -> Vec<String> {
    let listed = service.get("/v1/policies").json;
    let listed = listed["policies"].as_array().expect("a list").clone();
    let names = listed.iter().map(|policy| policy["name"].as_str().expect("a name").to_owned());
    names.chain(["gcaps-x:rollouts=4".to_owned()]).collect()
}

/// Checks that no alternative of a proposal has a higher value than the advised one, and returns
/// how many have a value.
fn check(proposal: &Value) -> usize {
    let alternatives = proposal["alternatives"].as_array().expect("a list");
    let advised = alternatives.iter().find(|one| one["to"] == proposal["to"]);
    let advised = advised.expect("it is among them")["value"].as_f64();
    let values: Vec<f64> = alternatives.iter().filter_map(|one| one["value"].as_f64()).collect();
    assert!(
        values.is_empty() || advised.is_some_and(|most| values.iter().all(|&value| value <= most)),
        "{proposal}"
    );
    values.len()
}

#[test]
fn the_advised_alternative_has_the_highest_value() {
    let (_folder, service) = service();
    let policies = policies(&service);
    for network in ["paper", "new-york-quick"] {
        let made = service.post("/v1/days", &json!({"network": network, "seed": 3}));
        let day = made.made("/v1/days");
        let mut compared = vec![0; policies.len()];
        let mut asked = 0;
        while asked < DECISIONS {
            let state = service.state(&day);
            let aircraft = state["aircraft"].as_array().expect("a list");
            let waits = aircraft.iter().find(|one| one["needs_decision"] == true);
            let Some(waits) = waits else {
                // Each flight goes as expected.
                let next = aircraft.iter().filter_map(|one| one["ready"].as_str()).min();
                let time = next.expect("an aircraft that will be ready");
                for one in aircraft.iter().filter(|one| one["ready"] == time) {
                    let landed =
                        json!({"type": "landed", "aircraft": one["id"], "time": one["arrival"]});
                    assert_eq!(service.event(&day, &landed).status, 201);
                }
                let clock = json!({"type": "clock", "time": time});
                assert_eq!(service.event(&day, &clock).status, 201);
                continue;
            };
            let aircraft = waits["id"].as_str().expect("an id");
            for (policy, compared) in policies.iter().zip(&mut compared) {
                let path = format!("{day}/aircraft/{aircraft}/decision?policy={policy}");
                let answer = service.get(&path);
                // Some weights fit one network only.
                assert!(answer.status == 200 || network != "paper", "{policy}: {answer:?}");
                if answer.status == 200 {
                    *compared += usize::from(check(&answer.json) > 1);
                }
            }
            let decided = json!({"aircraft": aircraft, "policy": "prices"});
            assert_eq!(service.decide(&day, &decided).status, 201);
            asked += 1;
        }
        for (policy, compared) in policies.iter().zip(compared) {
            let is_random = policy == "random";
            let fits = !["gcaps", "mlp"].contains(&policy.as_str()) || network == "paper";
            assert_eq!(compared > 0, fits && !is_random, "{network} {policy}: {compared}");
        }
    }
}
