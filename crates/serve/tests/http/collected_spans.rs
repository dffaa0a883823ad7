//! Spans of requests as an OpenTelemetry collector receives them.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{Ipv4Addr, TcpListener};
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};

use opentelemetry_proto::tonic::collector::trace::v1::ExportTraceServiceRequest;
use opentelemetry_proto::tonic::common::v1::{KeyValue, any_value::Value};
use opentelemetry_proto::tonic::trace::v1::{Span, span::SpanKind, status::StatusCode};
use prost::Message as _;
use serde_json::json;
use vertifleet_core::{Coded as _, Stop};
use vertifleet_serve::{Role, Settings, serve};

use crate::running::{Running, bearers, folder, settings_for};

/// The trace of a caller and its own span.
const TRACE: &str = "0af7651916cd43dd8448eb211c80319c";
const CALLER: &str = "b7ad6b7169203331";

/// A collector, by its address and the batches that it receives: the first line of each request and
/// its body.
fn collector() -> (String, Receiver<(String, Vec<u8>)>) {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    let address = format!("http://{}", listener.local_addr().expect("an address"));
    let (taken, batches) = mpsc::channel();
    std::thread::spawn(move || {
        for socket in listener.incoming() {
            let taken = taken.clone();
            std::thread::spawn(move || {
                let mut socket = BufReader::new(socket.expect("a connection"));
                while let Some(batch) = batch(&mut socket) {
                    // The batch is stored before the answer: the service may end after the answer,
                    // and the test looks then.
                    if taken.send(batch).is_err() {
                        return;
                    }
                    let answer = b"HTTP/1.1 200 OK\r\ncontent-length: 0\r\n\r\n";
                    socket.get_mut().write_all(answer).expect("it is sent");
                }
            });
        }
    });
    (address, batches)
}

fn batch(socket: &mut BufReader<std::net::TcpStream>) -> Option<(String, Vec<u8>)> {
    let mut first = String::new();
    socket.read_line(&mut first).ok().filter(|&bytes| bytes > 0)?;
    let mut length = 0;
    loop {
        let mut line = String::new();
        socket.read_line(&mut line).expect("a header");
        let Some((name, value)) = line.trim_end().split_once(": ") else { break };
        if name.eq_ignore_ascii_case("content-length") {
            length = value.parse().expect("a number");
        }
    }
    let mut body = vec![0; length];
    socket.read_exact(&mut body).expect("a body");
    Some((first, body))
}

fn observed(collector: String) -> (tempfile::TempDir, Running) {
    let (folder, location) = folder();
    let service =
        Running::start_as(Settings { collector: Some(collector), ..settings_for(location) });
    (folder, service)
}

fn text(attributes: &[KeyValue], name: &str) -> Option<String> {
    let value = attributes.iter().find(|one| one.key == name)?.value.clone()?.value?;
    Some(match value {
        Value::StringValue(text) => text,
        Value::IntValue(number) => number.to_string(),
        other => panic!("{other:?}"),
    })
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

#[test]
fn requests_become_spans_within_the_traces_of_their_callers() {
    let (address, batches) = collector();
    let (_folder, location) = folder();
    let bearer = bearers(&location)("console", Role::Dispatch);
    let service = Running::start_as(Settings {
        // A slash at the end is not part of the address.
        collector: Some(format!("{address}/")),
        ..settings_for(location)
    });
    let traced = format!("00-{TRACE}-{CALLER}-01");
    let headers = [
        ("authorization", bearer.as_str()),
        ("traceparent", &traced),
        ("tracestate", "vendor=written-by-the-client"),
    ];
    let body = json!({"network": "paper", "policy": "greedy", "name": "a day of ours"}).to_string();
    let made = service.send("POST", "/v1/days", &headers, body.as_bytes());
    let id = made.json["id"].as_str().expect("an id").to_owned();
    let event = br#"{"type": "landed", "aircraft": "A01"}"#;
    let refused = service.send("POST", &format!("/v1/days/{id}/events"), &headers[..1], event);
    assert_eq!(refused.status, 422, "{refused:?}");
    let unsampled = format!("00-{TRACE}-{CALLER}-00");
    service.send("GET", "/v1/days", &[headers[0], ("traceparent", &unsampled)], b"");
    service.get("/nowhere");
    // Unsent spans are sent when the service stops.
    drop(service);

    let received: Vec<_> = batches.try_iter().collect();
    let mut spans: Vec<Span> = Vec::new();
    for (first, body) in &received {
        assert!(first.starts_with("POST /v1/traces HTTP/1.1"), "{first}");
        let said = String::from_utf8_lossy(body);
        let secret = bearer.rsplit('_').next().expect("a secret");
        for private in [secret, id.as_str(), "a day of ours", "A01", "written-by-the-client"] {
            assert!(!said.contains(private), "{private:?} is in {said:?}");
        }
        let batch = ExportTraceServiceRequest::decode(body.as_slice()).expect("a batch");
        for of_service in batch.resource_spans {
            let resource = of_service.resource.expect("a resource").attributes;
            assert_eq!(text(&resource, "service.name").as_deref(), Some("vertifleet"));
            let version = text(&resource, "service.version");
            assert_eq!(version.as_deref(), Some(env!("CARGO_PKG_VERSION")));
            spans.extend(of_service.scope_spans.into_iter().flat_map(|scope| scope.spans));
        }
    }
    let names: Vec<&str> = spans.iter().map(|span| span.name.as_str()).collect();
    assert_eq!(names, ["POST /v1/days", "POST /v1/days/{day}/events", "GET"], "{spans:?}");
    let [made, refused, lost] = &spans[..] else { unreachable!("there are three") };
    assert_eq!(hexadecimal(&made.trace_id), TRACE);
    assert_eq!(hexadecimal(&made.parent_span_id), CALLER);
    assert_eq!(made.kind, SpanKind::Server as i32);
    assert!(made.end_time_unix_nano > made.start_time_unix_nano, "it took a while");
    let told = |span: &Span, name| text(&span.attributes, name);
    assert_eq!(told(made, "http.request.method").as_deref(), Some("POST"));
    assert_eq!(told(made, "http.route").as_deref(), Some("/v1/days"));
    assert_eq!(told(made, "http.response.status_code").as_deref(), Some("201"));
    assert_eq!(told(made, "error.type"), None);
    assert_ne!(hexadecimal(&refused.trace_id), TRACE);
    assert!(refused.parent_span_id.is_empty(), "it has no caller");
    assert_eq!(told(refused, "http.response.status_code").as_deref(), Some("422"));
    assert_eq!(told(refused, "error.type").as_deref(), Some("V604"));
    let status = refused.status.clone().unwrap_or_default().code;
    assert_eq!(status, StatusCode::Unset as i32, "the client's mistake is no failure");
    assert_eq!((told(lost, "http.route"), told(lost, "error.type")), (None, Some("V610".into())));
}

#[test]
fn an_unreachable_collector_delays_no_request() {
    let silent = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    let silent_address = silent.local_addr().expect("an address");
    let gone = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    let gone_address = gone.local_addr().expect("an address");
    drop(gone);
    for address in [silent_address, gone_address] {
        let (_folder, service) = observed(format!("http://{address}"));
        let begun = Instant::now();
        // More than the queue of spans holds. If each waited for the collector, they would take
        // hours.
        for _ in 0..3_000 {
            assert_eq!(service.get("/healthz").status, 200);
        }
        drop(service);
        let took = begun.elapsed();
        assert!(took < Duration::from_mins(5), "{took:?}");
    }
}

#[test]
fn a_collector_is_an_address_of_http() {
    let (_folder, location) = folder();
    for address in ["127.0.0.1:4318", "grpc://127.0.0.1:4317", "http://", "http://a b"] {
        let settings =
            Settings { collector: Some(address.to_owned()), ..settings_for(location.clone()) };
        let refused = serve(&settings, |_| panic!("it listens"), &Stop::default());
        assert_eq!(refused.expect_err(address).code().to_string(), "V625", "{address}");
    }
}
