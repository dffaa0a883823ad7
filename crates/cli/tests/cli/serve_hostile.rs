//! A hostile client: thousands of silent connections, thousands of streams, and malformed requests.
//! The service must still answer others.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::time::Duration;

use crate::service::Service;
use serde_json::{Value, json};

/// Silent connections; fewer where the operating system permits fewer files.
const SILENT: u64 = 10_000;
/// Readers of a stream, each of which must get every event.
const READERS: usize = 1_000;
/// Events that they receive.
const EVENTS: usize = 20;

fn start(data: &Path) -> Service {
    Service::start(Service::command("127.0.0.1:0").arg("--data").arg(data)).expect("it starts")
}

impl Service {
    fn connect(&self) -> TcpStream {
        let socket = TcpStream::connect(&self.address).expect("it listens");
        socket.set_read_timeout(Some(Duration::from_mins(2))).expect("a timeout");
        socket
    }

    fn ask(&self, method: &str, path: &str, body: &str) -> (u16, Value) {
        let mut socket = self.connect();
        write!(
            socket,
            "{method} {path} HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\ncontent-length: {}\r\n\r\n{body}",
            body.len()
        )
        .expect("it is sent");
        let mut answer = String::new();
        socket.read_to_string(&mut answer).expect("an answer");
        let status = answer.split(' ').nth(1).and_then(|status| status.parse().ok());
        let (_, body) = answer.split_once("\r\n\r\n").expect("a body");
        (status.expect("a status"), serde_json::from_str(body).unwrap_or(Value::Null))
    }

    fn new_day(&self) -> String {
        let body = json!({"network": "paper", "policy": "greedy"}).to_string();
        let (status, made) = self.ask("POST", "/v1/days", &body);
        assert_eq!(status, 201, "{made}");
        format!("/v1/days/{}", made["id"].as_str().expect("an id"))
    }
}

#[test]
fn other_clients_are_served_despite_thousands_of_silent_connections() {
    let folder = tempfile::tempdir().expect("a folder");
    let service = start(folder.path());
    let files = rlimit::increase_nofile_limit(u64::MAX).expect("a limit");
    let number = SILENT.min(files.saturating_sub(1_000));
    let silent: Vec<TcpStream> = (0..number).map(|_| service.connect()).collect();
    let day = service.new_day();
    for aircraft in 1..=9 {
        let body = json!({"aircraft": format!("A0{aircraft}")}).to_string();
        let (status, taken) = service.ask("POST", &format!("{day}/decisions"), &body);
        assert_eq!(status, 201, "{taken}");
    }
    drop(silent);
    assert_eq!(service.ask("GET", "/readyz", "").0, 200);
}

#[test]
fn a_thousand_readers_get_every_event() {
    let folder = tempfile::tempdir().expect("a folder");
    let service = start(folder.path());
    let day = service.new_day();
    let mut readers: Vec<TcpStream> = (0..READERS).map(|_| service.connect()).collect();
    for reader in &mut readers {
        write!(reader, "GET {day}/stream HTTP/1.1\r\nhost: localhost\r\n\r\n").expect("it is sent");
    }
    for _ in 0..EVENTS {
        let (status, taken) = service.ask("POST", &format!("{day}/events"), r#"{"type": "clock"}"#);
        assert_eq!(status, 201, "{taken}");
    }
    for (number, reader) in readers.into_iter().enumerate() {
        let ids = BufReader::new(reader)
            .lines()
            .map_while(Result::ok)
            .filter_map(|line| line.strip_prefix("id: ").and_then(|id| id.parse::<usize>().ok()));
        let seen: Vec<usize> = ids.take(EVENTS).collect();
        assert!(seen.iter().copied().eq(1..=EVENTS), "reader {number} saw {seen:?}");
    }
}

#[test]
fn nonsense_is_answered_with_a_code() {
    let folder = tempfile::tempdir().expect("a folder");
    let service = start(folder.path());
    let day = service.new_day();
    let deep = "[".repeat(100_000);
    let wide = format!("[{}1]", "1,".repeat(1_000_000));
    let long_key = format!("{{\"{}\": 1}}", "k".repeat(1_000_000));
    let many = format!("[{}{{\"type\": \"clock\"}}]", "{\"type\": \"clock\"},".repeat(2_000));
    for body in [&deep, &wide, &long_key, &many] {
        for path in ["events", "decisions", "what-if"] {
            let (status, problem) = service.ask("POST", &format!("{day}/{path}"), body);
            assert!((400..500).contains(&status), "{path}: {status} {problem}");
            assert!(
                problem["code"].as_str().is_some_and(|code| code.starts_with('V')),
                "{problem}"
            );
            let detail = problem["detail"].as_str().expect("a detail");
            assert!(detail.len() < 2_000, "{path}: {} bytes of detail", detail.len());
        }
    }
    let path = format!("/v1/days/{}", "x".repeat(10_000));
    assert_eq!(service.ask("GET", &path, "").0, 404);
    assert_eq!(service.ask("GET", "/readyz", "").0, 200);
}
