//! Whole days through HTTP: what the operator reports makes the simulated day, to the cent.

use std::sync::Arc;

use serde_json::json;
use vertifleet_core::{DaySeed, Network, Scenario, Stop};
use vertifleet_policy::play;
use vertifleet_serve::{Operation, OperationReport, operate};
use vertifleet_sim::{DayTotals, Simulation};
use vertifleet_study::{PolicySpec, ResolveFor};

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
    report.expect("the service answers").expect("nobody stops it")
}

fn operation(service: &Running, day: &Arc<Scenario>, policy: &str) -> Operation {
    let (url, policy) = (service.url.clone(), policy.to_owned());
    let day = Arc::clone(day);
    Operation { url, day, policy, token: None, trusted: None, speed: None, by_hand: false }
}

#[test]
fn a_live_day_is_the_simulated_day_to_the_cent() {
    let folder = tempfile::tempdir().expect("a folder");
    let service = Running::start(folder.path());
    for network in ["paper", "disrupted", "new-york"] {
        for policy in ["greedy", "gcaps-x"] {
            let day = day(network, 2001);
            let report = operated(&service, &day, policy);
            assert_eq!(report.totals, simulated(&day, policy), "{network} {policy}");
            assert_eq!(report.sent_again, 0);
        }
    }
}

#[test]
fn a_day_that_others_decide_is_the_simulated_day_to_the_cent() {
    let folder = tempfile::tempdir().expect("a folder");
    let service = Running::start(folder.path());
    let day = day("disrupted", 2002);
    let operation = Operation { by_hand: true, ..operation(&service, &day, "greedy") };
    let stop = Stop::default();
    let report = std::thread::scope(|scope| {
        let operator = scope.spawn(|| operate(&operation, &stop, |_, _| ()));
        while !operator.is_finished() {
            decide_all(&service);
        }
        operator.join().expect("no panic")
    });
    let report = report.expect("the service answers").expect("nobody stops it");
    assert_eq!(report.totals, simulated(&day, "greedy"));
}

/// Decides for every aircraft that is ready, as the policy of the only day would.
fn decide_all(service: &Running) {
    let days = service.get("/v1/days").json;
    let Some(id) = days["days"][0]["id"].as_str() else { return };
    let state = service.get(&format!("/v1/days/{id}/state")).json;
    // Before the operator has said who waits in the morning, the day only knows whom it expects.
    if state["seq"] == 0 {
        return;
    }
    for aircraft in state["aircraft"].as_array().expect("a list") {
        if aircraft["needs_decision"] == true {
            let taken = service
                .post(&format!("/v1/days/{id}/decisions"), &json!({ "aircraft": aircraft["id"] }));
            assert_eq!(taken.status, 201, "{taken:?}");
        }
    }
}
