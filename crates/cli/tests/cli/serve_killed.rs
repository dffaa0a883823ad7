//! The service is killed again and again while clients write. Afterwards, every acknowledged event
//! must exist once and in order: with the data in a folder, with the data in `PostgreSQL` that two
//! instances share, and in a folder where writing fails at random moments too. Half of the events
//! are equal in every respect, and all clients send them.
//!
//! `VERTIFLEET_KILLS` sets the number of kills of each test, for long runs (`make soak`).

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::thread;
use std::time::Duration;

use crate::service::Service;
use serde_json::{Value, json};
use vertifleet_testkit::{Postgres, draw};

/// Clients that write at the same time, each its own events.
const CLIENTS: usize = 4;
/// The networks of the days that they write to in turn, and two vertiports of each.
const DAYS: [(&str, [&str; 2]); 3] =
    [("paper", ["V1", "V2"]), ("paper-quick", ["V1", "V2"]), ("new-york-quick", ["JFK", "LGA"])];
/// Number of kills after which all events are checked, and new days begin: reading long days again
/// after each kill would take most of the time.
const KILLS_OF_A_ROUND: u32 = 50;

fn kills() -> u32 {
    std::env::var("VERTIFLEET_KILLS").ok().and_then(|kills| kills.parse().ok()).unwrap_or(8)
}

fn milliseconds(number: usize) -> Duration {
    Duration::from_millis(number as u64)
}

/// A service that is killed again and again.
struct Trial<'a> {
    /// The name of the trial in messages.
    name: &'static str,
    /// The location of its data, as an argument of the program.
    data: [&'a str; 2],
    /// Instances that run at the same time. One of them is killed at a time, in turn.
    instances: usize,
    /// The state of the service between two kills.
    meanwhile: fn(&Service, kill: u32, Duration),
}

/// The answers that clients received.
#[derive(Debug, Default)]
struct Outcome {
    acknowledged: usize,
    /// Requests that were answered 503.
    refused: AtomicU32,
}

/// A client that sends a request with a key again until it is acknowledged, as a client should. It
/// returns `None` if it was stopped before.
struct Client<'a> {
    agent: ureq::Agent,
    stop: &'a AtomicBool,
    refused: &'a AtomicU32,
}

/// The mark of the identical events that all clients send.
const EQUAL: &str = "equal";

fn booked(day: usize) -> Value {
    let (_, [from, to]) = DAYS[day];
    json!({"type": "booked", "period": "07:00:00", "from": from, "to": to, "passengers": 1})
}

/// An event that was acknowledged: its day, its number, and its mark.
type Acknowledged = (usize, u64, String);

impl Client<'_> {
    /// Sends a request to the first of these instances, and again to the next ones until it is
    /// acknowledged.
    fn post(&self, instances: &[&str], path: &str, key: &str, body: &Value) -> Option<Value> {
        for address in instances.iter().cycle() {
            if self.stop.load(Ordering::Relaxed) {
                break;
            }
            if let Some(answer) = self.try_once(&format!("http://{address}{path}"), key, body) {
                return Some(answer);
            }
            thread::sleep(Duration::from_millis(5));
        }
        None
    }

    fn try_once(&self, url: &str, key: &str, body: &Value) -> Option<Value> {
        let request = self.agent.post(url).header("idempotency-key", key);
        let mut answer = request.send(body.to_string().as_bytes()).ok()?;
        let text = answer.body_mut().read_to_vec().ok()?;
        match answer.status().as_u16() {
            201 => return Some(serde_json::from_slice(&text).expect("JSON")),
            409 => {}
            503 => drop(self.refused.fetch_add(1, Ordering::Relaxed)),
            status => panic!("{status} {}", String::from_utf8_lossy(&text)),
        }
        None
    }

    /// Writes events until it is stopped: in turn one with a unique mark, and one that all clients
    /// send.
    fn write(&self, client: usize, instances: &[&str], days: &[String]) -> Vec<Acknowledged> {
        let mut acknowledged = Vec::new();
        for number in 0.. {
            let (at, mark) = (number / 2 % days.len(), format!("{client}-{number}"));
            let key = format!("{mark} of {}", days[0]);
            let aircraft = format!("A{:02}", client + 1);
            let (mark, body) = if number % 2 == 0 {
                (EQUAL.to_owned(), booked(at))
            } else {
                let kind = "out_of_service";
                let body = json!({"type": kind, "aircraft": aircraft, "reason": mark});
                (mark, body)
            };
            let path = format!("{}/events", days[at]);
            let Some(answer) = self.post(instances, &path, &key, &body) else { break };
            acknowledged.push((at, answer["seq"].as_u64().expect("a number"), mark));
        }
        acknowledged
    }
}

fn agent() -> ureq::Agent {
    let config = ureq::Agent::config_builder()
        .http_status_as_error(false)
        .timeout_global(Some(Duration::from_secs(5)))
        .build();
    config.into()
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
            let mark = event["event"]["reason"].as_str().unwrap_or(EQUAL).to_owned();
            marks.insert(event["seq"].as_u64().expect("a number"), mark);
        }
        match page["next"].as_u64() {
            Some(next) => after = next,
            None => return marks,
        }
    }
}

impl Trial<'_> {
    fn start(&self, listen: &str) -> Result<Service, String> {
        Service::start(Service::command(listen).args(self.data))
    }

    /// Kills one instance after the other, and starts each again at the same address.
    ///
    /// # Errors
    /// Returns what went wrong if an instance ended before it was killed, or does not start.
    fn kill(&self, services: &mut [Service], kills: std::ops::Range<u32>) -> Result<(), String> {
        let count = services.len();
        for kill in kills {
            let service = &mut services[kill as usize % count];
            (self.meanwhile)(service, kill, milliseconds(50 + draw(kill, 0) % 200));
            if let Some(status) = service.child.try_wait().expect("a child") {
                return Err(format!("before kill {kill} it ended without a kill: {status}"));
            }
            service.child.kill().expect("kill -9");
            service.child.wait().expect("it is dead");
            *service = self.start(&service.address)?;
        }
        thread::sleep(Duration::from_millis(200));
        Ok(())
    }

    /// Kills instances while each client writes to its own days.
    fn round(&self, services: &mut [Service], kills: std::ops::Range<u32>, outcome: &mut Outcome) {
        let addresses: Vec<String> =
            services.iter().map(|service| service.address.clone()).collect();
        // Each client begins with another instance.
        let instances = |client: usize| -> Vec<&str> {
            let later = addresses.iter().cycle().skip(client % addresses.len());
            later.take(addresses.len()).map(String::as_str).collect()
        };
        let (stop, refused) = (AtomicBool::new(false), &outcome.refused);
        let client = || Client { agent: agent(), stop: &stop, refused };
        let new_day = |(number, (network, _)): (usize, (&str, _))| {
            let body = json!({"network": network, "policy": "greedy"});
            let key = format!("day {number} of kill {}", kills.start);
            let made = client().post(&instances(0), "/v1/days", &key, &body);
            let made = made.expect("the trial has not stopped yet");
            format!("/v1/days/{}", made["id"].as_str().expect("an id"))
        };
        let days: Vec<String> = DAYS.into_iter().enumerate().map(new_day).collect();
        let acknowledged: Vec<Vec<Acknowledged>> = thread::scope(|scope| {
            let write = |number| {
                let (client, instances, days) = (client(), instances(number), &days);
                scope.spawn(move || client.write(number, &instances, days))
            };
            let clients: Vec<_> = (0..CLIENTS).map(write).collect();
            let killed = self.kill(services, kills);
            // This must come before anything can panic, or the clients would never end.
            stop.store(true, Ordering::Relaxed);
            killed.expect("it lives until it is killed, and starts again");
            clients.into_iter().map(|client| client.join().expect("a client")).collect()
        });
        for address in &addresses {
            let day = |path: &String| marks(&agent(), &format!("http://{address}{path}"));
            let stored: Vec<_> = days.iter().map(day).collect();
            check(&stored, &acknowledged);
        }
        outcome.acknowledged += acknowledged.iter().map(Vec::len).sum::<usize>();
    }

    /// Kills instances as often as this test requires, and checks that nothing was lost.
    fn run(&self) -> Outcome {
        let mut outcome = Outcome::default();
        let start = |_| self.start("127.0.0.1:0").expect("it starts");
        let mut services: Vec<Service> = (0..self.instances).map(start).collect();
        let mut killed = 0;
        while killed < kills() {
            let next = kills().min(killed + KILLS_OF_A_ROUND);
            self.round(&mut services, killed..next, &mut outcome);
            killed = next;
        }
        drop(services);
        let verified = Command::new(assert_cmd::cargo::cargo_bin!("vertifleet"))
            .args(["serve", "verify"])
            .args(self.data)
            .output()
            .expect("the program runs");
        assert!(verified.status.success(), "{}", String::from_utf8_lossy(&verified.stdout));
        let (name, acknowledged) = (self.name, outcome.acknowledged);
        assert!(acknowledged > 100, "{acknowledged} events were acknowledged");
        let refused = outcome.refused.load(Ordering::Relaxed);
        eprintln!(
            "{name}: {killed} kills, {acknowledged} events acknowledged, none lost; {refused} requests refused"
        );
        outcome
    }
}

/// Checks the events of each day against those that were acknowledged to each client.
fn check(stored: &[BTreeMap<u64, String>], acknowledged: &[Vec<Acknowledged>]) {
    let mut answered = BTreeSet::new();
    for (day, seq, mark) in acknowledged.iter().flatten() {
        assert_eq!(stored[*day].get(seq), Some(mark), "event {seq} of day {day}");
        assert!(answered.insert((day, seq)), "event {seq} of day {day} was acknowledged twice");
    }
    for marks in stored {
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
    // Besides the acknowledged events there is at most the last request of each client.
    let count: usize = acknowledged.iter().map(Vec::len).sum();
    let extra = stored.iter().map(BTreeMap::len).sum::<usize>() - count;
    assert!(extra <= CLIENTS, "{extra} events were stored and never acknowledged");
}

/// A folder, and its path as text.
fn folder() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().to_str().expect("text").to_owned();
    (folder, path)
}

#[test]
fn no_acknowledged_event_is_lost_when_the_service_is_killed() {
    let (_folder, path) = folder();
    let meanwhile = |_: &Service, _, time| thread::sleep(time);
    Trial { name: "SQLite", data: ["--data", &path], instances: 1, meanwhile }.run();
}

#[test]
fn no_acknowledged_event_is_lost_when_instances_that_share_a_database_are_killed() {
    let database = Postgres::start();
    let url = database.url();
    let meanwhile = |_: &Service, _, time| thread::sleep(time);
    Trial { name: "PostgreSQL", data: ["--database", &url], instances: 2, meanwhile }.run();
}

/// Makes some writes fail: a file may not grow beyond a length that is drawn each time, so that a
/// write ends at any byte. The service may be killed before files may grow again.
#[cfg(target_os = "linux")]
fn let_writes_fail(service: &Service, kill: u32, time: Duration) {
    const LONGEST: usize = 1 << 22;
    let pid = i32::try_from(service.child.id()).expect("a process of ours");
    let (_, hard) = rlimit::Resource::FSIZE.get().expect("a limit");
    let begun = std::time::Instant::now();
    for step in 0.. {
        let drawn = |number: u32| draw(kill, 1 + 4 * step + number);
        let length = (drawn(0) % LONGEST) >> (drawn(1) % 22);
        let length = if step % 2 == 0 { hard.min(length as u64) } else { hard };
        rlimit::prlimit(pid, rlimit::Resource::FSIZE, Some((length, hard)), None)
            .expect("a process of ours");
        thread::sleep(milliseconds(5 + drawn(2) % 40));
        if begun.elapsed() >= time {
            return;
        }
    }
}

#[test]
#[cfg(target_os = "linux")]
fn no_acknowledged_event_is_lost_when_writes_fail_and_the_service_is_killed() {
    let (_folder, path) = folder();
    let name = "SQLite with writes that fail";
    let outcome =
        Trial { name, data: ["--data", &path], instances: 1, meanwhile: let_writes_fail }.run();
    assert!(outcome.refused.into_inner() > 0, "no write has failed");
}
