//! Expected rests of days, from now and from earlier moments.

use std::io::Write as _;
use std::net::TcpStream;
use std::sync::Arc;
use std::time::Duration;

use serde_json::{Value, json};
use vertifleet_core::{DaySeed, Network};
use vertifleet_policy::{Greedy, play};
use vertifleet_serve::{Limits, Location};
use vertifleet_sim::Simulation;

use crate::api::service;
use crate::running::Running;

#[test]
fn an_outlook_is_the_simulated_day_and_what_if_leaves_the_day_alone() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let outlook = service.get(&format!("{day}/outlook")).json;
    let asked = json!({
        "events": [{"type": "closed", "routes": {"vertiport": "V1"}, "until": "20:00:00"}],
    });
    let compared = service.post(&format!("{day}/what-if"), &asked).json;
    assert_eq!(compared["as_it_is"]["totals"], outlook["totals"]);
    assert!(compared["difference_usd"].as_f64().is_some_and(|usd| usd < -1_000.0), "{compared}");
    let legs = compared["what_if"]["legs"].as_array().expect("a list");
    assert!(
        legs.iter()
            .all(|leg| leg["from"] == leg["to"] || (leg["from"] != "V1" && leg["to"] != "V1"))
    );
    let more =
        json!({"aircraft": [{"id": "A99", "at": "V2"}], "stands": {"V2": 12}, "policy": "gcaps-x"});
    let compared = service.post(&format!("{day}/what-if"), &more).json;
    assert!(compared["difference_usd"].as_f64().is_some_and(|usd| usd > 0.0), "{compared}");
    assert!(
        compared["what_if"]["legs"]
            .as_array()
            .expect("a list")
            .iter()
            .any(|leg| leg["aircraft"] == "A99")
    );
    assert_eq!(service.get(&day).json["seq"], 0);
}

#[test]
fn a_flight_of_an_outlook_takes_off_when_its_charge_suffices() {
    let (_folder, service) = service();
    let network = Network::shipped("paper-quick").expect("a shipped network");
    let day = Arc::new(network.draw(DaySeed::validation(3).expect("a seed")));
    let mut takeoffs = Vec::new();
    let mut simulation = Simulation::new(Arc::clone(&day));
    play(&mut simulation, &mut Greedy, |row| {
        takeoffs.push((row.from != row.to).then(|| row.takeoff.to_string()));
    })
    .expect("a day");
    assert!(takeoffs.iter().flatten().count() > 100);
    let scenario: Value = serde_json::from_str(&day.to_json()).expect("JSON");
    let body = json!({"scenario": scenario, "policy": "greedy"});
    let path = service.post("/v1/days", &body).made("/v1/days");
    let outlook = service.get(&format!("{path}/outlook")).json;
    let legs = outlook["legs"].as_array().expect("a list");
    let given = legs.iter().map(|leg| leg["takeoff"].as_str().map(ToOwned::to_owned));
    assert_eq!(given.collect::<Vec<_>>(), takeoffs);
    let to_full = service.get(&format!("{}/outlook", service.new_day("greedy"))).json;
    let legs = to_full["legs"].as_array().expect("a list");
    assert!(legs.iter().all(|leg| leg.get("takeoff").is_none()), "{to_full}");
}

#[test]
fn an_outlook_from_an_earlier_moment_equals_the_one_at_that_time() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let asked = |query: &str| service.get(&format!("{day}/outlook?{query}"));
    let mut outlooks = vec![service.get(&format!("{day}/outlook")).json];
    let closed = json!({"type": "closed", "routes": {"vertiport": "V1"}, "until": "20:00:00"});
    assert_eq!(service.event(&day, &closed).status, 201);
    outlooks.push(service.get(&format!("{day}/outlook")).json);
    assert_eq!(service.decide(&day, &json!({"aircraft": "A01"})).status, 201);
    assert!(outlooks[1]["totals"]["profit_usd"] != outlooks[0]["totals"]["profit_usd"]);
    for (seq, outlook) in outlooks.iter().enumerate() {
        assert_eq!(&asked(&format!("seq={seq}")).json, outlook);
    }
    let by_another = asked("seq=0&policy=prices").json;
    assert_eq!(by_another["policy"], "prices");
    assert!(
        by_another["legs"]
            .as_array()
            .is_some_and(|legs| legs.iter().all(|leg| leg["is_taken"] == false))
    );
    assert_eq!(asked("seq=3").status, 404);
}

/// The path of a day of `large`, whose outlook by the rolling horizon takes minutes.
fn large_day(service: &Running) -> String {
    let body = json!({"network": "large", "policy": "greedy"});
    service.post("/v1/days", &body).made("/v1/days")
}

#[test]
fn an_outlook_that_takes_too_long_is_played_by_a_quick_policy_and_names_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let limits = Limits { request: Duration::from_secs(20), ..Limits::default() };
    let service = Running::start_with(Location::Folder(folder.path().to_owned()), limits);
    let day = large_day(&service);
    let outlook = service.get(&format!("{day}/outlook?policy=rolling"));
    assert_eq!(outlook.status, 200, "{outlook:?}");
    assert_eq!(
        (&outlook.json["policy"], &outlook.json["too_late"]),
        (&json!("greedy"), &json!("rolling"))
    );
    let quick = service.get(&format!("{day}/outlook"));
    assert_eq!(quick.json["totals"], outlook.json["totals"]);
    assert!(quick.json.get("too_late").is_none());
    let compared = service.post(&format!("{day}/what-if"), &json!({"policy": "rolling"}));
    assert_eq!((compared.status, &compared.json["difference_usd"]), (200, &json!(0.0)));
    assert_eq!(compared.json["what_if"]["too_late"], "rolling");
}

#[test]
fn outlooks_of_disconnected_clients_hold_no_turn() {
    let (_folder, service) = service();
    let (large, day) = (large_day(&service), service.new_day("greedy"));
    let address = service.url.trim_start_matches("http://");
    for _ in 0..8 {
        let mut abandoned = TcpStream::connect(address).expect("it listens");
        let head =
            format!("GET {large}/outlook?policy=rolling HTTP/1.1\r\nHost: {address}\r\n\r\n");
        abandoned.write_all(head.as_bytes()).expect("sent");
        std::thread::sleep(Duration::from_millis(200));
    }
    // If the turns were held, this would wait for minutes, and be refused.
    assert_eq!(service.get(&format!("{day}/outlook")).status, 200);
}
