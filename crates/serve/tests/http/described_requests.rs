//! Requests at the limits of the API's description: the service accepts and refuses them as the
//! description states.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use crate::api::service;

fn description() -> Value {
    serde_json::from_str(&vertifleet_serve::openapi()).expect("it is JSON")
}

/// The schema of a parameter.
fn parameter(path: &str, method: &str, name: &str) -> Value {
    let described = description();
    let parameters = described["paths"][path][method]["parameters"].clone();
    let found = parameters.as_array().expect("a list").iter().find(|one| one["name"] == name);
    found.unwrap_or_else(|| panic!("{path} has no {name}"))["schema"].clone()
}

#[test]
fn events_after_an_unknown_event_are_not_found() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let clock = json!({"type": "clock"});
    assert_eq!(service.event(&day, &clock).status, 201);
    for path in ["state?seq=", "events?after=", "stream?after="] {
        for beyond in ["2", "9223372036854775807"] {
            let refused = service.get(&format!("{day}/{path}{beyond}"));
            assert_eq!(refused.problem(), (404, "V602"), "{path}");
            let said = format!("there is no event {beyond}: the day is at event 1");
            assert_eq!(refused.json["detail"], json!(said), "{path}");
            assert!(refused.json["hint"].as_str().is_some_and(|hint| hint.contains("a copy")));
        }
    }
    assert_eq!(service.get(&format!("{day}/events?after=1")).json["events"], json!([]));
    assert_eq!(service.get(&format!("{day}/state?seq=1")).status, 200);
    // Unread parts are checked too.
    let path = format!("{day}/stream?after=9223372036854775808");
    assert_eq!(service.send("GET", &path, &[("last-event-id", "0")], b"").status, 400);
    for (id, status) in [("2", 404), ("abc", 400), ("9223372036854775808", 400)] {
        let refused = service.send("GET", &format!("{day}/stream"), &[("last-event-id", id)], b"");
        assert_eq!(refused.status, status, "{refused:?}");
    }
}

#[test]
fn times_that_follow_from_the_latest_ones_look_like_times() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let departed = json!({"type": "departed", "aircraft": "A01", "to": "V2", "time": 359_999});
    let compared = service.post(&format!("{day}/what-if"), &json!({"events": [departed]}));
    let legs = compared.json["what_if"]["legs"].as_array().expect("flights").clone();
    let is_late = |leg: &Value| leg["ready"].as_str().is_some_and(|ready| ready.len() == 9);
    assert!(legs.iter().any(is_late), "{legs:?}");
    let pattern = description()["components"]["schemas"]["Moment"]["pattern"].clone();
    assert!(pattern.as_str().is_some_and(|pattern| pattern.starts_with("^([0-9]{1,4}:")));
}

#[test]
fn a_page_has_as_many_entries_as_are_asked_for_or_the_request_is_refused() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    for (path, described, most) in [
        ("/v1/days", "/v1/days", 1_000),
        (&format!("{day}/events"), "/v1/days/{day}/events", 10_000),
    ] {
        let schema = parameter(described, "get", "limit");
        assert_eq!((&schema["minimum"], &schema["maximum"]), (&json!(1), &json!(most)), "{schema}");
        for limit in [1, most] {
            assert_eq!(service.get(&format!("{path}?limit={limit}")).status, 200);
        }
        for limit in [0, most + 1, 2_147_483_648_i64, -1] {
            let refused = service.get(&format!("{path}?limit={limit}"));
            assert_eq!(refused.problem(), (400, "V601"), "{limit}");
        }
    }
}

#[test]
fn numbers_are_taken_up_to_the_described_maximum() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let schemas = description()["components"]["schemas"].clone();
    let kinds = schemas["Event"]["oneOf"].as_array().expect("a list").clone();
    let maximum = |kind: &str, member: &str| {
        let of_kind = |one: &&Value| one["properties"]["type"]["enum"][0] == kind;
        let found = kinds.iter().find(of_kind).expect("a kind of event");
        found["properties"][member]["maximum"].as_u64().expect("a maximum")
    };
    let event = |body: Value| {
        let answer = service.event(&day, &body);
        (answer.status, answer.json["code"].as_str().unwrap_or_default().to_owned())
    };
    for excess in [0, 1] {
        let booked = maximum("booked", "passengers") + excess;
        let departed = maximum("departed", "passengers") + excess;
        let answers = [
            event(
                json!({"type": "booked", "period": "07:00:00", "from": "V1", "to": "V2", "passengers": booked}),
            ),
            event(
                json!({"type": "departed", "aircraft": "A01", "to": "V2", "passengers": departed}),
            ),
        ];
        for (status, code) in answers {
            assert_eq!((status, code) == (400, "V601".to_owned()), excess == 1, "{status}");
        }
        let deadline =
            parameter("/v1/days/{day}/aircraft/{aircraft}/decision", "get", "deadline_ms");
        let deadline = deadline["maximum"].as_u64().expect("a maximum") + excess;
        let path = format!("{day}/aircraft/A02/decision?deadline_ms={deadline}");
        assert_eq!(service.get(&path).status == 400, excess == 1, "{path}");
        let seed = schemas["NewDay"]["properties"]["seed"]["maximum"].as_u64().expect("a maximum");
        let made = service.post("/v1/days", &json!({"network": "paper", "seed": seed + excess}));
        assert_eq!(made.status == 400, excess == 1, "{made:?}");
        let stands = schemas["StandCount"]["maximum"].as_u64().expect("a maximum") + excess;
        let compared = service.post(&format!("{day}/what-if"), &json!({"stands": {"V1": stands}}));
        assert_eq!(compared.json["code"] == "V601", excess == 1, "{compared:?}");
    }
}

#[test]
fn events_have_only_the_described_members() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let path = format!("{day}/events");
    for (event, status) in [
        (json!({"type": "clock", "time": "06:00:00"}), 201),
        (json!({"type": "clock", "sky": "blue"}), 400),
        (json!({"type": "ready", "aircraft": "A01"}), 201),
        (json!({"type": "ready", "aircraft": "A01", "sky": "blue"}), 400),
        (json!({"type": "closed", "routes": {"vertiport": "V1"}}), 201),
        (json!({"type": "closed", "routes": {"vertiport": "V1", "sky": 1}}), 400),
        (json!({"type": "closed", "routes": {"from": "V1", "to": "V2", "vertiport": "V3"}}), 400),
    ] {
        assert_eq!(service.post(&path, &event).status, status, "{event}");
    }
    let schemas = description()["components"]["schemas"].clone();
    for name in ["Event", "RouteNames"] {
        for kind in schemas[name]["oneOf"].as_array().expect("a list") {
            assert_eq!(kind["additionalProperties"], json!(false), "{name}: {kind}");
        }
    }
    let time = &schemas["Event"]["oneOf"][1]["properties"]["time"];
    assert!(time.to_string().contains("#/components/schemas/Moment"), "{time}");
    let lists = &schemas["OneOrMore"]["oneOf"][0];
    assert_eq!((&lists["minItems"], &lists["maxItems"]), (&json!(1), &json!(1_000)));
    for events in [0, 1_001] {
        let events = vec![json!({"type": "clock"}); events];
        assert_eq!(service.post(&path, &json!(events)).status, 400);
    }
}

#[test]
fn uploaded_policies_have_plain_names() {
    let (_folder, service) = service();
    let pattern = parameter("/v1/policies/{policy}", "put", "policy")["pattern"].clone();
    assert_eq!(pattern, json!("^[a-z0-9_-][a-z0-9._-]{0,39}$"));
    let put = |name: &str| {
        let refused = service.send("PUT", &format!("/v1/policies/{name}"), &[], b"no weights");
        refused.json["detail"].as_str().unwrap_or_default().contains("is called by")
    };
    for name in ["Ours", "a%20b", ".ours", "%2e%2e", &"a".repeat(41)] {
        assert!(put(name), "{name}");
    }
    for name in ["ours-2026", "_", "7.1", &"a".repeat(40)] {
        assert!(!put(name), "{name} is a name, and these are no weights");
    }
}

#[test]
fn each_kind_of_event_has_its_own_title() {
    let description = description();
    let kinds = description["components"]["schemas"]["Event"]["oneOf"].as_array().expect("kinds");
    let titles: BTreeSet<&str> =
        kinds.iter().map(|kind| kind["title"].as_str().expect("a title")).collect();
    assert_eq!(titles.len(), kinds.len(), "{titles:?}");
    assert!(titles.contains("DecidedEvent") && titles.contains("CorrectedEvent"), "{titles:?}");
}
