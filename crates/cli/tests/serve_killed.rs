//! The service is killed again and again while clients write. Every event that it acknowledged is there afterwards, once
//! and in its order.
//!
//! `VERTIFLEET_KILLS` sets the number of kills, for long runs (`make soak`).

#![cfg(unix)]

use std::collections::BTreeMap;
use std::io::{BufRead as _, BufReader};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use serde_json::{Value, json};

/// Clients that write at the same time, each its own events.
const CLIENTS: usize = 4;
/// Days that they write to by turns.
const DAYS: usize = 2;

fn kills() -> u32 {
    std::env::var("VERTIFLEET_KILLS").ok().and_then(|kills| kills.parse().ok()).unwrap_or(8)
}

/// Starts the service and waits until it listens.
fn start(data: &Path, port: u16) -> Child {
    let mut child = Command::new(assert_cmd::cargo::cargo_bin!("vertifleet"))
        .args(["serve", "--listen", &format!("127.0.0.1:{port}"), "--data"])
        .arg(data)
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut lines = BufReader::new(child.stderr.take().expect("a pipe")).lines();
    let first = lines.next().expect("a line").expect("text");
    assert!(first.starts_with("listening on"), "{first}");
    // What it says later must not fill the pipe.
    thread::spawn(move || lines.for_each(drop));
    child
}

fn agent() -> ureq::Agent {
    let config = ureq::Agent::config_builder()
        .http_status_as_error(false)
        .timeout_global(Some(Duration::from_secs(5)))
        .build();
    config.into()
}

fn post(agent: &ureq::Agent, url: &str, key: &str, body: &Value) -> Option<Value> {
    let request = agent.post(url).header("idempotency-key", key);
    let mut answer = request.send(body.to_string().as_bytes()).ok()?;
    let text = answer.body_mut().read_to_vec().ok()?;
    let status = answer.status().as_u16();
    assert!(
        status == 201 || status == 409 || status == 503,
        "{status} {}",
        String::from_utf8_lossy(&text)
    );
    (status == 201).then(|| serde_json::from_slice(&text).expect("JSON"))
}

/// Writes events, each with a mark of its own, until it is told to stop. A request without an answer is sent again with
/// its key, as a client should. Returns the number that each mark was acknowledged with.
fn write(client: usize, days: &[String], stop: &AtomicBool) -> Vec<(usize, u64, String)> {
    let agent = agent();
    let mut acknowledged = Vec::new();
    for number in 0.. {
        let (day, mark) = (number % days.len(), format!("{client}-{number}"));
        let aircraft = format!("A{:02}", client + 1);
        let body = json!({"type": "out_of_service", "aircraft": aircraft, "reason": mark});
        loop {
            if stop.load(Ordering::Relaxed) {
                return acknowledged;
            }
            if let Some(answer) = post(&agent, &format!("{}/events", days[day]), &mark, &body) {
                let seq = answer["seq"].as_u64().expect("a number");
                acknowledged.push((day, seq, mark));
                break;
            }
            thread::sleep(Duration::from_millis(5));
        }
    }
    acknowledged
}

/// The marks of all events of a day, by their numbers.
fn marks(agent: &ureq::Agent, day: &str) -> BTreeMap<u64, String> {
    let mut marks = BTreeMap::new();
    let mut after = 0;
    loop {
        let mut answer =
            agent.get(format!("{day}/events?after={after}")).call().expect("an answer");
        let page: Value = serde_json::from_slice(&answer.body_mut().read_to_vec().expect("a body"))
            .expect("JSON");
        for event in page["events"].as_array().expect("a list") {
            let mark = event["event"]["reason"].as_str().expect("a mark").to_owned();
            marks.insert(event["seq"].as_u64().expect("a number"), mark);
        }
        match page["next"].as_u64() {
            Some(next) => after = next,
            None => return marks,
        }
    }
}

#[test]
fn no_acknowledged_event_is_lost_when_the_service_is_killed() {
    let folder = tempfile::tempdir().expect("a folder");
    let port = TcpListener::bind("127.0.0.1:0")
        .and_then(|socket| socket.local_addr())
        .expect("a port")
        .port();
    let url = format!("http://127.0.0.1:{port}/v1/days");
    let mut service = start(folder.path(), port);
    let agent = agent();
    let new_day = |number: usize| {
        let made = post(
            &agent,
            &url,
            &format!("day {number}"),
            &json!({"network": "paper", "policy": "greedy"}),
        );
        format!("{url}/{}", made.expect("a day")["id"].as_str().expect("an id"))
    };
    let days: Vec<String> = (0..DAYS).map(new_day).collect();
    let stop = AtomicBool::new(false);
    let acknowledged: Vec<Vec<(usize, u64, String)>> = thread::scope(|scope| {
        let clients: Vec<_> = (0..CLIENTS)
            .map(|client| {
                scope.spawn({
                    let (days, stop) = (&days, &stop);
                    move || write(client, days, stop)
                })
            })
            .collect();
        for kill in 0..kills() {
            thread::sleep(Duration::from_millis(u64::from(50 + kill * 37 % 200)));
            service.kill().expect("kill -9");
            service.wait().expect("it is dead");
            service = start(folder.path(), port);
        }
        thread::sleep(Duration::from_millis(200));
        stop.store(true, Ordering::Relaxed);
        clients.into_iter().map(|client| client.join().expect("a client")).collect()
    });
    let stored: Vec<BTreeMap<u64, String>> = days.iter().map(|day| marks(&agent, day)).collect();
    let count: usize = acknowledged.iter().map(Vec::len).sum();
    assert!(count > 100, "{count} events were acknowledged");
    for (day, seq, mark) in acknowledged.iter().flatten() {
        assert_eq!(stored[*day].get(seq), Some(mark), "event {seq} of day {day}");
    }
    for marks in &stored {
        assert!(marks.keys().copied().eq(1..=marks.len() as u64), "no number is missing");
        for client in 0..CLIENTS {
            let numbers: Vec<u32> = marks
                .values()
                .filter_map(|mark| mark.strip_prefix(&format!("{client}-")))
                .map(|number| number.parse().expect("a number"))
                .collect();
            assert!(
                numbers.is_sorted_by(|one, next| one < next),
                "in order, and none twice: {numbers:?}"
            );
        }
    }
    // Beside what was acknowledged there is at most the last request of each client.
    let extra = stored.iter().map(BTreeMap::len).sum::<usize>() - count;
    assert!(extra <= CLIENTS, "{extra} events were stored and never acknowledged");
    service.kill().expect("kill -9");
    service.wait().expect("it is dead");
    eprintln!("{} kills, {count} events acknowledged, none lost", kills());
}
