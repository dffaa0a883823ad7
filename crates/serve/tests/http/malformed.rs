//! Invalid requests: each gets an answer with a code, and the day does not change.

use serde_json::{Value, json};

use crate::api::service;

#[test]
fn the_length_of_a_reason_is_limited() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let place = service.state(&day)["aircraft"][0]["place"].clone();
    let long = "\u{e9}".repeat(1_001);
    let event = |reason: &str| json!({"type": "undone", "aircraft": "A01", "reason": reason});
    let decision = |reason: &str| json!({"aircraft": "A01", "to": place, "reason": reason});
    for (path, body) in [("events", event(&long)), ("decisions", decision(&long))] {
        let answer = service.post(&format!("{day}/{path}"), &body);
        assert_eq!(answer.status, 400, "{path}");
        assert!(
            answer.json["detail"].to_string().contains("at most 1000 characters"),
            "{answer:?}"
        );
    }
    let most = &long[..2_000];
    assert_eq!(service.decide(&day, &decision(most)).status, 201);
    assert_eq!(service.event(&day, &event(most)).status, 201);
}

#[test]
fn a_page_of_long_events_ends_before_it_fills_the_memory() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let ids = ["V1", "V2", "V3", "V4", "V5", "V6", "V7", "V8"];
    let pairs: Vec<Value> = ids
        .iter()
        .flat_map(|from| ids.iter().map(move |to| json!({"from": from, "to": to, "passengers": 3})))
        .filter(|pair| pair["from"] != pair["to"])
        .collect();
    let pairs: Vec<Value> = pairs.iter().cycle().take(20_000).cloned().collect();
    let event = json!({"type": "demand", "period": "07:00:00", "pairs": pairs});
    for _ in 0..6 {
        assert_eq!(service.event(&day, &event).status, 201);
    }
    let (mut after, mut pages, mut seen) = (0, 0, 0);
    loop {
        let answer = service.get(&format!("{day}/events?after={after}&limit=10000"));
        assert!(answer.json.to_string().len() < 6 << 20);
        seen += answer.json["events"].as_array().expect("a list").len();
        pages += 1;
        let Some(next) = answer.json["next"].as_u64() else { break };
        after = next;
    }
    assert_eq!((seen, pages > 1), (6, true), "{pages} pages");
    let state = service.get(&format!("{day}/state?seq=5"));
    assert_eq!(state.json["seq"], 5, "long events can be replayed");
}

#[test]
fn an_event_has_each_member_once_and_no_other() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let answer = |body: &str| {
        let answer = service.send("POST", &format!("{day}/events"), &[], body.as_bytes());
        (answer.status, answer.json["detail"].to_string())
    };
    for (body, rule) in [
        (r#"{"type": "clock", "type": "clock"}"#, "duplicate member `type`"),
        (r#"{"time": "07:00:00", "type": "clock", "time": "08:00:00"}"#, "duplicate member `time`"),
        (
            r#"{"type": "ready", "aircraft": "A01", "aircraft": "A02"}"#,
            "duplicate member `aircraft`",
        ),
        (r#"{"type": "clock", "aircraft": "A01"}"#, "unknown member `aircraft` of a clock"),
        (r#"{"type": "ready", "aircraft": "A01", "at": "V1"}"#, "unknown member `at`"),
    ] {
        let (status, detail) = answer(body);
        assert!(status == 400 && detail.contains(rule), "{body}: {status} {detail}");
    }
    assert_eq!(answer(r#"{"type": "clock", "time": null}"#).0, 201);
}

#[test]
fn a_clock_beyond_the_end_of_the_day_is_refused() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let clock = |time: &str| service.event(&day, &json!({"type": "clock", "time": time})).status;
    assert_eq!([clock("99:59:59"), clock("22:00:01")], [422, 422], "the day ends at 18:00");
    assert_eq!([clock("17:00:00"), clock("21:59:59"), clock("25:00:00")], [201, 201, 201]);
}

#[test]
fn deep_and_huge_requests_are_refused() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let deep = "[".repeat(100_000);
    let huge = format!(r#"{{"type":"ready","aircraft":"{}"}}"#, "A".repeat(1_000_000));
    for body in [deep, huge] {
        let answer = service.send("POST", &format!("{day}/events"), &[], body.as_bytes());
        assert!((400..500).contains(&answer.status), "{}", answer.status);
        assert!(answer.json.to_string().len() < 1_000, "the answer does not repeat the request");
    }
}

#[test]
fn json_may_begin_with_a_byte_order_mark() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let path = format!("{day}/events");
    for body in [r#"{"type": "clock"}"#, r#"[{"type": "clock"}]"#] {
        // Programs that add one to a text that has one already write two.
        for marks in [1, 2] {
            let marked = ["\u{feff}".repeat(marks).as_str(), body].concat();
            let taken = service.send("POST", &path, &[], marked.as_bytes());
            assert_eq!(taken.status, 201, "{taken:?}");
        }
    }
}

#[test]
fn numbers_that_json_does_not_have_are_named() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    for (number, named) in [("NaN", "NaN"), ("Infinity", "Infinity"), ("-Infinity", "-Infinity")] {
        let event =
            format!("{{\"type\": \"landed\",\n \"aircraft\": \"A01\", \"charge_kwh\": {number}}}");
        for body in [event.clone(), format!("[{event}]"), format!("{{\"events\": [{event}]}}")] {
            let path = if body.starts_with("{\"events") { "what-if" } else { "events" };
            let refused = service.send("POST", &format!("{day}/{path}"), &[], body.as_bytes());
            assert_eq!(refused.problem(), (400, "V601"), "{body}");
            let detail = refused.json["detail"].as_str().unwrap_or_default();
            assert!(
                detail.contains(&format!("{named} is no number of JSON, at line 2")),
                "{detail}"
            );
        }
    }
}

#[test]
fn a_list_is_no_object_whatever_its_entries_are() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    for path in [format!("{day}/what-if"), format!("{day}/decisions"), "/v1/days".to_owned()] {
        for body in ["[]", " [null, null]", "[\"A01\", \"V2\"]"] {
            let refused = service.send("POST", &path, &[], body.as_bytes());
            assert_eq!(refused.problem(), (400, "V601"), "{path} {body}");
        }
    }
    assert_eq!(service.get(&format!("{day}/events")).json["events"], json!([]));
}

#[test]
fn null_is_the_same_as_an_optional_member_that_is_left_out() {
    let (_folder, service) = service();
    let new_day = json!({
        "network": "paper", "seed": null, "scenario": null, "forecast": null, "aircraft": null,
        "name": null, "date": null, "time_zone": null, "policy": "greedy",
    });
    let day = service.post("/v1/days", &new_day).made("/v1/days");
    let what_if = json!({"events": null, "policy": null, "stands": null, "aircraft": null});
    let compared = service.post(&format!("{day}/what-if"), &what_if);
    assert_eq!((compared.status, &compared.json["difference_usd"]), (200, &json!(0.0)));
    let decided = json!({
        "aircraft": "A01", "to": null, "reason": null, "policy": null, "time": null,
        "deadline_ms": null,
    });
    assert_eq!(service.decide(&day, &decided).status, 201);
    for event in [
        json!({"type": "clock", "time": null}),
        json!({"type": "undone", "aircraft": "A01", "reason": null}),
        json!({"type": "out_of_service", "aircraft": "A02", "until": null, "reason": null}),
        json!({"type": "closed", "routes": {"vertiport": "V1"}, "until": null, "reason": null}),
        json!({"type": "acknowledged", "alert": "closed V1", "reason": null}),
        json!({"type": "corrected", "event": 1, "reason": null}),
    ] {
        let taken = service.event(&day, &event);
        assert!(taken.status == 201 || event["event"] == 1, "{event}: {taken:?}");
    }
    let study = json!({
        "network": "paper", "toml": null, "policies": ["greedy", "random"], "days": 1,
        "seed": null, "split": null, "bounds": null,
    });
    let made = service.post("/v1/studies", &study);
    assert_eq!(made.status, 201, "{made:?}");
}

#[test]
fn null_in_a_scenario_is_the_same_as_an_optional_member_that_is_left_out() {
    let (_folder, service) = service();
    let mut scenario: Value =
        serde_json::from_str(include_str!("../../../core/tests/data/small.json")).expect("JSON");
    scenario["operations"]["passenger_wait_s"] = Value::Null;
    scenario["closures"] = Value::Null;
    let post = |scenario: &Value| service.post("/v1/days", &json!({"scenario": scenario}));
    let made = post(&scenario);
    assert_eq!(made.status, 201, "{made:?}");
    scenario["operations"]["hold_s"] = Value::Null;
    let refused = post(&scenario);
    assert_eq!(refused.status, 400);
    assert!(refused.json["detail"].to_string().contains("operations.hold_s"), "{refused:?}");
}

#[test]
fn the_reason_why_a_time_is_refused_is_true() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    for (time, reason) in [
        (" 09:05:00", "expected a time as HH:MM:SS, found \" 09:05:00\""),
        ("09:05:00 ", "expected a time as HH:MM:SS, found \"09:05:00 \""),
        ("9:05 AM", "expected a time as HH:MM:SS, found \"9:05 AM\""),
        ("today", "expected a time as HH:MM:SS, found \"today\""),
        ("2026-11-23", "expected a time as HH:MM:SS, found \"2026-11-23\""),
        ("2026-11-23T07:10:00Z", "has a date, but the day has none"),
        (" 2026-11-23 07:10:00Z", "has a date, but the day has none"),
    ] {
        let refused = service.event(&day, &json!({"type": "clock", "time": time}));
        let detail = refused.json["detail"].as_str().unwrap_or_default();
        assert!(refused.status == 400 && detail.contains(reason), "{time:?}: {refused:?}");
    }
}

#[test]
fn an_empty_time_is_refused_by_the_service_and_its_description() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let description: Value =
        serde_json::from_str(&vertifleet_serve::openapi()).expect("it is JSON");
    let pattern = description["components"]["schemas"]["Moment"]["pattern"].clone();
    for (path, described, name) in [
        ("aircraft/A01/decision?time=", "/v1/days/{day}/aircraft/{aircraft}/decision", "time"),
        ("demand?period=", "/v1/days/{day}/demand", "period"),
    ] {
        assert_eq!(service.get(&format!("{day}/{path}")).problem(), (400, "V601"), "{path}");
        assert_eq!(service.get(&format!("{day}/{path}07:00:00")).status, 200, "{path}");
        let parameters = description["paths"][described]["get"]["parameters"].clone();
        let parameters = parameters.as_array().expect("a list").iter();
        let schema = parameters.filter(|one| one["name"] == name).map(|one| &one["schema"]).next();
        let schema = schema.expect("it is described").to_string();
        let is_limited = schema.contains("Moment") || schema.contains("pattern");
        assert!(pattern.is_string() && is_limited, "{schema}");
    }
}
