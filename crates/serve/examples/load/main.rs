//! Loads a running service and prints how many requests it answered and how fast.
//!
//!     cargo run --release -p vertifleet-serve --example load -- http://127.0.0.1:8080 decisions 32 20
//!
//! `decisions` operates days of `paper`, one after the other in each client, with `gcaps-x` (or
//! with the policy that follows the seconds). `events` books passengers, one at a time, with a
//! separate day for each client. `streams` sends 500 events a second to one day, which this number
//! of clients read, and measures the time from sending an event to each reader. The last two
//! numbers are the clients and the seconds. Only addresses of this machine are loaded.

mod streams;

use std::sync::Arc;
use std::sync::Mutex;
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use vertifleet_core::{DaySeed, Network, Stop};
use vertifleet_serve::{Operation, operate};

struct Load {
    url: String,
    policy: String,
    until: Instant,
    /// The time that each request took, milliseconds.
    took_ms: Mutex<Vec<f64>>,
    /// Events in addition to the measured requests.
    others: Mutex<u64>,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [url, kind, clients, seconds, rest @ ..] = &arguments[..] else {
        eprintln!("usage: load URL decisions|events|streams CLIENTS SECONDS [POLICY]");
        std::process::exit(2);
    };
    assert!(url.starts_with("http://127.0.0.1:"), "only this machine is loaded");
    let clients: u64 = clients.parse().expect("a number of clients");
    let seconds: u64 = seconds.parse().expect("a number of seconds");
    assert!(clients <= 4_000 && seconds <= 300, "at most 4,000 clients for 300 seconds");
    if kind == "streams" {
        println!("{:#}", streams::load(url, clients, Duration::from_secs(seconds)));
        return;
    }
    assert!(clients <= 256, "at most 256 clients write");
    let policy = rest.first().cloned().unwrap_or_else(|| "gcaps-x".to_owned());
    let begun = Instant::now();
    let load = Load {
        url: url.clone(),
        policy,
        until: begun + Duration::from_secs(seconds),
        took_ms: Mutex::default(),
        others: Mutex::default(),
    };
    thread::scope(|scope| {
        for client in 0..clients {
            let load = &load;
            scope.spawn(move || match kind.as_str() {
                "decisions" => load.decide(client),
                _ => load.book(client),
            });
        }
    });
    println!("{:#}", load.report(begun.elapsed()));
}

impl Load {
    fn decide(&self, client: u64) {
        let network = Network::shipped("paper").expect("a shipped network");
        let stop = Stop::default();
        for number in 0.. {
            let seed = DaySeed::validation(2_001 + (client + 37 * number) % 900).expect("a seed");
            let day = Arc::new(network.draw(seed));
            let operation = Operation::new(&self.url, day, &self.policy);
            let mut took_ms = Vec::new();
            let report = operate(&operation, &stop, |_, took| {
                took_ms.push(took.as_secs_f64() * 1e3);
                if Instant::now() > self.until {
                    stop.request();
                }
            });
            let decisions = took_ms.len() as u64;
            self.took_ms.lock().expect("no client panics").extend(took_ms);
            match report.expect("the service answers") {
                Some(report) => {
                    *self.others.lock().expect("no client panics") += report.events - decisions;
                }
                None => return,
            }
        }
    }

    fn book(&self, client: u64) {
        let agent = ureq::agent();
        let post = |path: &str, body: &Value| -> Value {
            let url = format!("{}{path}", self.url);
            let mut answer =
                agent.post(url).send(body.to_string().as_bytes()).expect("the service answers");
            serde_json::from_slice(&answer.body_mut().read_to_vec().expect("a body")).expect("JSON")
        };
        let made =
            post("/v1/days", &json!({"network": "paper", "seed": 1 + client, "policy": "greedy"}));
        let path = format!("/v1/days/{}/events", made["id"].as_str().expect("an id"));
        let booked = json!({"type": "booked", "period": "12:00:00", "from": "V1", "to": "V2", "passengers": 1});
        let mut took_ms = Vec::new();
        while Instant::now() < self.until {
            let asked = Instant::now();
            post(&path, &booked);
            took_ms.push(asked.elapsed().as_secs_f64() * 1e3);
        }
        self.took_ms.lock().expect("no client panics").extend(took_ms);
    }

    fn report(self, took: Duration) -> Value {
        let mut took_ms = self.took_ms.into_inner().expect("no client panics");
        took_ms.sort_by(f64::total_cmp);
        let rank = |share: usize| took_ms.get(took_ms.len() * share / 1_000).copied();
        let per_s = |count: f64| (count / took.as_secs_f64()).round();
        json!({
            "requests": took_ms.len(),
            "requests_per_s": per_s(took_ms.len() as f64),
            "other_events_per_s": per_s(self.others.into_inner().expect("no client panics") as f64),
            "median_ms": rank(500),
            "p99_ms": rank(990),
            "p999_ms": rank(999),
        })
    }
}
