//! Mistaken events are corrected, alerts are acknowledged, and the loser of a race learns what
//! happened: the same after a restart, at any event, and in the stream.

use serde_json::{Value, json};
use vertifleet_serve::Role;

use crate::api::{service, text};
use crate::running::{Answer, Running, bearers, folder};

/// A state without its number, the numbers of its notices, and its acknowledgements.
fn without_numbers(mut state: Value) -> Value {
    let object = state.as_object_mut().expect("a state");
    object.remove("seq");
    for notice in object["notices"].as_array_mut().expect("a list") {
        notice["seq"] = Value::Null;
    }
    state
}

fn correct(service: &Running, day: &str, event: u64) -> Answer {
    service.event(day, &json!({"type": "corrected", "event": event, "reason": "a mistake"}))
}

#[test]
fn a_corrected_event_leaves_no_trace_in_the_state() {
    let (folder, service) = service();
    let place = |number: usize| {
        let day = service.new_day("greedy");
        service.state(&day)["aircraft"][number]["place"].as_str().expect("a place").to_owned()
    };
    let other = |place: &str| if place == "V1" { "V2" } else { "V1" };
    let (first, second) = (place(0), place(1));
    let events = [
        json!({"type": "departed", "aircraft": "A01", "to": other(&first), "time": "06:05:00"}),
        json!({"type": "clock", "time": "17:59:00"}),
        json!({"type": "landed", "aircraft": "A01", "time": "06:05:01"}),
        json!({"type": "closed", "routes": {"vertiport": "V3"}, "time": "06:06:00"}),
        json!({"type": "departed", "aircraft": "A02", "to": other(&second), "time": "06:07:00"}),
        json!({"type": "acknowledged", "alert": "closed V3", "time": "06:07:00"}),
        json!({"type": "stands", "vertiport": "V1", "stands": 0, "time": "06:08:00"}),
        json!({"type": "ready", "aircraft": "A01", "time": "06:08:00"}),
    ];
    let mut restarted = Vec::new();
    for mistaken in 0..events.len() {
        let (day, clean) = (service.new_day("greedy"), service.new_day("greedy"));
        for (number, event) in events.iter().enumerate() {
            // Without its landing, an aircraft is not ready.
            let depends = [0, 2].contains(&mistaken) && number == 7;
            if depends || (mistaken == 0 && number == 2) {
                continue;
            }
            let taken = service.event(&day, event);
            assert_eq!(taken.status, 201, "{taken:?}");
            if number != mistaken {
                assert_eq!(service.event(&clean, event).status, 201);
            }
        }
        let corrected = correct(&service, &day, mistaken as u64 + 1);
        assert_eq!(corrected.status, 201, "{corrected:?}");
        let state = service.state(&day);
        let compared = |state: Value| {
            let mut state = without_numbers(state);
            for one in state["acknowledged"].as_array_mut().expect("a list") {
                one["seq"] = Value::Null;
            }
            state
        };
        assert_eq!(compared(state.clone()), compared(service.state(&clean)), "event {mistaken}");
        // The log still has both, and the state before the correction can be read.
        let log = service.get(&format!("{day}/events")).json["events"].clone();
        let last = log.as_array().and_then(|log| log.last()).expect("events").clone();
        assert_eq!(last["event"]["event"], mistaken + 1);
        assert_eq!(service.get(&format!("{day}/state?seq={}", state["seq"])).json, state);
        // The outlook is played from the corrected day.
        let legs = |day: &str| service.get(&format!("{day}/outlook")).json["legs"].clone();
        assert_eq!(legs(&day), legs(&clean), "event {mistaken}");
        let again = correct(&service, &day, mistaken as u64 + 1);
        assert_eq!(again.problem(), (422, "V632"));
        restarted.push((day, state));
    }
    drop(service);
    let service = Running::start(folder.path());
    for (day, state) in restarted {
        assert_eq!(service.state(&day), state, "the same after a restart");
    }
}

#[test]
fn an_event_that_later_ones_depend_on_is_not_corrected() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let place = service.state(&day)["aircraft"][0]["place"].clone();
    let to = if place == "V1" { "V2" } else { "V1" };
    for event in [
        json!({"type": "departed", "aircraft": "A01", "to": to, "time": "06:05:00"}),
        json!({"type": "landed", "aircraft": "A01", "time": "06:30:00"}),
    ] {
        assert_eq!(service.event(&day, &event).status, 201);
    }
    let before = service.state(&day);
    let refused = correct(&service, &day, 1);
    assert_eq!(refused.problem(), (422, "V632"));
    assert_eq!((&refused.json["event"], &refused.json["blocked_by"]), (&json!(1), &json!(2)));
    assert!(text(&refused.json, "detail").contains("correct event 2 first"), "{refused:?}");
    for unknown in [0, 3, u64::MAX] {
        assert_eq!(correct(&service, &day, unknown).problem(), (422, "V632"), "{unknown}");
    }
    assert_eq!(service.state(&day), before);
    assert_eq!(correct(&service, &day, 2).status, 201);
    assert_eq!(correct(&service, &day, 3).problem(), (422, "V632"), "no correction of corrections");
    assert_eq!(correct(&service, &day, 1).status, 201);
    assert_eq!(service.state(&day)["aircraft"][0]["place"], place);
}

#[test]
fn after_a_mistaken_clock_people_and_policies_decide_again() {
    let (_folder, service) = service();
    let day = service.new_day("gcaps-x");
    // Not by the policy, whose prices depend on its earlier decisions.
    let place = service.state(&day)["aircraft"][0]["place"].clone();
    let holds = json!({"type": "decided", "aircraft": "A01", "to": place});
    assert_eq!(service.event(&day, &holds).status, 201);
    assert_eq!(service.event(&day, &json!({"type": "clock", "time": "17:59:00"})).status, 201);
    let late = service.get(&format!("{day}/aircraft/A02/decision")).json;
    assert_eq!(late["time"], "17:59:00");
    let taken = correct(&service, &day, 2);
    assert_eq!(taken.status, 201);
    assert_eq!(service.state(&day)["now"], "06:00:00");
    let log = service.get(&format!("{day}/events?after=2")).json;
    assert_eq!(log["events"][0]["event"]["time"], "06:00:00", "{log}");
    let clean = service.new_day("gcaps-x");
    assert_eq!(service.event(&clean, &holds).status, 201);
    let proposal = |day: &str| {
        let mut proposal = service.get(&format!("{day}/aircraft/A02/decision")).json;
        let object = proposal.as_object_mut().expect("a proposal");
        object.remove("seq");
        object.remove("took_us");
        proposal
    };
    assert_eq!(proposal(&day), proposal(&clean));
}

#[test]
fn acknowledgements_are_shared() {
    let (_folder, location) = folder();
    let token = bearers(&location);
    let (anna, ben) = (token("anna", Role::Dispatch), token("ben", Role::Dispatch));
    let service = Running::start_at(location);
    let send = |bearer: &str, method: &str, path: &str, body: &Value| {
        service.send(method, path, &[("authorization", bearer)], body.to_string().as_bytes())
    };
    let day = send(&anna, "POST", "/v1/days", &json!({"network": "paper", "policy": "greedy"}));
    let day = day.made("/v1/days");
    let events = format!("{day}/events");
    let seen = |alert: &str| json!({"type": "acknowledged", "alert": alert, "reason": "called"});
    for (who, alert) in [(&anna, "full V1"), (&ben, "closed V2"), (&ben, "full V1")] {
        assert_eq!(send(who, "POST", &events, &seen(alert)).status, 201);
    }
    let state = || send(&anna, "GET", &format!("{day}/state"), &Value::Null).json;
    let listed = state()["acknowledged"].clone();
    let one = |alert: &str, seq: u64| json!({"alert": alert, "seq": seq, "actor": "ben", "time": "06:00:00", "reason": "called"});
    assert_eq!(listed, json!([one("closed V2", 2), one("full V1", 3)]));
    let corrected = send(&ben, "POST", &events, &json!({"type": "corrected", "event": 3}));
    assert_eq!(corrected.status, 201);
    let listed = state()["acknowledged"].clone();
    assert_eq!((&listed[0]["actor"], &listed[1]["seq"]), (&json!("anna"), &json!(2)));
    for wrong in ["", &"a".repeat(201)] {
        assert_eq!(send(&anna, "POST", &events, &seen(wrong)).problem(), (400, "V601"));
    }
}

#[test]
fn the_loser_of_a_race_is_told_what_happened() {
    let (_folder, location) = folder();
    let token = bearers(&location);
    let (anna, ben) = (token("anna", Role::Dispatch), token("ben", Role::Dispatch));
    let service = Running::start_at(location);
    let send = |bearer: &str, tag: Option<&str>, path: &str, body: &Value| {
        let headers = [("authorization", bearer), ("if-match", tag.unwrap_or_default())];
        let headers = if tag.is_some() { &headers[..] } else { &headers[..1] };
        service.send("POST", path, headers, body.to_string().as_bytes())
    };
    let day = json!({"network": "paper", "policy": "greedy"});
    let day = send(&anna, None, "/v1/days", &day).made("/v1/days");
    let path = format!("{day}/decisions");
    let proposal = format!("{day}/aircraft/A01/decision");
    let proposal = service.send("GET", &proposal, &[("authorization", anna.as_str())], b"").json;
    let to = proposal["alternatives"].as_array().expect("a list").iter();
    let mut to = to.filter(|one| one.get("impossible").is_none()).map(|one| text(one, "to"));
    let to = to.rfind(|to| *to != text(&proposal, "at")).expect("a flight").to_owned();
    let decide = json!({"aircraft": "A01", "to": to});
    assert_eq!(send(&anna, Some("0"), &path, &decide).status, 201);
    let told = format!("A01 was sent to {to} by anna");
    let ask = |tag: Option<&str>, path: &str, body: &Value| send(&ben, tag, path, body);
    let events = format!("{day}/events");
    let decided = json!({"type": "decided", "aircraft": "A01", "to": to});
    for refused in [
        ask(Some("0"), &path, &decide),
        ask(None, &path, &decide),
        ask(None, &path, &json!({"aircraft": "A01"})),
        ask(Some("0"), &events, &decided),
        ask(None, &events, &decided),
        ask(None, &events, &json!([{"type": "clock"}, decided])),
    ] {
        assert!([412, 422].contains(&refused.status), "{refused:?}");
        let happened = &refused.json["happened"];
        assert_eq!((&happened["text"], &happened["seq"]), (&json!(told), &json!(1)), "{refused:?}");
        assert_eq!((&happened["actor"], &happened["event"]["to"]), (&json!("anna"), &json!(to)));
        assert!(text(&refused.json, "detail").ends_with(&format!("; {told} (event 1)")));
    }
    // An event about another aircraft is not the reason.
    let other = ask(Some("0"), &path, &json!({"aircraft": "A02"}));
    assert_eq!((other.problem(), other.json.get("happened")), ((412, "V605"), None));
}

#[test]
fn the_end_of_a_closure_can_be_brought_forward() {
    let (folder, service) = service();
    let day = service.new_day("greedy");
    let closed =
        |until: &str| json!({"type": "closed", "routes": {"vertiport": "V1"}, "until": until});
    for until in ["12:00:00", "09:00:00"] {
        assert_eq!(service.event(&day, &closed(until)).status, 201);
    }
    let state = service.state(&day);
    let closures = state["closures"].as_array().expect("a list").clone();
    assert_eq!(closures.len(), 14);
    let first = json!({"from": "V1", "to": "V2", "start": "06:00:00", "until": "09:00:00"});
    assert_eq!(closures[0], first);
    assert_eq!(state["vertiports"][1]["closed"], json!([{"to": "V1", "until": "09:00:00"}]));
    assert_eq!(service.event(&day, &json!({"type": "clock", "time": "09:00:00"})).status, 201);
    let state = service.state(&day);
    assert_eq!((&state["closures"], &state["vertiports"][0]["closed"]), (&json!([]), &json!([])));
    let way = json!({"from": "V1", "to": "V2"});
    service.event(&day, &closed("12:00:00"));
    service.event(&day, &json!({"type": "closed", "routes": way}));
    let state = service.state(&day);
    assert_eq!(state["vertiports"][0]["closed"][0], json!({"to": "V2", "until": null}));
    drop(service);
    assert_eq!(Running::start(folder.path()).state(&day), state);
}

#[test]
fn an_impossible_report_has_a_notice_with_a_code_in_answer_log_and_state() {
    let (folder, service) = service();
    let day = service.new_day("greedy");
    let place = service.state(&day)["aircraft"][0]["place"].clone();
    let to = if place == "V1" { "V2" } else { "V1" };
    let departed = json!({"type": "departed", "aircraft": "A01", "to": to});
    service.event(&day, &departed);
    let landed = service.event(&day, &json!({"type": "landed", "aircraft": "A01"}));
    let notice = landed.json["notices"][0][0].clone();
    assert_eq!((&notice["code"], &notice["aircraft"]), (&json!("too_fast"), &json!("A01")));
    assert_eq!(notice["vertiport"], to);
    let log = service.get(&format!("{day}/events?after=1")).json;
    assert_eq!(log["events"][0]["notices"][0], notice);
    let state = service.state(&day);
    let of_event = |state: &Value| {
        let all = state["notices"].as_array().expect("a list").clone();
        all.into_iter().find(|one| one["seq"] == 2).expect("a notice of the landing")
    };
    assert_eq!(of_event(&state)["text"], notice["text"]);
    drop(service);
    assert_eq!(Running::start(folder.path()).state(&day), state);
}
