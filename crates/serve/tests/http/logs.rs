//! Damaged logs: events and days that are missing, and days that were restored from a copy.

use std::io::{BufRead as _, BufReader};
use std::path::Path;

use serde_json::json;
use sqlx::{AnyConnection, Connection as _, Executor as _};
use vertifleet_serve::{Keeper, Location, restore};

use crate::api::service;
use crate::running::Running;

/// Changes the database without the service.
fn tamper(folder: &Path, statement: &'static str) {
    sqlx::any::install_default_drivers();
    let url = format!("sqlite://{}", folder.join("vertifleet.db").display());
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    runtime.expect("a runtime").block_on(async {
        let mut database = AnyConnection::connect(&url).await.expect("the database");
        let done = database.execute(statement).await.expect("a statement");
        assert!(done.rows_affected() > 0, "{statement}");
        database.close().await.expect("it is closed");
    });
}

/// The findings of `serve verify` about the data in a folder.
fn findings(folder: &Path) -> Vec<String> {
    let keeper = Keeper::open(&Location::Folder(folder.to_owned())).expect("data");
    let mut findings = Vec::new();
    keeper.verify(|check| findings.extend(check.finding)).expect("it can be read");
    findings
}

fn book(service: &Running, day: &str, passengers: u32) {
    let event = json!({"type": "booked", "period": "07:00:00", "from": "V1", "to": "V2", "passengers": passengers});
    assert_eq!(service.event(day, &event).status, 201);
}

#[test]
fn events_and_days_that_are_missing_are_found() {
    let (folder, service) = service();
    let day = service.new_day("greedy");
    for passengers in 1..=3 {
        book(&service, &day, passengers);
    }
    let deleted = service.new_day("greedy");
    assert_eq!(service.send("DELETE", &deleted, &[], b"").status, 204);
    drop(service);
    assert_eq!(findings(folder.path()), Vec::<String>::new());
    tamper(folder.path(), "DELETE FROM events WHERE seq = 3");
    assert_eq!(findings(folder.path()), ["event 3 is missing; the last event is 3"]);
    let service = Running::start(folder.path());
    let refused = service.get(&format!("{day}/state"));
    assert_eq!(refused.problem(), (500, "V607"));
    drop(service);
    tamper(folder.path(), "UPDATE days SET seq = 2");
    let [finding] = &findings(folder.path())[..] else { panic!("one finding") };
    assert!(finding.contains("differs from the day's"), "{finding}");
    tamper(folder.path(), "DELETE FROM days");
    assert_eq!(findings(folder.path()), ["the day is missing, and no deletion is recorded"]);
    tamper(folder.path(), "DELETE FROM events");
    assert_eq!(findings(folder.path()), ["the day is missing, and no deletion is recorded"]);
}

#[test]
fn a_stream_does_not_go_on_in_another_log() {
    let folder = tempfile::tempdir().expect("a folder");
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    let copy = folder.path().join("copy.db");
    let marks = |service: &Running, day: &str| -> Vec<String> {
        let events = service.get(&format!("{day}/events")).json["events"].clone();
        let mark = |event: &serde_json::Value| event["mark"].as_str().expect("a mark").to_owned();
        events.as_array().expect("a list").iter().map(mark).collect()
    };
    let service = Running::start(&first);
    let day = service.new_day("greedy");
    book(&service, &day, 1);
    Keeper::open(&Location::Folder(first.clone())).expect("data").backup(&copy).expect("a copy");
    book(&service, &day, 2);
    let before = marks(&service, &day);
    drop(service);

    restore(&copy, &second).expect("a sound copy");
    let service = Running::start(&second);
    let after = |mark: &str| {
        let stream = format!("{day}/stream");
        let refused = service.send("GET", &stream, &[("last-event-id", mark)], b"");
        (refused.status, refused.json["code"].clone())
    };
    assert_eq!(after(&before[1]), (404, json!("V631")), "the copy is older");
    book(&service, &day, 3);
    assert_eq!(after(&before[1]), (404, json!("V631")), "another event has the number");
    let now = marks(&service, &day);
    assert_eq!((before.len(), now.len()), (2, 2));
    assert!(before[0] == now[0] && before[1] != now[1], "{before:?} {now:?}");
    let request = ureq::get(format!("{}{day}/stream", service.url));
    let answer = request.header("last-event-id", &now[0]).call().expect("a stream");
    let mut lines = BufReader::new(answer.into_body().into_reader()).lines();
    assert_eq!(lines.next().expect("a line").expect("text"), "id: 2");
}
