//! The collector of spans, as the command line and the environment name it.

use std::io::{BufRead as _, BufReader, Write as _};
use std::net::TcpListener;
use std::time::Duration;

use crate::service::Service;
use assert_cmd::Command;

/// OpenTelemetry's standard variable for the address of a collector.
const VARIABLE: &str = "OTEL_EXPORTER_OTLP_ENDPOINT";

/// A listener for a collector's first request.
fn listener() -> (TcpListener, String) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let url = format!("http://{}", listener.local_addr().expect("an address"));
    (listener, url)
}

/// The first line of the first request.
fn first_line(listener: &TcpListener) -> String {
    let (socket, _) = listener.accept().expect("a connection");
    socket.set_read_timeout(Some(Duration::from_mins(1))).expect("a timeout");
    let mut line = String::new();
    let mut reader = BufReader::new(socket);
    reader.read_line(&mut line).expect("a request");
    reader
        .get_mut()
        .write_all(b"HTTP/1.1 200 OK\r\ncontent-length: 0\r\n\r\n")
        .expect("it is sent");
    line
}

#[test]
fn spans_go_to_the_collector_of_the_command_line_or_else_of_the_environment() {
    let (asked, asked_url) = listener();
    let (other, other_url) = listener();
    other.set_nonblocking(true).expect("it need not wait");
    for by_option in [true, false] {
        let folder = tempfile::tempdir().expect("a folder");
        let mut serve = Service::command("127.0.0.1:0");
        serve.arg("--data").arg(folder.path());
        if by_option {
            serve.args(["--otlp", &asked_url]).env(VARIABLE, &other_url);
        } else {
            serve.env(VARIABLE, &asked_url);
        }
        // Every request at once, so that no request waits for a batch.
        serve.env("OTEL_BSP_SCHEDULE_DELAY", "50");
        let service = Service::start(&mut serve).expect("it starts");
        ureq::get(format!("http://{}/healthz", service.address)).call().expect("it answers");
        assert!(first_line(&asked).starts_with("POST /v1/traces HTTP/1.1"));
    }
    assert!(other.accept().is_err(), "the command line goes before the environment");
}

#[test]
fn an_invalid_address_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let command = |url: &str| {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("vertifleet"));
        command.args(["serve", "--listen", "127.0.0.1:0", "--data"]).arg(folder.path());
        command.env(VARIABLE, url);
        command.assert().code(2).get_output().stderr.clone()
    };
    let said = String::from_utf8(command("127.0.0.1:4318")).expect("text");
    assert!(said.starts_with("error[V625]: "), "{said}");
    assert!(said.contains("must begin with http://"), "{said}");
}
