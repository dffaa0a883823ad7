//! Tests of the API as its users call it.

use std::io::{BufRead as _, BufReader};

use serde_json::{Value, json};

use vertifleet_core::{Coded as _, Stop};
use vertifleet_serve::{Location, Protection, Role, Settings, Tokens};

use crate::running::{Running, bearers, folder, settings_for};

pub(crate) fn text<'a>(value: &'a Value, name: &str) -> &'a str {
    value[name].as_str().unwrap_or_else(|| panic!("no text {name:?} in {value}"))
}

pub(crate) fn service() -> (tempfile::TempDir, Running) {
    let (folder, location) = folder();
    (folder, Running::start_at(location))
}

#[test]
fn a_proposal_has_its_reasons() {
    let (_folder, service) = service();
    let day = service.new_day("gcaps-x");
    let answer = service.get(&format!("{day}/aircraft/A01/decision"));
    assert_eq!((answer.status, answer.tag.as_str()), (200, "\"0\""));
    let proposal = answer.json;
    assert_eq!(text(&proposal, "policy"), "gcaps-x");
    assert_eq!(text(&proposal, "weights_sha256").len(), 64);
    let alternatives = proposal["alternatives"].as_array().expect("a list");
    assert_eq!(alternatives.len(), 8);
    let chosen: Vec<&Value> =
        alternatives.iter().filter(|one| one["to"] == proposal["to"]).collect();
    let [chosen] = chosen[..] else { panic!("{proposal}") };
    for one in alternatives {
        if let Some(impossible) = one.get("impossible") {
            assert_eq!(text(impossible, "rule"), "no_stand_free");
            assert!(text(impossible, "reason").ends_with("(6 of 6)"), "{impossible}");
            assert_eq!(one.get("worth_usd"), None);
        } else {
            assert!(one["worth_usd"].is_number() && one["stand_price_usd"].is_number(), "{one}");
        }
        if let Some(value) = one.get("value") {
            assert!(value.as_f64() <= chosen["value"].as_f64(), "{one} is above {chosen}");
        }
    }
    // A proposal changes nothing.
    assert_eq!(service.get(&day).json["seq"], 0);
}

#[test]
fn a_late_policy_is_replaced_and_named_in_the_answer() {
    let (_folder, service) = service();
    let day = service.new_day("rolling");
    let path = format!("{day}/aircraft/A01/decision?deadline_ms=0");
    let proposal = service.get(&path).json;
    assert_eq!((text(&proposal, "policy"), text(&proposal, "too_late")), ("greedy", "rolling"));
}

#[test]
fn a_request_with_a_key_is_carried_out_once() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let path = format!("{day}/events");
    let booked = |passengers: u32| {
        json!({"type": "booked", "period": "07:00:00", "from": "V1", "to": "V2", "passengers": passengers})
            .to_string()
    };
    let key = [("idempotency-key", "one")];
    let first = service.send("POST", &path, &key, booked(2).as_bytes());
    let again = service.send("POST", &path, &key, booked(2).as_bytes());
    assert_eq!((first.status, again.status), (201, 201));
    assert_eq!(first.json, again.json);
    assert_eq!(service.get(&day).json["seq"], 1);
    let other = service.send("POST", &path, &key, booked(3).as_bytes());
    assert_eq!(other.problem(), (422, "V609"));
    let decided = service.send("POST", &format!("{day}/decisions"), &key, b"{}");
    assert_eq!(text(&decided.json, "code"), "V609");
}

#[test]
fn of_two_dispatchers_one_decides() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let path = format!("{day}/decisions");
    let decide =
        |tag: &str| service.send("POST", &path, &[("if-match", tag)], br#"{"aircraft": "A01"}"#);
    let first = decide("\"0\"");
    assert_eq!((first.status, first.tag.as_str()), (201, "\"1\""));
    let second = decide("\"0\"");
    assert_eq!(second.problem(), (412, "V605"));
    // Without If-Match, the rules still forbid that an aircraft decides twice.
    let third = service.post(&path, &json!({"aircraft": "A01"}));
    assert_eq!(third.problem(), (422, "V604"));
}

#[test]
fn several_events_are_applied_together_or_not_at_all() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let good = json!({"type": "out_of_service", "aircraft": "A02", "until": 30_000});
    let bad = json!({"type": "landed", "aircraft": "A03"});
    let refused = service.event(&day, &json!([good, bad]));
    assert_eq!(refused.problem(), (422, "V604"));
    let detail = text(&refused.json, "detail");
    assert!(detail.starts_with("event 2 of 2: "), "{detail}");
    assert!(detail.contains("stands at its vertiport"), "{detail}");
    assert_eq!(service.get(&day).json["seq"], 0);
    let taken = service.event(&day, &json!([good, good]));
    assert_eq!((taken.status, &taken.json["seq"]), (201, &json!(2)));
    let state = service.state(&day);
    assert_eq!(state["aircraft"][1]["out_of_service"], true);
    assert_eq!(state["aircraft"][1]["ready"], "08:20:00");
}

#[test]
fn reports_that_break_rules_are_accepted_with_a_lasting_notice() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let fewer = json!({"type": "stands", "vertiport": "V1", "stands": 0});
    let taken = service.event(&day, &fewer).json;
    assert!(
        taken["notices"][0][0]["text"].as_str().is_some_and(|text| text.contains("0 stands")),
        "{taken}"
    );
    let state = service.state(&day);
    assert_eq!(state["notices"].as_array().map(Vec::len), Some(2), "with its event, and now");
    // No aircraft can fly there, and the reason has the numbers.
    let proposal = service.get(&format!("{day}/aircraft/A40/decision")).json;
    let to =
        proposal["alternatives"].as_array().expect("a list").iter().find(|one| one["to"] == "V1");
    let to = to.expect("V1 is among them");
    assert!(proposal["at"] == "V1" || text(&to["impossible"], "rule") == "no_stand_free", "{to}");
}

#[test]
fn a_day_is_the_same_after_a_restart_and_can_be_read_at_any_event() {
    let (folder, service) = service();
    let day = service.new_day("greedy");
    let mut states = vec![service.state(&day)];
    for aircraft in ["A01", "A02", "A03"] {
        assert_eq!(service.decide(&day, &json!({"aircraft": aircraft})).status, 201);
        states.push(service.state(&day));
    }
    drop(service);
    let service = Running::start(folder.path());
    assert_eq!(service.state(&day), states[3]);
    for (seq, state) in states.iter().enumerate() {
        assert_eq!(&service.get(&format!("{day}/state?seq={seq}")).json, state);
    }
    assert_eq!(service.get(&format!("{day}/state?seq=4")).status, 404);
    let trace = service.get(&format!("{day}/trace.csv")).json;
    assert_eq!(trace.as_str().map(|csv| csv.lines().count()), Some(4));
}

#[test]
fn a_stream_continues_after_the_last_event_of_its_reader() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let decide = |aircraft: &str| service.decide(&day, &json!({"aircraft": aircraft}));
    assert_eq!((decide("A01").status, decide("A02").status), (201, 201));
    let request = ureq::get(format!("{}{day}/stream", service.url)).header("last-event-id", "1");
    let mut answer = request.call().expect("a stream");
    let mut lines = BufReader::new(answer.body_mut().as_reader()).lines();
    let mut next =
        || lines.by_ref().map(|line| line.expect("a line")).find(|line| !line.is_empty());
    assert_eq!(next().as_deref(), Some("id: 2"));
    assert!(next().is_some_and(|data| data.contains("\"aircraft\":\"A02\"")));
    assert_eq!(decide("A03").status, 201);
    assert_eq!(next().as_deref(), Some("id: 3"));
}

#[test]
fn wrong_requests_are_answered_with_a_code() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let cases = [
        ("GET", "/v1/nothing".to_owned(), "", 404, "V602"),
        ("GET", "/v1/days/none".to_owned(), "", 404, "V602"),
        ("POST", "/v1/days".to_owned(), "{}", 400, "V601"),
        ("POST", "/v1/days".to_owned(), r#"{"network": "nowhere"}"#, 404, "V602"),
        (
            "POST",
            "/v1/days".to_owned(),
            r#"{"network": "paper", "policy": "replay:/etc/passwd"}"#,
            404,
            "V602",
        ),
        ("POST", format!("{day}/events"), "[", 400, "V601"),
        ("POST", format!("{day}/events"), "[]", 400, "V601"),
        ("POST", format!("{day}/events"), r#"{"type": "ready"}"#, 400, "V601"),
        (
            "POST",
            format!("{day}/events"),
            r#"{"type": "ready", "aircraft": "A01", "more": 1}"#,
            400,
            "V601",
        ),
        (
            "POST",
            format!("{day}/events"),
            r#"{"type": "ready", "aircraft": "A01", "time": "7 am"}"#,
            400,
            "V601",
        ),
        ("POST", format!("{day}/events"), r#"{"type": "ready", "aircraft": "X"}"#, 422, "V603"),
        ("GET", format!("{day}/aircraft/A01/decision?policy=none"), "", 404, "V602"),
        ("GET", format!("{day}/aircraft/A01/decision?deadline=1"), "", 400, "V601"),
        ("PUT", day.clone(), "", 405, "V616"),
    ];
    for (method, path, body, status, code) in cases {
        let answer = service.send(method, &path, &[], body.as_bytes());
        assert_eq!(
            (answer.status, answer.json["code"].as_str()),
            (status, Some(code)),
            "{method} {path} {body}: {answer:?}"
        );
    }
}

#[test]
fn tokens_decide_rights_and_name_the_author() {
    let (folder, service) = service();
    let day = service.new_day("greedy");
    let tokens = Tokens::open(&Location::Folder(folder.path().to_owned())).expect("a store");
    let read = tokens.make("auditor", Role::Read).expect("a token");
    let dispatch = tokens.make("console", Role::Dispatch).expect("a token");
    let admin = tokens.make("operations", Role::Admin).expect("a token");
    // The service reads the tokens every two seconds.
    std::thread::sleep(std::time::Duration::from_millis(2_100));
    let ask = |method: &str, path: &str, token: &str, body: &str| {
        let bearer = format!("Bearer {token}");
        let answer =
            service.send(method, path, &[("authorization", bearer.as_str())], body.as_bytes());
        (answer.status, answer.json["code"].as_str().unwrap_or_default().to_owned())
    };
    let (events, booked) = (
        format!("{day}/events"),
        r#"{"type": "booked", "period": "09:00:00", "from": "V1", "to": "V2", "passengers": 1}"#,
    );
    let outcome = |status: u16, code: &str| (status, code.to_owned());
    assert_eq!(service.get("/healthz").status, 200);
    assert_eq!(text(&service.get(&day).json, "code"), "V610");
    assert_eq!(ask("GET", &day, &format!("{read}0"), ""), outcome(401, "V610"));
    assert_eq!(ask("GET", &day, &read, "").0, 200);
    assert_eq!(ask("POST", &format!("{day}/what-if"), &read, "{}").0, 200);
    assert_eq!(ask("POST", &events, &read, booked), outcome(403, "V618"));
    assert_eq!(ask("POST", &events, &dispatch, booked).0, 201);
    assert_eq!(ask("DELETE", &day, &dispatch, ""), outcome(403, "V618"));
    let listed = service.send("GET", &events, &[("authorization", &format!("Bearer {read}"))], b"");
    assert_eq!(text(&listed.json["events"][0], "actor"), "console");
    let id = tokens
        .list()
        .expect("a list")
        .iter()
        .find(|token| token.name == "console")
        .expect("it")
        .id
        .clone();
    tokens.revoke(&id).expect("it is in force");
    assert!(tokens.revoke(&id).is_err(), "only once");
    std::thread::sleep(std::time::Duration::from_millis(2_100));
    assert_eq!(ask("POST", &events, &dispatch, booked), outcome(401, "V610"));
    assert_eq!(ask("DELETE", &day, &admin, "").0, 204);
}

#[test]
fn the_service_publishes_metrics() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    assert_eq!(service.decide(&day, &json!({"aircraft": "A01"})).status, 201);
    let text = service.get("/metrics").json;
    let text = text.as_str().expect("no JSON");
    for line in [
        r#"vertifleet_requests_total{method="POST",path="/v1/days/{day}/decisions",status="201"} 1"#,
        r#"vertifleet_decision_seconds_count{policy="greedy"} 1"#,
        "vertifleet_events_total 1",
        "vertifleet_commits_total 1",
        "vertifleet_days_in_memory 1",
    ] {
        assert!(text.contains(line), "{line} is not in {text}");
    }
}

#[test]
fn a_folder_belongs_to_one_service() {
    let (folder, _service) = service();
    let settings = settings_for(Location::Folder(folder.path().to_owned()));
    let second = vertifleet_serve::serve(&settings, |_| (), &Stop::default());
    assert_eq!(second.expect_err("the first one runs").code().to_string(), "V620");
}

#[test]
fn an_address_of_others_needs_protection_and_a_token() {
    let folder = tempfile::tempdir().expect("a folder");
    let listen = std::net::SocketAddr::from((std::net::Ipv4Addr::UNSPECIFIED, 0));
    let location = Location::Folder(folder.path().to_owned());
    for protection in [Protection::None, Protection::Proxy] {
        let settings = Settings { listen, protection, ..settings_for(location.clone()) };
        let refused = vertifleet_serve::serve(&settings, |_| (), &Stop::default());
        assert_eq!(refused.expect_err("there is no token").code().to_string(), "V619");
    }
}

#[test]
fn an_implausible_time_does_not_move_the_clock() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let events = format!("{day}/events");
    let ready = json!({"type": "ready", "aircraft": "A01", "time": "17:10:00"});
    let refused = service.post(&events, &ready);
    assert_eq!(refused.problem(), (422, "V604"));
    assert_eq!(service.state(&day)["now"], "06:00:00");
    let back = json!({"type": "delayed", "aircraft": "A01", "until": "05:00:00"});
    assert_eq!(service.post(&events, &back).status, 422);
    assert_eq!(service.post(&events, &json!({"type": "clock", "time": "17:00:00"})).status, 201);
    assert_eq!(service.post(&events, &ready).status, 201);
}

#[test]
fn an_aircraft_that_is_not_reported_is_overdue() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    assert_eq!(service.decide(&day, &json!({"aircraft": "A01"})).status, 201);
    assert_eq!(service.event(&day, &json!({"type": "clock", "time": "06:30:00"})).status, 201);
    let notices = service.state(&day)["notices"].clone();
    assert!(
        notices[0]["text"]
            .as_str()
            .is_some_and(|text| text.contains("should have departed at 06:00:00")),
        "{notices}"
    );
    let refused = service.get(&format!("{day}/aircraft/A01/decision")).json;
    assert!(text(&refused, "detail").contains("has not been reported departed"), "{refused}");
}

#[test]
fn a_proposal_for_later_does_not_change_the_current_prices() {
    let (_folder, service) = service();
    let (asked, plain) = (service.new_day("prices"), service.new_day("prices"));
    let proposal =
        |day: &str, query: &str| service.get(&format!("{day}/aircraft/A01/decision{query}")).json;
    assert_eq!(text(&proposal(&asked, "?time=16:00:00"), "time"), "16:00:00");
    assert_eq!(proposal(&asked, "")["alternatives"], proposal(&plain, "")["alternatives"]);
}

#[test]
fn a_repeated_answer_has_its_headers() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let key = [("idempotency-key", "one")];
    let body = br#"{"aircraft": "A01"}"#;
    let path = format!("{day}/decisions");
    let first = service.send("POST", &path, &key, body);
    let again = service.send("POST", &path, &key, body);
    assert_eq!((first.tag.as_str(), &first.json), ("\"1\"", &again.json));
    assert_eq!(again.tag, first.tag);
}

#[test]
fn each_token_has_its_own_keys_and_can_read_its_role() {
    let (_folder, location) = folder();
    let token = bearers(&location);
    let (one, two) = (token("one", Role::Dispatch), token("two", Role::Admin));
    let service = Running::start_at(location);
    let info = |bearer: &str| service.send("GET", "/v1", &[("authorization", bearer)], b"").json;
    assert_eq!((text(&info(&one), "token"), text(&info(&one), "role")), ("one", "dispatch"));
    assert_eq!(text(&info(&two), "role"), "admin");
    let make = |bearer: &str, seed: u64| {
        let body = json!({"network": "paper", "seed": seed}).to_string();
        let headers = [("authorization", bearer), ("idempotency-key", "1")];
        service.send("POST", "/v1/days", &headers, body.as_bytes())
    };
    assert_eq!((make(&one, 1).status, make(&two, 2).status), (201, 201));
    assert_eq!(text(&make(&one, 2).json, "code"), "V609");
}

#[test]
fn the_dashboard_and_the_alerts_use_existing_metrics() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    service.decide(&day, &json!({"aircraft": "A01"}));
    let measured = service.get("/metrics").json;
    let measured = measured.as_str().expect("a text");
    for file in ["grafana.json", "alerts.yml"] {
        let path = format!("{}/../../packaging/service/{file}", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("it is in the tree");
        let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        let names: std::collections::BTreeSet<&str> =
            words.filter(|word| word.starts_with("vertifleet_")).collect();
        assert!(names.len() >= 2, "{file} asks for {names:?}");
        for name in names {
            assert!(measured.contains(name), "{file} asks for {name}, which is not measured");
        }
    }
}

#[test]
fn no_client_may_set_the_policy_or_repeat_a_member() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let path = format!("{day}/events");
    for event in [
        r#"{"type": "decided", "aircraft": "A05", "to": "V2", "policy": "rolling"}"#,
        r#"{"type": "decided", "aircraft": "A05", "to": "V2", "instead_of": "V3"}"#,
        r#"{"type": "clock", "time": "06:00:00", "time": "07:00:00"}"#,
    ] {
        let refused = service.send("POST", &path, &[], event.as_bytes());
        assert_eq!(refused.problem(), (400, "V601"), "{event}");
    }
    for asked in ["state?foo=1", "events?aftr=1", "stream?aftr=1", "ledger?seq=1"] {
        assert_eq!(service.get(&format!("{day}/{asked}")).status, 400, "{asked}");
    }
    assert_eq!(service.get("/v1/days?lmit=1").status, 400);
}

#[test]
fn events_in_the_past_are_refused_and_forbidden_ones_have_a_notice() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let report = |event: Value| service.event(&day, &event);
    let notice = |answer: &crate::running::Answer| {
        answer.json["notices"][0][0]["text"].as_str().unwrap_or_default().to_owned()
    };
    assert_eq!(report(json!({"type": "clock", "time": "09:00:00"})).status, 201);
    let all = json!({"vertiport": "V1"});
    for past in [
        json!({"type": "closed", "routes": all, "until": "08:00:00"}),
        json!({"type": "out_of_service", "aircraft": "A09", "until": "08:00:00"}),
        json!({"type": "charging", "aircraft": "A09", "ready": "06:00:00"}),
    ] {
        let refused = report(past);
        assert_eq!(refused.problem(), (422, "V604"), "{refused:?}");
    }

    let state = service.state(&day);
    let to = if state["aircraft"][2]["place"] == "V1" { "V2" } else { "V1" };
    let departed = |aircraft: &str, time: &str| {
        report(json!({"type": "departed", "aircraft": aircraft, "to": to, "time": time}))
    };
    assert_eq!(report(json!({"type": "out_of_service", "aircraft": "A03"})).status, 201);
    assert!(notice(&departed("A03", "09:10:00")).contains("out of service"));
    let early = report(json!({"type": "landed", "aircraft": "A03", "time": "09:05:00"}));
    assert!(text(&early.json, "detail").contains("departed at 09:10:00"), "{early:?}");
    let charging = json!({"type": "charging", "aircraft": "A04", "ready": "09:40:00"});
    assert_eq!(report(charging).status, 201);
    let at = service.state(&day)["aircraft"][3]["place"].clone();
    let elsewhere = if at == "V3" { "V4" } else { "V3" };
    let left = report(json!({"type": "departed", "aircraft": "A04", "to": elsewhere}));
    assert!(notice(&left).contains("not ready before 09:40:00"), "{left:?}");
}

#[test]
fn the_ledger_adds_up_to_the_totals() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    for aircraft in ["A01", "A02", "A03"] {
        let taken = service.decide(&day, &json!({"aircraft": aircraft}));
        assert_eq!(taken.status, 201);
    }
    let landed = json!({"type": "landed", "aircraft": "A01", "time": "06:50:00"});
    assert_eq!(service.event(&day, &landed).status, 201);
    let ledger = service.get(&format!("{day}/ledger")).json;
    let flights = ledger["flights"].as_array().expect("a list");
    assert_eq!(
        flights.iter().map(|one| one["has_landed"] == true).collect::<Vec<_>>(),
        [true, false, false]
    );
    let sum: f64 = flights.iter().map(|one| one["profit_usd"].as_f64().expect("dollars")).sum();
    let total = ledger["totals"]["profit_usd"].as_f64().expect("dollars");
    assert!((sum - total).abs() < 0.01 && total > 0.0, "{ledger}");
    assert_eq!(ledger["totals"], service.state(&day)["totals"]);
}
