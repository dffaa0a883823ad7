//! Archives, reopens and deletes days, each at the event that the client expects.

use std::io::{BufRead as _, BufReader};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use serde_json::{Value, json};
use vertifleet_serve::{Location, Role};

use crate::api::service;
use crate::running::{Answer, Running, bearers, folder};

fn clock(service: &Running, day: &str) -> Answer {
    service.event(day, &json!({"type": "clock"}))
}

fn change(service: &Running, method: &str, path: &str, if_match: &str) -> (u16, Value) {
    let headers = [("if-match", if_match)];
    let answer = service.send(method, path, &headers[..usize::from(!if_match.is_empty())], b"");
    let code = answer.json.get("code").cloned().unwrap_or_default();
    (answer.status, code)
}

#[test]
fn a_day_that_has_changed_is_not_archived_and_not_deleted() {
    let (_folder, service) = service();
    let day = service.new_day("greedy");
    let moved = (412, json!("V605"));
    let done = (204, Value::Null);
    let archive = format!("{day}/archive");
    assert_eq!(clock(&service, &day).status, 201);
    for (method, path) in [("POST", &archive), ("DELETE", &day)] {
        for other in ["0", "\"0\"", "2"] {
            assert_eq!(change(&service, method, path, other), moved, "{method} {other}");
        }
        assert_eq!(change(&service, method, path, "soon"), (400, json!("V601")));
    }
    let info = service.get(&day);
    assert_eq!((&info.json["archived"], info.tag.as_str()), (&json!(false), "\"1\""));
    assert_eq!(change(&service, "POST", &archive, "\"1\""), done);
    assert_eq!(change(&service, "POST", &archive, "\"1\""), done, "it is archived already");
    assert_eq!(change(&service, "POST", &format!("{day}/unarchive"), "0"), moved);
    assert_eq!(change(&service, "DELETE", &day, "0"), moved);
    assert_eq!(change(&service, "DELETE", &day, "1"), done);
    assert_eq!(service.get(&day).status, 404);
    for (method, path) in [("POST", archive), ("DELETE", day)] {
        assert_eq!(change(&service, method, &path, "1"), (404, json!("V602")));
    }
}

#[test]
fn a_reopened_day_continues_in_its_former_state() {
    let (folder, service) = service();
    let day = service.new_day("greedy");
    assert_eq!(clock(&service, &day).status, 201);
    let answer = ureq::get(format!("{}{day}/stream", service.url)).call().expect("a stream");
    let mut stream = BufReader::new(answer.into_body().into_reader());
    let mut next = || loop {
        let mut line = String::new();
        assert!(stream.read_line(&mut line).expect("the stream goes on") > 0, "it ended");
        if let Some(number) = line.strip_prefix("id: ") {
            return number.trim().parse::<u64>().expect("a number");
        }
    };
    assert_eq!(next(), 1);
    assert_eq!(change(&service, "POST", &format!("{day}/archive"), "").0, 204);
    let refused = clock(&service, &day);
    assert_eq!(refused.problem(), (409, "V608"));
    assert!(refused.json["hint"].as_str().is_some_and(|hint| hint.contains("/unarchive")));
    for _ in 0..2 {
        assert_eq!(change(&service, "POST", &format!("{day}/unarchive"), "1").0, 204);
        assert_eq!(service.get(&day).json["archived"], json!(false));
    }
    let taken = clock(&service, &day);
    assert_eq!((taken.status, &taken.json["seq"]), (201, &json!(2)));
    assert_eq!(next(), 2, "readers of the stream go on reading");
    drop(service);
    let service = Running::start(folder.path());
    assert_eq!(service.get(&day).json["archived"], json!(false));
    assert_eq!(clock(&service, &day).json["seq"], json!(3));
}

#[test]
fn an_archived_day_accepts_no_writes() {
    let (_folder, service) = service();
    for _ in 0..5 {
        let day = service.new_day("greedy");
        let is_over = AtomicBool::new(false);
        let acknowledged = thread::scope(|scope| {
            let writers: Vec<_> = (0..4)
                .map(|_| {
                    scope.spawn(|| {
                        let mut last = 0;
                        while !is_over.load(Ordering::Relaxed) {
                            let answer = clock(&service, &day);
                            match answer.status {
                                201 => last = answer.json["seq"].as_u64().expect("a number"),
                                409 => assert_eq!(answer.json["code"], "V608", "{answer:?}"),
                                _ => panic!("{answer:?}"),
                            }
                        }
                        last
                    })
                })
                .collect();
            thread::sleep(Duration::from_millis(50));
            assert_eq!(change(&service, "POST", &format!("{day}/archive"), "").0, 204);
            let archived_at = service.get(&day).json["seq"].as_u64().expect("a number");
            thread::sleep(Duration::from_millis(50));
            is_over.store(true, Ordering::Relaxed);
            let last = writers.into_iter().map(|writer| writer.join().expect("it writes"));
            let last = last.max().expect("writers");
            assert_eq!(archived_at, last, "what was acknowledged is there, and nothing else");
            last
        });
        let events = service.get(&format!("{day}/events?limit=10000")).json;
        assert_eq!(events["events"].as_array().map(Vec::len), usize::try_from(acknowledged).ok());
    }
}

#[test]
fn only_admins_reopen_days() {
    let (_folder, location) = folder();
    let token = bearers(&location);
    let (dispatch, admin) = (token("one", Role::Dispatch), token("two", Role::Admin));
    let service = Running::start_at(location);
    let send = |bearer: &str, path: &str| {
        service.send("POST", path, &[("authorization", bearer)], br#"{"network": "paper"}"#)
    };
    let day = send(&dispatch, "/v1/days").made("/v1/days");
    for path in [format!("{day}/archive"), format!("{day}/unarchive")] {
        let refused = send(&dispatch, &path);
        assert_eq!(refused.problem(), (403, "V618"), "{path}");
        assert_eq!(send(&admin, &path).status, 204, "{path}");
    }
}

#[cfg(unix)]
#[test]
fn services_that_share_a_database_agree_on_archived_days() {
    let database = vertifleet_testkit::Postgres::start();
    let location = Location::Postgres(database.url());
    let (one, two) = (Running::start_at(location.clone()), Running::start_at(location));
    let day = one.new_day("greedy");
    assert_eq!(clock(&one, &day).status, 201);
    assert_eq!(clock(&two, &day).status, 201);
    // The other service may not have received the change yet.
    assert_eq!(change(&one, "POST", &format!("{day}/archive"), "1"), (412, json!("V605")));
    assert_eq!(change(&one, "POST", &format!("{day}/archive"), "2").0, 204);
    assert_eq!(clock(&two, &day).json["code"], "V608");
    assert_eq!(two.get(&day).json["archived"], json!(true));
    assert_eq!(change(&one, "POST", &format!("{day}/unarchive"), "2").0, 204);
    assert_eq!(two.get(&day).json["archived"], json!(false));
    assert_eq!(clock(&two, &day).json["seq"], json!(3));
    assert_eq!(change(&two, "DELETE", &day, "2"), (412, json!("V605")));
    assert_eq!(change(&two, "DELETE", &day, "3").0, 204);
    assert_eq!(clock(&one, &day).status, 404);
}
