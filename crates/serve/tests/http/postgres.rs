//! Two services that share a `PostgreSQL` database.

use std::collections::BTreeSet;
use std::io::{BufRead as _, BufReader};
use std::sync::Barrier;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::json;
use vertifleet_serve::Location;
use vertifleet_testkit::Postgres;

use crate::operated_days::{day, operated, simulated};
use crate::running::Running;

fn location(database: &Postgres) -> Location {
    Location::Postgres(database.url())
}

/// Sends an event with a mark, which is also its key, until it is acknowledged.
fn write(service: &Running, path: &str, mark: &str) {
    let body = json!({"type": "out_of_service", "aircraft": "A40", "reason": mark}).to_string();
    let begun = Instant::now();
    loop {
        let headers = [("idempotency-key", mark)];
        let answer = service.send("POST", &format!("{path}/events"), &headers, body.as_bytes());
        if answer.status == 201 {
            return;
        }
        let is_early = begun.elapsed() < Duration::from_secs(30);
        assert!(matches!(answer.status, 409 | 503) && is_early, "{answer:?}");
        thread::sleep(Duration::from_millis(20));
    }
}

/// The marks of all events of a day, in order.
fn marks(service: &Running, path: &str) -> Vec<String> {
    let events = service.get(&format!("{path}/events?limit=10000")).json;
    let events = events["events"].as_array().expect("a list");
    events.iter().filter_map(|one| one["event"]["reason"].as_str().map(str::to_owned)).collect()
}

#[test]
fn two_services_share_a_database() {
    let database = Postgres::start();
    let one = Running::start_at(location(&database));
    let two = Running::start_at(location(&database));
    // A whole day through one of them.
    let paper = day("paper", 2_002);
    assert_eq!(operated(&one, &paper, "greedy").totals, simulated(&paper, "greedy"));
    // Both write to one day, and each returns the other's events.
    let path = one.new_day("greedy");
    let decide =
        |service: &Running, aircraft: &str| service.decide(&path, &json!({"aircraft": aircraft}));
    assert_eq!(decide(&one, "A01").status, 201);
    assert_eq!(decide(&two, "A02").json["seq"], 2);
    assert_eq!(one.get(&path).json["seq"], 2);
    assert_eq!(decide(&two, "A01").status, 422, "it has been sent off through the other service");
    assert_eq!(one.get(&format!("{path}/state")).json, two.get(&format!("{path}/state")).json);
    // They write at the same time: every event is there once.
    thread::scope(|scope| {
        for (number, service) in [&one, &two, &one, &two].into_iter().enumerate() {
            let path = &path;
            scope.spawn(move || {
                for event in 0..25 {
                    write(service, path, &format!("{number}-{event}"));
                }
            });
        }
    });
    let marks: BTreeSet<String> = marks(&two, &path).into_iter().collect();
    assert_eq!((marks.len(), one.get(&path).json["seq"].as_u64()), (100, Some(102)));
}

/// An event that clients send repeatedly, without any difference.
const BOOKED: &[u8] =
    br#"{"type": "booked", "period": "07:00:00", "from": "V1", "to": "V2", "passengers": 1}"#;

/// Sends an event that equals many others. Returns its number; `None` if another service was
/// quicker.
fn book(service: &Running, path: &str, key: Option<&str>) -> Option<u64> {
    let headers: Vec<_> = key.map(|key| ("idempotency-key", key)).into_iter().collect();
    let answer = service.send("POST", &format!("{path}/events"), &headers, BOOKED);
    assert!(matches!(answer.status, 201 | 409), "{answer:?}");
    answer.json["seq"].as_u64()
}

#[test]
fn equal_events_that_reach_two_services_at_once_are_all_stored() {
    const CLIENTS: usize = 4;
    const EVENTS: usize = 50;
    let database = Postgres::start();
    let services = [(); 2].map(|()| Running::start_at(location(&database)));
    let path = services[0].new_day("greedy");
    let start = Barrier::new(CLIENTS);
    // The clients of each service send their events with keys and without.
    let write = |client: usize| {
        let mut acknowledged = Vec::new();
        for number in 0..EVENTS {
            let key = (client >= 2).then(|| format!("{client}-{number}"));
            start.wait();
            if let Some(seq) = book(&services[client % 2], &path, key.as_deref()) {
                acknowledged.push((key, seq));
            }
        }
        acknowledged
    };
    let acknowledged: Vec<(Option<String>, u64)> = thread::scope(|scope| {
        let clients: Vec<_> = (0..CLIENTS)
            .map(|client| {
                let write = &write;
                scope.spawn(move || write(client))
            })
            .collect();
        clients.into_iter().flat_map(|client| client.join().expect("it writes")).collect()
    });
    let numbers: BTreeSet<u64> = acknowledged.iter().map(|(_, seq)| *seq).collect();
    assert!(numbers.len() > CLIENTS * EVENTS / 2, "{} events", numbers.len());
    assert_eq!(numbers.len(), acknowledged.len(), "no two answers name the same event");
    let stored = numbers.len() as u64;
    for service in &services {
        assert_eq!(service.get(&path).json["seq"], stored, "what was acknowledged is stored");
        for (key, seq) in acknowledged.iter().filter(|(key, _)| key.is_some()) {
            assert_eq!(book(service, &path, key.as_deref()), Some(*seq), "its key is known");
        }
        assert_eq!(service.get(&path).json["seq"], stored, "nothing is stored again");
    }
}

#[test]
fn a_new_day_that_is_asked_for_at_two_services_with_one_key_is_made_once() {
    let database = Postgres::start();
    let services = [(); 2].map(|()| Running::start_at(location(&database)));
    let (start, body) =
        (Barrier::new(2), json!({"network": "paper", "policy": "greedy"}).to_string());
    for number in 0..10 {
        let key = format!("key-{number}");
        let make = |service: &Running| {
            service.send("POST", "/v1/days", &[("idempotency-key", &key)], body.as_bytes())
        };
        let together = |service: &Running| {
            start.wait();
            make(service)
        };
        let answers = thread::scope(|scope| {
            let others = scope.spawn(|| together(&services[1]));
            [together(&services[0]), others.join().expect("it is answered")]
        });
        assert!(answers.iter().all(|answer| matches!(answer.status, 201 | 409)), "{answers:?}");
        // A repeated request gets the answer with the existing day.
        let [one, other] = services.each_ref().map(|service| make(service).json["id"].clone());
        assert!(one.is_string() && one == other, "{one} {other}");
        let days = services[0].get("/v1/days").json["days"].as_array().expect("a list").len();
        assert_eq!(days, number + 1);
    }
}

#[test]
fn of_two_writers_who_expect_the_same_event_one_is_refused() {
    let database = Postgres::start();
    let services = [(); 2].map(|()| Running::start_at(location(&database)));
    let path = services[0].new_day("greedy");
    let start = Barrier::new(2);
    for seq in 0..40_u64 {
        let write = |service: &Running| {
            let expected = seq.to_string();
            start.wait();
            service.send("POST", &format!("{path}/events"), &[("if-match", &expected)], BOOKED)
        };
        let answers = thread::scope(|scope| {
            let others = scope.spawn(|| write(&services[1]));
            [write(&services[0]), others.join().expect("it is answered")]
        });
        let mut statuses = answers.each_ref().map(|answer| answer.status);
        statuses.sort_unstable();
        assert_eq!(statuses, [201, 412], "{answers:?}");
        let refused = answers.iter().find(|answer| answer.status == 412).expect("one of them");
        assert_eq!(refused.json["code"], "V605");
    }
}

#[test]
fn changes_by_one_service_reach_the_other() {
    let database = Postgres::start();
    let [one, two] = [(); 2].map(|()| Running::start_at(location(&database)));
    let path = one.new_day("greedy");
    // The other service has the day in memory, and readers of its stream.
    let answer = ureq::get(format!("{}{path}/stream", two.url)).call().expect("a stream");
    let mut lines = BufReader::new(answer.into_body().into_reader()).lines();
    let mut next = || loop {
        let line = lines.next()?.ok()?;
        if line.starts_with("id: ") {
            return Some(line);
        }
    };
    let begun = Instant::now();
    assert_eq!(one.send("POST", &format!("{path}/events"), &[], BOOKED).status, 201);
    assert_eq!(next().as_deref(), Some("id: 1"));
    assert!(begun.elapsed() < Duration::from_secs(1), "it was told, and did not have to look");
    assert_eq!(one.send("POST", &format!("{path}/archive"), &[], b"").status, 204);
    assert_eq!(two.get(&path).json["archived"], true);
    let refused = two.send("POST", &format!("{path}/events"), &[], BOOKED);
    assert_eq!(refused.problem(), (409, "V608"));
    assert_eq!(one.send("POST", &format!("{path}/unarchive"), &[], b"").status, 204);
    assert_eq!(two.send("POST", &format!("{path}/events"), &[], BOOKED).status, 201);
    assert_eq!(next().as_deref(), Some("id: 2"));
    assert_eq!(one.send("DELETE", &path, &[], b"").status, 204);
    for what in ["", "/state", "/events", "/outlook", "/trace.csv"] {
        assert_eq!(two.get(&format!("{path}{what}")).status, 404, "{what}");
    }
    assert_eq!(next(), None, "its stream ends");
}

#[test]
fn services_that_start_together_make_the_tables_once() {
    for _ in 0..3 {
        let database = Postgres::start();
        thread::scope(|scope| {
            let start = || Running::start_at(location(&database));
            let services: Vec<_> = (0..8).map(|_| scope.spawn(start)).collect();
            for service in services {
                let service = service.join().expect("it starts");
                assert_eq!(service.get("/readyz").status, 200);
            }
        });
    }
}

/// Has four clients write to a day of two services while something happens to the database. Each
/// client sends its next event once the last one is stored. Checks that every acknowledged event is
/// stored once and in order.
fn check_writes(services: &[Running; 2], during: impl FnOnce(&str)) {
    let path = services[0].new_day("greedy");
    let stop = AtomicBool::new(false);
    let acknowledged: Vec<Vec<String>> = thread::scope(|scope| {
        let clients: Vec<_> = (0..4)
            .map(|client| {
                let (service, path, stop) = (&services[client % 2], &path, &stop);
                scope.spawn(move || {
                    let mut sent = Vec::new();
                    while !stop.load(Ordering::Relaxed) {
                        let mark = format!("{client}-{}", sent.len());
                        write(service, path, &mark);
                        sent.push(mark);
                    }
                    sent
                })
            })
            .collect();
        thread::sleep(Duration::from_millis(500));
        during(&path);
        thread::sleep(Duration::from_millis(500));
        stop.store(true, Ordering::Relaxed);
        clients.into_iter().map(|client| client.join().expect("it writes")).collect()
    });
    let stored = marks(&services[0], &path);
    for (client, acknowledged) in acknowledged.iter().enumerate() {
        let prefix = format!("{client}-");
        let of_client: Vec<&String> =
            stored.iter().filter(|mark| mark.starts_with(&prefix)).collect();
        assert!(!acknowledged.is_empty(), "client {client} never got through");
        assert!(of_client.into_iter().eq(acknowledged), "client {client}: once, and in order");
    }
    assert_eq!(marks(&services[1], &path), stored);
}

#[test]
fn a_database_crash_loses_no_acknowledged_event() {
    let mut database = Postgres::start();
    let services = [(); 2].map(|()| Running::start_at(location(&database)));
    check_writes(&services, |_| {
        for _ in 0..3 {
            database.crash();
            thread::sleep(Duration::from_millis(200));
            database.resume();
            thread::sleep(Duration::from_millis(500));
        }
    });
}

#[test]
fn a_hanging_database_is_reported_and_loses_no_acknowledged_event() {
    let database = Postgres::start();
    let services = [(); 2].map(|()| Running::start_at(location(&database)));
    check_writes(&services, |path| {
        database.freeze();
        for path in [path, "/readyz", "/v1/days"] {
            let begun = Instant::now();
            let answer = services[0].get(path);
            assert_eq!(answer.problem(), (503, "V606"), "{path}");
            assert!(begun.elapsed() < Duration::from_secs(10), "{path}: {:?}", begun.elapsed());
        }
        database.thaw();
    });
}
