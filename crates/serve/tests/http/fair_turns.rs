//! Turns per token: a token that floods the service with long requests delays itself alone.

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::available_parallelism;
use std::time::Duration;

use serde_json::{Value, json};
use vertifleet_serve::Role;

use crate::running::{Answer, Running, bearers, folder};

/// Connections of the reader that each ask for one proposal after the other.
const FLOOD: usize = 12;

/// A request on its own connection, whose answer nothing waits for.
struct Sent(TcpStream);

impl Sent {
    fn new(service: &Running, head: &str, body: &[u8]) -> Self {
        let address = service.url.strip_prefix("http://").expect("an address");
        let mut socket = TcpStream::connect(address).expect("it listens");
        socket.write_all(head.as_bytes()).expect("it is sent");
        socket.write_all(body).expect("it is sent");
        Self(socket)
    }

    /// Whether its answer has begun.
    fn is_answered(&mut self) -> bool {
        self.0.set_nonblocking(true).expect("a socket");
        let read = self.0.read(&mut [0; 1]);
        read.is_ok()
    }
}

fn send(service: &Running, bearer: &str, method: &str, path: &str, body: &Value) -> Answer {
    let headers = [("authorization", bearer)];
    service.send(method, path, &headers, body.to_string().as_bytes())
}

#[test]
fn stalled_uploads_of_a_token_leave_turns_to_others() {
    let (_folder, location) = folder();
    let token = bearers(&location);
    let (flood, honest) = (token("flood", Role::Read), token("honest", Role::Read));
    let service = Running::start_at(location);
    let head = format!(
        "POST /v1/networks/validate HTTP/1.1\r\nhost: localhost\r\nauthorization: {flood}\r\ncontent-length: 50000000\r\n\r\n{{\"toml\": \""
    );
    // Long enough to need a turn, and never complete.
    let begun = vec![b'a'; 5 << 20];
    let mut stalled: Vec<Sent> = (0..16).map(|_| Sent::new(&service, &head, &begun)).collect();
    // By now the service has read enough of them, or this upload is quicker.
    std::thread::sleep(Duration::from_millis(500));
    let network = std::fs::read_to_string("../../networks/paper.toml").expect("it is shipped");
    let large = json!({"toml": format!("{network}\n# {}\n", "a".repeat(5 << 20))});
    let answer = send(&service, &honest, "POST", "/v1/networks/validate", &large);
    assert_eq!(answer.status, 200, "{answer:?}");
    assert!(
        !stalled.iter_mut().any(Sent::is_answered),
        "the honest upload did not wait until a stalled one was ended"
    );
}

#[test]
fn outlooks_of_a_reader_do_not_delay_a_dispatcher() {
    let (_folder, location) = folder();
    let token = bearers(&location);
    let (flood, anna) = (token("flood", Role::Read), token("anna", Role::Dispatch));
    let service = Running::start_at(location);
    let make = |network: &str| {
        let day = json!({"network": network, "policy": "greedy"});
        send(&service, &anna, "POST", "/v1/days", &day).made("/v1/days")
    };
    let (large, own) = (make("large"), make("paper"));
    let head = format!(
        "GET {large}/outlook?policy=gcaps-x HTTP/1.1\r\nhost: localhost\r\nauthorization: {flood}\r\n\r\n"
    );
    let cores = available_parallelism().map_or(1, usize::from);
    let mut asked: Vec<Sent> = (0..cores + 6).map(|_| Sent::new(&service, &head, b"")).collect();
    // By now they have their turns, or this outlook is quicker.
    std::thread::sleep(Duration::from_millis(500));
    let outlook = send(&service, &anna, "GET", &format!("{own}/outlook"), &Value::Null);
    assert_eq!(outlook.status, 200, "{outlook:?}");
    assert!(!asked.iter_mut().any(Sent::is_answered), "no outlook of the reader came first");
}

#[test]
fn proposals_for_a_reader_do_not_delay_decisions_on_the_same_day() {
    let (_folder, location) = folder();
    let token = bearers(&location);
    let (flood, anna) = (token("flood", Role::Read), token("anna", Role::Dispatch));
    let service = Running::start_at(location);
    let day = json!({"network": "large", "policy": "rolling"});
    let day = send(&service, &anna, "POST", "/v1/days", &day).made("/v1/days");
    let state = send(&service, &anna, "GET", &format!("{day}/state"), &Value::Null).json;
    let aircraft: Vec<&str> = (0..5).filter_map(|a| state["aircraft"][a]["id"].as_str()).collect();
    let (answered, refused) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let decided = AtomicBool::new(false);
    let proposal = format!("{day}/aircraft/{}/decision", aircraft[4]);
    let fewest_before = std::thread::scope(|threads| {
        for _ in 0..FLOOD {
            threads.spawn(|| {
                while !decided.load(Ordering::Relaxed) {
                    let answer = send(&service, &flood, "GET", &proposal, &Value::Null);
                    refused.fetch_add(usize::from(answer.status != 200), Ordering::Relaxed);
                    answered.fetch_add(1, Ordering::Relaxed);
                }
            });
        }
        while answered.load(Ordering::Relaxed) < FLOOD {
            std::thread::sleep(Duration::from_millis(10));
        }
        let proposals_before = |aircraft: &&str| {
            let before = answered.load(Ordering::Relaxed);
            let decision = json!({"aircraft": aircraft});
            let decision = send(&service, &anna, "POST", &format!("{day}/decisions"), &decision);
            (decision.status, answered.load(Ordering::Relaxed) - before)
        };
        let decisions: Vec<(u16, usize)> = aircraft[..4].iter().map(proposals_before).collect();
        decided.store(true, Ordering::Relaxed);
        assert!(decisions.iter().all(|(status, _)| *status == 201), "{decisions:?}");
        // The fewest, since a busy machine may stop this thread after an answer.
        decisions.iter().map(|(_, proposals)| *proposals).min()
    });
    assert_eq!(refused.into_inner(), 0, "every proposal is made");
    let fewest_before = fewest_before.expect("there are decisions");
    assert!(fewest_before <= FLOOD / 2, "{fewest_before} proposals came before each decision");
}
