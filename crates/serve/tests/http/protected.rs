//! Access control, and limits that stop one client from taking all resources.

use std::io::{Read as _, Write as _};
use std::net::{Ipv4Addr, TcpStream};
use std::sync::Arc;
use std::time::Duration;

use serde_json::json;
use vertifleet_core::{Coded as _, DaySeed, Network, Stop};
use vertifleet_serve::{
    Limits, Location, Operation, Protection, Role, Settings, Tokens, operate, serve,
};

use crate::running::{Running, bearers, folder, settings_for};

fn limited(limits: Limits) -> (tempfile::TempDir, Running) {
    let folder = tempfile::tempdir().expect("a folder");
    let service = Running::start_with(Location::Folder(folder.path().to_owned()), limits);
    (folder, service)
}

fn connect(service: &Running) -> TcpStream {
    let address = service.url.strip_prefix("http://").expect("an address");
    let socket = TcpStream::connect(address).expect("it listens");
    socket.set_read_timeout(Some(Duration::from_mins(1))).expect("a timeout");
    socket
}

#[test]
fn the_service_uses_tls_with_the_users_certificate() {
    let folder = tempfile::tempdir().expect("a folder");
    let made = rcgen::generate_simple_self_signed(["localhost".to_owned()]).expect("a certificate");
    let (certificate, key) = (folder.path().join("tls.pem"), folder.path().join("tls.key"));
    std::fs::write(&certificate, made.cert.pem()).expect("a file");
    std::fs::write(&key, made.signing_key.serialize_pem()).expect("a file");

    let settings = |key: &std::path::Path| Settings {
        protection: Protection::Tls { certificate: certificate.clone(), key: key.to_owned() },
        ..settings_for(Location::Folder(folder.path().join("data")))
    };
    let refused = serve(&settings(&certificate), |_| (), &Stop::default());
    assert_eq!(refused.expect_err("it is no key").code().to_string(), "V624");

    let stop = Stop::default();
    let heard = stop.clone();
    let settings = settings(&key);
    let (listens, address) = std::sync::mpsc::channel();
    let running = std::thread::spawn(move || {
        serve(&settings, |address| listens.send(address).expect("the test waits"), &heard)
    });
    let port = address.recv().expect("it starts").port();
    let network = Network::shipped("paper").expect("it is shipped");
    let day = Arc::new(network.draw(DaySeed::comparison(1).expect("a seed")));
    let operation = Operation::new(&format!("https://localhost:{port}"), day, "greedy");
    let operation = Operation { trusted: Some(certificate), ..operation };
    let report = operate(&operation, &Stop::default(), |_, _| ());
    let report = report.expect("the service answers").expect("it was not stopped");
    assert!(report.totals.profit_usd > 0.0);
    // Requests without TLS fail, and do no harm.
    let mut plain = TcpStream::connect((Ipv4Addr::LOCALHOST, port)).expect("it listens");
    plain.write_all(b"GET /healthz HTTP/1.1\r\n\r\n").expect("it is sent");
    let mut said = Vec::new();
    let _ = plain.read_to_end(&mut said);
    assert!(!said.starts_with(b"HTTP"), "{said:?}");
    stop.request();
    running.join().expect("no panic").expect("no error");
}

#[test]
fn certificates_to_trust_must_be_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let network = Network::shipped("paper").expect("it is shipped");
    let day = Arc::new(network.draw(DaySeed::comparison(1).expect("a seed")));
    let trusted = Some(folder.path().join("none.pem"));
    let operation = Operation::new("https://localhost:1", day, "greedy");
    let operation = Operation { trusted, ..operation };
    let refused = operate(&operation, &Stop::default(), |_, _| ());
    assert_eq!(refused.expect_err("no such file").code().to_string(), "V624");
}

#[test]
fn silent_connections_are_closed() {
    let (_folder, service) =
        limited(Limits { head: Duration::from_millis(200), ..Limits::default() });
    let mut silent = connect(&service);
    let mut slow = connect(&service);
    slow.write_all(b"GET /healthz HT").expect("it is sent");
    for socket in [&mut silent, &mut slow] {
        let mut said = Vec::new();
        socket.read_to_end(&mut said).expect("it is closed");
        assert!(!String::from_utf8_lossy(&said).contains("200 OK"), "{said:?}");
    }
    assert_eq!(service.get("/healthz").status, 200);
}

/// The first bytes of the answer to some bytes.
fn answered(service: &Running, bytes: &[u8]) -> String {
    let mut socket = connect(service);
    socket.write_all(bytes).expect("it is sent");
    let mut said = [0; 12];
    socket.read_exact(&mut said).expect("an answer");
    String::from_utf8_lossy(&said).into_owned()
}

#[test]
fn heads_are_short_and_mean_one_thing() {
    let (_folder, service) = limited(Limits::default());
    let head = |rest: &str| format!("GET /v1 HTTP/1.1\r\nhost: localhost\r\n{rest}\r\n");
    assert_eq!(answered(&service, head("").as_bytes()), "HTTP/1.1 200");
    let long = head(&format!("x: {}\r\n", "a".repeat(60 << 10)));
    assert_eq!(answered(&service, long.as_bytes()), "HTTP/1.1 200");
    // Such a head has no end yet.
    let too_long = format!("GET /v1 HTTP/1.1\r\nhost: localhost\r\nx: {}", "a".repeat(66 << 10));
    assert_eq!(answered(&service, too_long.as_bytes()), "HTTP/1.1 431");
    let close = "connection: close\r\n";
    for wrong in [
        head("").replace("\r\n", "\n"),
        head("x: 1\ny: 2\r\n"),
        head(&format!("host: elsewhere\r\n{close}")),
    ] {
        assert_eq!(answered(&service, wrong.as_bytes()), "HTTP/1.1 400", "{wrong:?}");
    }
    // A head that follows a body is parsed just as strictly.
    let body = r#"{"network": "paper", "policy": "greedy"}"#;
    let post = format!(
        "POST /v1/days HTTP/1.1\r\nhost: localhost\r\ncontent-length: {}\r\n\r\n{body}",
        body.len()
    );
    let mut socket = connect(&service);
    socket.write_all((post + &head("").replace("\r\n", "\n")).as_bytes()).expect("it is sent");
    let mut said = String::new();
    socket.read_to_string(&mut said).expect("answers");
    assert!(said.starts_with("HTTP/1.1 201") && said.contains("HTTP/1.1 400"), "{said}");
}

#[test]
fn slow_uploads_do_not_keep_others_from_theirs() {
    let (_folder, service) = limited(Limits::default());
    let head = "POST /v1/networks/validate HTTP/1.1\r\nhost: localhost\r\ncontent-length: 50000000\r\n\r\n{";
    let slow: Vec<TcpStream> = (0..8)
        .map(|_| {
            let mut socket = connect(&service);
            socket.write_all(head.as_bytes()).expect("it is sent");
            socket
        })
        .collect();
    let network = std::fs::read_to_string("../../networks/paper.toml").expect("it is shipped");
    let large = format!("{network}\n# {}\n", "a".repeat(5 << 20));
    let begun = std::time::Instant::now();
    let answer = service.post("/v1/networks/validate", &json!({"toml": large}));
    assert_eq!(answer.status, 200, "{answer:?}");
    assert!(begun.elapsed() < Limits::default().request / 2, "it did not wait for the others");
    drop(slow);
}

#[test]
fn a_body_that_does_not_come_ends_the_request() {
    let (_folder, service) =
        limited(Limits { request: Duration::from_millis(200), ..Limits::default() });
    let mut slow = connect(&service);
    let head = "POST /v1/days HTTP/1.1\r\nhost: localhost\r\ncontent-length: 100\r\n\r\n{";
    slow.write_all(head.as_bytes()).expect("it is sent");
    let mut said = [0; 12];
    slow.read_exact(&mut said).expect("an answer");
    assert_eq!(&said, b"HTTP/1.1 408");
}

#[test]
fn further_connections_wait_until_others_end() {
    let limits = Limits { connections: 2, head: Duration::from_millis(300), ..Limits::default() };
    let (_folder, service) = limited(limits);
    let _silent = [connect(&service), connect(&service), connect(&service)];
    assert_eq!(service.get("/healthz").status, 200);
}

#[test]
fn streams_days_and_events_have_limits() {
    let limits = Limits { streams: 2, days: 2, events: 3, ..Limits::default() };
    let (_folder, service) = limited(limits);
    let day = service.new_day("greedy");
    let readers = [connect(&service), connect(&service)];
    for mut reader in &readers {
        write!(reader, "GET {day}/stream HTTP/1.1\r\nhost: localhost\r\n\r\n").expect("it is sent");
        let mut said = [0; 15];
        reader.read_exact(&mut said).expect("an answer");
        assert_eq!(&said, b"HTTP/1.1 200 OK");
    }
    let third = service.get(&format!("{day}/stream"));
    assert_eq!(third.problem(), (429, "V612"));
    drop(readers);

    service.new_day("greedy");
    let third = service.post("/v1/days", &json!({"network": "paper"}));
    assert_eq!(third.problem(), (409, "V612"));

    let clock = json!({"type": "clock"});
    let two = service.event(&day, &json!([clock, clock]));
    assert_eq!(two.status, 201);
    let four = service.event(&day, &json!([clock, clock]));
    assert_eq!(four.problem(), (409, "V612"));
}

#[test]
fn a_body_of_most_requests_is_short() {
    let (_folder, service) = limited(Limits::default());
    let day = service.new_day("greedy");
    let mut long = connect(&service);
    write!(
        long,
        "POST {day}/events HTTP/1.1\r\nhost: localhost\r\ncontent-length: 5000000\r\n\r\n["
    )
    .expect("it is sent");
    let mut said = [0; 12];
    long.read_exact(&mut said).expect("an answer");
    assert_eq!(&said, b"HTTP/1.1 413");
}

#[test]
fn a_token_over_its_limit_is_refused_and_others_are_not() {
    let (_folder, location) = folder();
    let token = bearers(&location);
    let (busy, calm) = (token("busy", Role::Read), token("calm", Role::Read));
    let limits = Limits { requests_per_s: 2, ..Limits::default() };
    let service = Running::start_with(location, limits);
    let ask = |bearer: &str| service.send("GET", "/v1/days", &[("authorization", bearer)], b"");
    let answers: Vec<u16> = (0..40).map(|_| ask(&busy).status).collect();
    assert!(answers.starts_with(&[200, 200, 200, 200]), "{answers:?}");
    assert!(answers.contains(&429), "{answers:?}");
    assert_eq!(ask(&calm).status, 200);
    let wrong: Vec<u16> = (0..40).map(|_| ask("Bearer vf_1_guess").status).collect();
    assert!(wrong.contains(&401) && wrong.contains(&429), "{wrong:?}");
    assert_eq!(ask(&calm).status, 200);
}

#[test]
fn refused_requests_count_against_their_token() {
    let (_folder, location) = folder();
    let bearer = bearers(&location)("screen", Role::Read);
    let service = Running::start_with(location, Limits { requests_per_s: 2, ..Limits::default() });
    let make = || service.send("POST", "/v1/days", &[("authorization", bearer.as_str())], b"{}");
    let answers: Vec<_> = (0..40).map(|_| make()).collect();
    let statuses: Vec<u16> = answers.iter().map(|answer| answer.status).collect();
    assert!(statuses.starts_with(&[403, 403, 403, 403]), "{statuses:?}");
    let refused = answers.iter().find(|answer| answer.status == 429).expect("too many");
    assert!(refused.json["detail"].as_str().is_some_and(|detail| detail.starts_with("screen")));
    assert_eq!(service.get("/v1/days").status, 401, "those without a token have not asked yet");
}

#[test]
fn the_stream_of_a_token_ends_when_it_is_revoked() {
    let (_folder, location) = folder();
    let tokens = Tokens::open(&location).expect("a store");
    let token = tokens.make("screen", Role::Dispatch).expect("a token");
    let service = Running::start_at(location);
    let bearer = format!("Bearer {token}");
    let headers = [("authorization", bearer.as_str())];
    let body = br#"{"network": "paper", "policy": "greedy"}"#;
    let made = service.send("POST", "/v1/days", &headers, body);
    let id = made.json["id"].as_str().expect("an id");
    let mut reader = connect(&service);
    let head = format!(
        "GET /v1/days/{id}/stream HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\nauthorization: {bearer}\r\n\r\n"
    );
    reader.write_all(head.as_bytes()).expect("it is sent");
    let token_id = &tokens.list().expect("tokens")[0].id;
    tokens.revoke(token_id).expect("it was in force");
    let mut said = Vec::new();
    reader.read_to_end(&mut said).expect("the stream ends");
    let said = String::from_utf8_lossy(&said);
    assert!(said.starts_with("HTTP/1.1 200"), "{said}");
    assert!(said.contains("x-accel-buffering: no"), "proxies pass events on at once: {said}");
}

#[test]
fn without_tokens_requests_from_foreign_pages_are_refused() {
    let (_folder, service) = limited(Limits::default());
    let make = |headers: &[(&str, &str)]| {
        let made = service.send("POST", "/v1/days", headers, br#"{"network": "paper"}"#);
        (made.status, made.json["code"].as_str().unwrap_or_default().to_owned())
    };
    let refused = (403, "V627".to_owned());
    assert_eq!(make(&[("origin", "http://evil.example"), ("content-type", "text/plain")]), refused);
    assert_eq!(make(&[("origin", "null")]), refused);
    assert_eq!(make(&[("host", "evil.example")]), refused);
    assert_eq!(service.send("GET", "/v1/days", &[("host", "evil.example:80")], b"").status, 403);
    assert_eq!(make(&[("origin", &service.url)]).0, 201);
    assert_eq!(service.get("/v1/days").json["days"].as_array().map(Vec::len), Some(1));
}

#[test]
fn behind_a_proxy_there_must_be_a_token_on_this_machine_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let settings = Settings {
        protection: Protection::Proxy,
        ..settings_for(Location::Folder(folder.path().to_owned()))
    };
    let refused = serve(&settings, |_| (), &Stop::default());
    assert_eq!(refused.expect_err("a proxy lets all in").code().to_string(), "V619");
}

#[test]
fn tokens_have_unique_names_and_answers_name_the_scheme() {
    let (_folder, location) = folder();
    let tokens = Tokens::open(&location).expect("a store");
    let token = tokens.make("console", Role::Read).expect("a token");
    let refused = tokens.make("console", Role::Admin).expect_err("one of this name is in force");
    assert_eq!(refused.code().to_string(), "V629");
    // The audit names tokens, so a name is never given again.
    let old = tokens.make("night shift", Role::Read).expect("a token");
    let id = old.trim_start_matches("vf_").split('_').next().expect("an id");
    tokens.revoke(id).expect("it was in force");
    let refused = tokens.make("night shift", Role::Admin).expect_err("its name was given");
    assert_eq!(refused.code().to_string(), "V629");
    for hidden in ["an\nna", "anna\u{7}", "an\u{202e}na", " "] {
        let refused = tokens.make(hidden, Role::Read).expect_err("it cannot be read");
        assert_eq!(refused.code().to_string(), "V601", "{hidden:?}");
    }
    let service = Running::start_at(location);
    let config = ureq::Agent::config_builder().http_status_as_error(false).build();
    let agent: ureq::Agent = config.into();
    let refused = agent.get(format!("{}/v1/days", service.url)).call().expect("an answer");
    assert_eq!(
        (refused.status().as_u16(), &refused.headers()["www-authenticate"].as_bytes()),
        (401, &&b"Bearer"[..])
    );
    let bearer = format!("bearer {}", token.trim());
    let headers = [("authorization", bearer.as_str()), ("host", "dispatch.example.com")];
    assert_eq!(service.send("GET", "/v1/days", &headers, b"").status, 200);
}
