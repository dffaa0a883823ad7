//! Whole days over HTTP: the operator's reports reproduce the simulated day, to the cent.

use std::sync::Arc;

use serde_json::{Value, json};
use vertifleet_core::{DaySeed, Network, Scenario, Stop};
use vertifleet_policy::play;
use vertifleet_serve::{Operation, OperationReport, operate};
use vertifleet_sim::{DayTotals, Simulation};
use vertifleet_study::{PolicySpec, ResolveFor};

use crate::api::service;
use crate::running::Running;

pub(crate) fn day(network: &str, seed: u64) -> Arc<Scenario> {
    let network = Network::shipped(network).expect("a shipped network");
    Arc::new(network.draw(DaySeed::validation(seed).expect("a seed of validation")))
}

pub(crate) fn simulated(day: &Arc<Scenario>, policy: &str) -> DayTotals {
    let spec = PolicySpec::parse(policy).expect("a policy");
    let resolved = spec.resolve(None, ResolveFor::Day(day), day.seed).expect("a policy");
    let mut simulation = Simulation::new(Arc::clone(day));
    play(&mut simulation, resolved.build().as_mut(), |_| ()).expect("a day");
    simulation.totals()
}

pub(crate) fn operated(service: &Running, day: &Arc<Scenario>, policy: &str) -> OperationReport {
    let report = operate(&operation(service, day, policy), &Stop::default(), |_, _| ());
    report.expect("the service answers").expect("it is not stopped")
}

fn operation(service: &Running, day: &Arc<Scenario>, policy: &str) -> Operation {
    Operation::new(&service.url, Arc::clone(day), policy)
}

#[test]
fn a_live_day_is_the_simulated_day_to_the_cent() {
    let (_folder, service) = service();
    let policies = |network| match network {
        // Its roll-outs depend on the known distribution of delays.
        "disrupted" => ["gcaps-x", "rolling"],
        _ => ["gcaps-x", "greedy"],
    };
    for network in ["paper", "disrupted", "new-york", "paper-quick", "new-york-quick"] {
        for policy in policies(network) {
            let day = day(network, 2001);
            let report = operated(&service, &day, policy);
            assert_eq!(report.totals, simulated(&day, policy), "{network} {policy}");
            assert_eq!(report.sent_again, 0);
        }
    }
}

#[test]
fn a_list_of_days_has_the_progress_of_each() {
    let (_folder, service) = service();
    let over = operated(&service, &day("disrupted", 2004), "greedy");
    let begun = service.new_day("greedy");
    assert_eq!(service.decide(&begun, &json!({"aircraft": "A01"})).status, 201);
    let archived = service.new_day("greedy");
    assert_eq!(service.send("POST", &format!("{archived}/archive"), &[], b"").status, 204);
    let days = service.get("/v1/days?progress=true").json;
    let progress = |day: usize| &days["days"][day]["progress"];
    assert_eq!(progress(0)["is_over"], true);
    assert_eq!(progress(0)["profit_usd"].as_f64(), Some(over.totals.profit_usd));
    assert_eq!((&progress(1)["is_over"], &progress(1)["waiting"]), (&json!(false), &json!(39)));
    assert_eq!(progress(1)["now"], "06:00:00");
    assert_eq!(days["days"][2].get("progress"), None, "an archived day");
    let plain = service.get("/v1/days").json;
    assert_eq!(plain["days"][0].get("progress"), None, "it was not asked for");
}

#[test]
fn a_day_that_others_decide_is_the_simulated_day_to_the_cent() {
    let (_folder, service) = service();
    let day = day("disrupted", 2002);
    let report = operated_by_hand(&service, &day, |day, state, _| decide_all(&service, day, state));
    assert_eq!(report.totals, simulated(&day, "greedy"));
}

#[test]
fn people_may_decide_in_any_order_and_cancel_decisions() {
    let (_folder, service) = service();
    // Few stands, so that the order of departures matters.
    let text =
        include_str!("../../../../networks/paper.toml").replacen("stands = 6", "stands = 5", 5);
    let network = Network::from_toml(&text, "fewer stands").expect("a network");
    let day = Arc::new(network.draw(DaySeed::validation(2003).expect("a seed")));
    let report = operated_by_hand(&service, &day, |day, state, look| {
        decide_backwards(&service, day, state, look);
    });
    assert!(report.totals.flights > 100, "{report:?}");
    let state = service.get(&format!("/v1/days/{}/state", report.day)).json;
    assert_eq!(state["notices"], json!([]), "every flight departed and landed as it should");
}

/// Operates a day on which people decide. Until the day is over, `decide` is called with the path
/// of the day, its state and the number of the call.
fn operated_by_hand(
    service: &Running,
    day: &Arc<Scenario>,
    decide: impl Fn(&str, &Value, u32),
) -> OperationReport {
    let operation = Operation { by_hand: true, ..operation(service, day, "greedy") };
    let report = std::thread::scope(|scope| {
        let operator = scope.spawn(|| operate(&operation, &Stop::default(), |_, _| ()));
        for look in 1.. {
            if operator.is_finished() {
                break;
            }
            let days = service.get("/v1/days").json;
            let Some(id) = days["days"][0]["id"].as_str() else { continue };
            let day = format!("/v1/days/{id}");
            let state = service.state(&day);
            // Before the operator has reported which aircraft wait in the morning, the day contains
            // only the expected ones.
            if state["seq"] != 0 {
                decide(&day, &state, look);
            }
        }
        operator.join().expect("no panic")
    });
    report.expect("the service answers").expect("it is not stopped")
}

/// The aircraft that wait for a decision.
fn waiting(state: &Value) -> impl DoubleEndedIterator<Item = &Value> {
    let aircraft = state["aircraft"].as_array().expect("a list");
    aircraft.iter().filter(|one| one["needs_decision"] == true)
}

/// Decides for all waiting aircraft, the last first. Sometimes it cancels a decision and lets the
/// aircraft hold.
fn decide_backwards(service: &Running, day: &str, state: &Value, look: u32) {
    for waiting in waiting(state).rev() {
        let aircraft = &waiting["id"];
        assert_eq!(service.decide(day, &json!({ "aircraft": aircraft })).status, 201);
        if look.is_multiple_of(5) {
            let undone = json!({ "type": "undone", "aircraft": aircraft });
            // The operator may have reported the departure before.
            if service.event(day, &undone).status == 201 {
                let place = &waiting["place"];
                service.decide(day, &json!({"aircraft": aircraft, "to": place, "reason": "wait"}));
            }
        }
    }
}

/// Decides for every ready aircraft, as the policy of the day would.
fn decide_all(service: &Running, day: &str, state: &Value) {
    for waiting in waiting(state) {
        let taken = service.decide(day, &json!({ "aircraft": waiting["id"] }));
        assert_eq!(taken.status, 201, "{taken:?}");
    }
}

#[test]
fn at_a_speed_each_event_is_reported_at_its_time() {
    let (_folder, service) = service();
    let operation = operation(&service, &day("paper", 2), "greedy");
    let operation = Operation { speed: Some(20_000.0), ..operation };
    let report = operate(&operation, &Stop::default(), |_, _| ());
    let report = report.expect("the service answers").expect("it was not stopped");
    let page = service.get(&format!("/v1/days/{}/events?limit=10000", report.day)).json;
    let all = page["events"].as_array().expect("a list");
    let reports: Vec<_> = all.iter().filter(|one| one["event"]["type"] != "decided").collect();
    let of_other_times = |pair: &&[&Value]| pair[0]["event"]["time"] != pair[1]["event"]["time"];
    let pairs: Vec<_> = reports.windows(2).filter(of_other_times).collect();
    // Events of one request have one time of storage.
    let together = pairs.iter().filter(|pair| pair[0]["at_ms"] == pair[1]["at_ms"]).count();
    assert!(pairs.len() > 100, "{} reports", pairs.len());
    assert!(together < pairs.len() / 10, "{together} of {} came together", pairs.len());
}
