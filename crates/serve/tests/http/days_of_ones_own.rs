//! Days that are not drawn from seeds: with the user's networks, forecasts, places, dates and
//! policies.

use serde_json::{Value, json};
use vertifleet_core::Network;

use crate::api::service;

const TOWN: &str = r#"
format = "vertifleet-network/1"
name = "town"
start_positions = "random"
time_zone = "Europe/Berlin"

[operations]
start = "06:00:00"
end = "09:00:00"
takeoff_s = 300
landing_s = 300
hold_s = 600

[[vertiports]]
id = "North"
latitude = 52.55
longitude = 13.40
stands = 2
busy = false

[[vertiports]]
id = "South"
latitude = 52.40
longitude = 13.40
stands = 2
busy = false

[[aircraft_types]]
id = "small"
seats = 4
speed_mph = 150
battery_kwh = 100
energy_kwh_per_mi = 1
charge_kw = 150
self_discharge_per_h = 0

[[fleet]]
type = "small"
count = 2

[tariffs]
fare_usd_per_mi = 5
passenger_cost_usd_per_mi = 1
fare_base = 0
fare_demand_weight = 0
energy_price_usd_per_kwh = [0.2, 0.2]

[uniform_demand]
periods = ["06:00:00", "07:00:00"]
least = 1
most = 3
"#;

fn detail(value: &Value) -> &str {
    value["detail"].as_str().unwrap_or_else(|| panic!("{value}"))
}

#[test]
fn a_network_is_uploaded_listed_and_used() {
    let (folder, service) = service();
    let body = json!({ "toml": TOWN });
    let checked = service.post("/v1/networks/validate", &body);
    assert_eq!((checked.status, &checked.json["aircraft"]), (200, &json!(2)), "{checked:?}");
    assert_eq!(service.get("/v1/networks/town").status, 404, "validating keeps nothing");
    let put = service.send("PUT", "/v1/networks/town", &[], body.to_string().as_bytes());
    assert_eq!(put.status, 200, "{put:?}");
    let other = service.send("PUT", "/v1/networks/city", &[], body.to_string().as_bytes());
    assert!(detail(&other.json).contains("is called \"town\""), "{other:?}");
    let paper = TOWN.replace("\"town\"", "\"paper\"");
    let paper = json!({ "toml": paper }).to_string();
    assert_eq!(service.send("PUT", "/v1/networks/paper", &[], paper.as_bytes()).status, 400);
    for zone in ["Europe/Atlantis", "New York", "UTC-5"] {
        let no_zone = json!({ "toml": TOWN.replace("Europe/Berlin", zone) });
        let no_zone = service.post("/v1/networks/validate", &no_zone);
        assert!(detail(&no_zone.json).contains("time_zone must be a time zone"), "{no_zone:?}");
    }

    drop(service);
    let service = crate::running::Running::start(folder.path());
    let networks = service.get("/v1/networks").json;
    let names: Vec<&str> = networks["networks"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|one| one["name"].as_str())
        .collect();
    let shipped: Vec<&str> = Network::shipped_names().collect();
    assert_eq!(names, [&shipped[..], &["town"]].concat());
    assert_eq!(service.get("/v1/networks/town").json["toml"], TOWN);
    let day = service.post("/v1/days", &json!({"network": "town", "date": "2026-11-23"}));
    assert_eq!((day.status, &day.json["name"]), (201, &json!("town 2026-11-23")), "{day:?}");
    assert_eq!(service.send("DELETE", "/v1/networks/town", &[], b"").status, 204);
    assert_eq!(service.send("DELETE", "/v1/networks/town", &[], b"").status, 404);
    let id = day.json["id"].as_str().expect("an id");
    assert_eq!(service.get(&format!("/v1/days/{id}/state")).status, 200, "the day is its own");
}

#[test]
fn a_day_has_the_given_forecast_places_and_date() {
    let (_folder, service) = service();
    let body = json!({
        "network": "new-york", "name": "Monday", "date": "2026-11-23", "policy": "greedy",
        "forecast": [
            {"period": "07:00:00", "from": "JRA", "to": "JFK", "passengers": 3},
            {"period": "07:30:00", "from": "JRA", "to": "JFK", "passengers": 2},
            {"period": 28800, "from": "JFK", "to": "JRA", "passengers": 4}
        ],
        "aircraft": {"A01": "JRA", "A02": "JFK"}
    });
    let made = service.post("/v1/days", &body);
    assert_eq!(made.status, 201, "{made:?}");
    assert_eq!(made.json["time_zone"], "America/New_York");
    let day = format!("/v1/days/{}", made.json["id"].as_str().expect("an id"));
    let scenario = service.get(&format!("{day}/scenario")).json;
    let passengers: u64 = scenario["demand"]
        .as_array()
        .expect("periods")
        .iter()
        .flat_map(|period| period.as_array().expect("rows"))
        .flat_map(|row| row.as_array().expect("cells"))
        .filter_map(Value::as_u64)
        .sum();
    assert_eq!(passengers, 9);
    let state = service.get(&format!("{day}/state?times=iso")).json;
    assert_eq!(state["aircraft"][0]["place"], "JRA");
    assert_eq!(state["now"], "2026-11-23T06:00:00-05:00");
    assert_eq!(service.state(&day)["now"], "06:00:00");

    let event = json!({"type": "clock", "time": "2026-11-23T12:10:00Z"});
    assert_eq!(service.event(&day, &event).status, 201);
    let events = service.get(&format!("{day}/events")).json;
    assert_eq!(events["events"][0]["event"]["time"], "07:10:00");
    let events = service.get(&format!("{day}/events?times=iso")).json;
    assert_eq!(events["events"][0]["event"]["time"], "2026-11-23T07:10:00-05:00");
    let path = format!("{day}/aircraft/A01/decision?time=2026-11-23T07:15:00-05:00");
    let proposal = service.get(&path).json;
    assert_eq!((&proposal["time"], &proposal["to"]), (&json!("07:15:00"), &json!("JFK")));
    let outlook = service.get(&format!("{day}/outlook?times=iso")).json;
    let arrival = outlook["legs"][0]["arrival"].as_str().expect("a time");
    assert!(arrival.starts_with("2026-11-23T"), "{arrival}");
}

#[test]
fn an_invalid_day_is_refused_with_a_message() {
    let (_folder, service) = service();
    for (body, said) in [
        (json!({"network": "paper", "date": "2026-11-23"}), "needs a `time_zone`"),
        (json!({"network": "paper", "time_zone": "UTC"}), "goes with `date`"),
        (json!({"network": "new-york", "date": "2026-13-01"}), "is no date"),
        (json!({"network": "paper", "name": ""}), "1 to 80 characters"),
        (json!({"network": "paper", "aircraft": {"A01": "V9"}}), "no vertiport \"V9\""),
        (json!({"network": "paper", "aircraft": {"B1": "V1"}}), "no aircraft \"B1\""),
        (
            json!({"network": "paper", "forecast": [{"period": "2026-11-23T07:00:00Z", "from": "V1", "to": "V2", "passengers": 1}]}),
            "the day has none",
        ),
        (
            json!({"network": "paper", "forecast": [{"period": "07:00:00", "from": "V1", "to": "V1", "passengers": 1}]}),
            "from a vertiport to itself",
        ),
    ] {
        let answer = service.post("/v1/days", &body);
        assert!(answer.status == 400 || answer.status == 422, "{body}: {answer:?}");
        assert!(detail(&answer.json).contains(said), "{body}: {answer:?}");
    }
}

#[test]
fn an_uploaded_policy_decides() {
    let (folder, service) = service();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models/any/gcaps-x.safetensors");
    let weights = std::fs::read(path).expect("the shipped weights");
    let checked = service.send("POST", "/v1/policies/validate", &[], &weights);
    assert_eq!((checked.status, &checked.json["kind"]), (200, &json!("gcaps-x")), "{checked:?}");
    assert_eq!(checked.json.get("name"), None, "it has none");
    let put = service.send("PUT", "/v1/policies/ours-2026", &[], &weights);
    assert_eq!(put.status, 200, "{put:?}");
    let sum = put.json["weights_sha256"].clone();
    // The same weights again change nothing; other weights under the same name would falsify the
    // log of a day.
    assert_eq!(service.send("PUT", "/v1/policies/ours-2026", &[], &weights).status, 200);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models/paper/mlp.safetensors");
    let others = std::fs::read(path).expect("the shipped weights");
    let refused = service.send("PUT", "/v1/policies/ours-2026", &[], &others);
    assert!(detail(&refused.json).contains("other weights"), "{refused:?}");
    for (name, weights) in
        [("greedy", &weights), ("Ours", &weights), ("fresh", &b"no weights".to_vec())]
    {
        let refused = service.send("PUT", &format!("/v1/policies/{name}"), &[], weights);
        assert_eq!(refused.status, 400, "{name}: {refused:?}");
    }

    drop(service);
    let service = crate::running::Running::start(folder.path());
    let day = service.new_day("ours-2026");
    let ours = service.get(&format!("{day}/aircraft/A01/decision")).json;
    assert_eq!((&ours["policy"], &ours["weights_sha256"]), (&json!("ours-2026"), &sum));
    let shipped = service.get(&format!("{day}/aircraft/A01/decision?policy=gcaps-x")).json;
    assert_eq!(ours["alternatives"], shipped["alternatives"]);
    let outlook = service.get(&format!("{day}/outlook")).json;
    assert_eq!(outlook["policy"], "ours-2026");
    assert_eq!(service.get("/v1/policies/ours-2026").json["vertiports"], Value::Null);
    // It cannot be deleted while a day uses it, and its name means these weights permanently.
    let needed = service.send("DELETE", "/v1/policies/ours-2026", &[], b"");
    assert_eq!(needed.problem(), (409, "V630"), "{needed:?}");
    assert_eq!(service.post(&format!("{day}/archive"), &json!({})).status, 204);
    assert_eq!(service.send("DELETE", "/v1/policies/ours-2026", &[], b"").status, 204);
    assert_eq!(service.send("DELETE", "/v1/policies/ours-2026", &[], b"").status, 404);
    assert_eq!(service.get(&format!("{day}/outlook")).status, 404);
    let listed = service.get("/v1/policies").json;
    assert!(!listed.to_string().contains("ours-2026"), "{listed}");
    assert_eq!(service.send("PUT", "/v1/policies/ours-2026", &[], &others).status, 400);
    assert_eq!(service.send("PUT", "/v1/policies/ours-2026", &[], &weights).status, 200);
    assert_eq!(service.get(&format!("{day}/outlook")).status, 200);
}

#[test]
fn an_override_records_the_choice_of_the_policy() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let proposal = service.get(&format!("{day}/aircraft/A01/decision")).json;
    let other = proposal["alternatives"]
        .as_array()
        .expect("a list")
        .iter()
        .find(|one| one["to"] != proposal["to"] && one.get("impossible").is_none());
    let other = &other.expect("another choice")["to"];
    let body = json!({"aircraft": "A01", "to": other, "reason": "a charter", "deadline_ms": 5000});
    let taken = service.decide(&day, &body);
    assert_eq!(taken.status, 201, "{taken:?}");
    let event = service.get(&format!("{day}/events")).json["events"][0]["event"].clone();
    assert_eq!((&event["to"], &event["instead_of"]), (other, &proposal["to"]));
}

#[test]
fn the_state_lists_waiting_aircraft_flights_and_closures() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let send = |event: Value| {
        let answer = service.event(&day, &event);
        assert_eq!(answer.status, 201, "{event}: {answer:?}");
    };
    let proposal = service.get(&format!("{day}/aircraft/A01/decision")).json;
    send(json!({"type": "decided", "aircraft": "A01", "to": proposal["to"]}));
    send(json!({"type": "out_of_service", "aircraft": "A02", "until": "09:00:00"}));
    send(json!({"type": "closed", "routes": {"from": "V1", "to": "V2"}, "until": "08:00:00"}));
    send(json!({"type": "closed", "routes": {"from": "V1", "to": "V3"}}));
    let state = service.state(&day);
    let (first, second) = (&state["aircraft"][0], &state["aircraft"][1]);
    assert_eq!(
        (&first["needs_decision"], &first["flight"]["to"]),
        (&json!(false), &proposal["to"])
    );
    assert_eq!(first["flight"]["from"], proposal["at"]);
    assert_eq!(
        (&second["needs_decision"], &second["out_until"]),
        (&json!(false), &json!("09:00:00"))
    );
    assert_eq!(state["aircraft"][2]["needs_decision"], json!(true));
    let closed = json!([{"to": "V2", "until": "08:00:00"}, {"to": "V3", "until": null}]);
    assert_eq!(state["vertiports"][0]["closed"], closed);
}
