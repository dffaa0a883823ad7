//! Requests with any content, for fuzzing. Every request is answered. Every day can afterwards be
//! described and played on, and its state in memory equals that in the store.
//!
//! Requests go through the service's router, so the fuzzer reaches all of its parsers: paths,
//! queries, headers, bodies, and their contents.

use std::path::Path;
use std::sync::Arc;

use axum::Router;
use axum::body::{Body, Bytes};
use axum::http::{HeaderValue, Method, Request, StatusCode, Uri, header};
use http_body_util::BodyExt as _;
use hyper::service::Service as _;
use hyper_util::service::TowerToHyperService;
use serde_json::{Value, json};
use tokio::runtime::Runtime;

use crate::api::router;
use crate::console::Console;
use crate::keep::Tokens;
use crate::limits::Limits;
use crate::service::Service;
use crate::store::{Location, Store};
use crate::tokens::Role;

/// A small day of three vertiports, `A`, `B` and `C`, and three aircraft, `A01`, `A02` and `A03`.
const SCENARIO: &str = include_str!("../../core/tests/data/small.json");
/// The paths of a day that take a body.
const TAKE_BODIES: [&str; 3] = ["events", "decisions", "what-if"];
/// The paths of a day that take a query.
const TAKE_QUERIES: [&str; 6] =
    ["state", "demand", "events", "stream", "outlook", "aircraft/A01/decision"];
/// The headers with a meaning.
const HEADERS: [&str; 4] = ["authorization", "idempotency-key", "if-match", "last-event-id"];

/// A service that only the fuzzer uses.
#[derive(Debug)]
pub struct AnyRequest {
    runtime: Runtime,
    client: Client,
}

/// Sends requests, and checks the answers.
#[derive(Debug)]
struct Client {
    router: TowerToHyperService<Router>,
    token: HeaderValue,
    /// The path of a day on which nothing has happened.
    day: String,
}

impl AnyRequest {
    /// A service with its data in a folder.
    ///
    /// # Panics
    /// Panics if there cannot be data in the folder.
    pub fn open(folder: &Path) -> Self {
        let location = Location::Folder(folder.to_owned());
        let tokens = Tokens::open(&location).expect("a folder of ours");
        let token = tokens.make("any", Role::Admin).expect("a folder of ours");
        let token = HeaderValue::try_from(format!("Bearer {token}")).expect("plain text");
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        let runtime = runtime.expect("a thread");
        let client = runtime.block_on(async {
            let store = Store::open(&location).await.expect("a folder of ours");
            // No limit on the rate of requests.
            let limits = Limits { requests_per_s: 1_000_000, ..Limits::default() };
            let service = Service::new(store, limits).await;
            let service = Arc::new(service.expect("it is new"));
            let console = Console::new(None).expect("without a base map nothing is wrong");
            let router = TowerToHyperService::new(router(service, console));
            let mut client = Client { router, token, day: String::new() };
            client.day = client.new_day().await;
            client
        });
        Self { runtime, client }
    }

    /// Sends bytes in place of each part that a client controls: as a body, as a query, as a part
    /// of a path, and as a header. Returns whether a request with this body was carried out.
    ///
    /// # Panics
    /// Panics if the answer to a request is wrong, or if a day is invalid afterwards.
    pub fn send(&mut self, bytes: &[u8]) -> bool {
        self.runtime.block_on(self.client.send_everywhere(bytes))
    }
}

impl Client {
    async fn send_everywhere(&mut self, bytes: &[u8]) -> bool {
        let is_carried_out = self.bodies(bytes).await;
        if let Ok(text) = std::str::from_utf8(bytes) {
            self.queries(text).await;
            self.names(text).await;
        }
        if let Ok(value) = HeaderValue::from_bytes(bytes) {
            self.headers(&value).await;
        }
        is_carried_out
    }

    async fn bodies(&mut self, bytes: &[u8]) -> bool {
        let mut is_carried_out = false;
        for path in TAKE_BODIES {
            let uri = uri(&format!("{}/{path}", self.day)).expect("plain text");
            is_carried_out |= self.ask(Method::POST, uri, bytes).await.is_some();
        }
        if let Some(day) = self.make("/v1/days", bytes).await {
            is_carried_out = true;
            self.check_and_delete(&day).await;
        }
        if let Some(study) = self.make("/v1/studies", bytes).await {
            is_carried_out = true;
            self.get(&study).await;
            self.delete(&study).await;
        }
        let day = self.get(&self.day.clone()).await;
        if day["seq"] != 0 {
            self.check_and_delete(&self.day.clone()).await;
            self.day = self.new_day().await;
        }
        is_carried_out
    }

    async fn queries(&mut self, text: &str) {
        let of_day = TAKE_QUERIES.map(|path| format!("{}/{path}?{text}", self.day));
        for path in of_day.into_iter().chain([format!("/v1/days?{text}")]) {
            if let Some(uri) = uri(&path) {
                self.ask(Method::GET, uri, b"").await;
            }
        }
    }

    async fn names(&mut self, text: &str) {
        for path in [
            format!("/v1/days/{text}"),
            format!("/v1/networks/{text}"),
            format!("/v1/policies/{text}"),
            format!("/v1/studies/{text}"),
            format!("{}/aircraft/{text}/decision", self.day),
            format!("{}/outlook?policy={text}", self.day),
            format!("{}/aircraft/A01/decision?time={text}", self.day),
        ] {
            if let Some(uri) = uri(&path) {
                self.ask(Method::GET, uri, b"").await;
            }
        }
    }

    /// Sends requests that change nothing, with any headers.
    async fn headers(&mut self, value: &HeaderValue) {
        for name in HEADERS {
            for (method, path) in [(Method::POST, "events"), (Method::GET, "stream")] {
                let uri = uri(&format!("{}/{path}", self.day)).expect("plain text");
                let mut request = self.request(method, uri, b"[]");
                request.headers_mut().insert(name, value.clone());
                self.answer(request).await;
            }
        }
    }

    fn request(&self, method: Method, uri: Uri, body: &[u8]) -> Request<Body> {
        let mut request = Request::new(Body::from(Bytes::copy_from_slice(body)));
        *request.method_mut() = method;
        *request.uri_mut() = uri;
        request.headers_mut().insert(header::AUTHORIZATION, self.token.clone());
        request
    }

    async fn ask(&mut self, method: Method, uri: Uri, body: &[u8]) -> Option<Value> {
        self.answer(self.request(method, uri, body)).await
    }

    /// The answer to a request that was carried out, if it is JSON. The others must have
    /// been refused for a reason.
    async fn answer(&mut self, request: Request<Body>) -> Option<Value> {
        let asked = format!("{} {}", request.method(), request.uri());
        let answer = self.router.call(request).await.expect("it answers every request");
        let status = answer.status();
        let is_stream = answer
            .headers()
            .get(header::CONTENT_TYPE)
            .is_some_and(|kind| kind == "text/event-stream");
        if is_stream {
            // A stream has no end.
            return None;
        }
        let body = answer.into_body().collect().await.expect("it is all there").to_bytes();
        let body: Value = serde_json::from_slice(&body).unwrap_or_default();
        if status.is_success() {
            return Some(body);
        }
        let is_refused = status.is_client_error() && status != StatusCode::REQUEST_TIMEOUT;
        let has_code = body["code"].as_str().is_some_and(|code| code.starts_with('V'));
        assert!(is_refused && has_code, "{asked}: {status} {body}");
        None
    }

    /// The path of the object that a request creates, if it is carried out.
    async fn make(&mut self, list: &str, body: &[u8]) -> Option<String> {
        let made = self.ask(Method::POST, uri(list).expect("plain text"), body).await?;
        Some(format!("{list}/{}", made["id"].as_str().expect("an id")))
    }

    async fn delete(&mut self, path: &str) {
        self.ask(Method::DELETE, uri(path).expect("plain text"), b"").await;
    }

    /// Reads a path that must always be readable.
    async fn get(&mut self, path: &str) -> Value {
        let answer = self.ask(Method::GET, uri(path).expect("plain text"), b"").await;
        answer.unwrap_or_else(|| panic!("{path} can be read"))
    }

    async fn new_day(&mut self) -> String {
        let scenario: Value = serde_json::from_str(SCENARIO).expect("a scenario file");
        let (date, time_zone) = ("2026-11-23", "America/New_York");
        let body =
            json!({"scenario": scenario, "date": date, "time_zone": time_zone, "policy": "greedy"});
        self.make("/v1/days", body.to_string().as_bytes()).await.expect("a good day")
    }

    /// Checks that a day can be described and played on, and is the same in the store and in
    /// memory.
    async fn check_and_delete(&mut self, day: &str) {
        let info = self.get(day).await;
        let state = self.get(&format!("{day}/state")).await;
        let replayed = self.get(&format!("{day}/state?seq={}", info["seq"])).await;
        assert_eq!(state, replayed, "the state is the fold of the events that are stored");
        for path in ["demand", "events", "trace.csv", "scenario", "outlook?policy=greedy"] {
            self.get(&format!("{day}/{path}")).await;
        }
        if info["date"].is_string() {
            self.get(&format!("{day}/state?times=iso")).await;
            self.get(&format!("{day}/events?times=iso")).await;
        }
        self.delete(day).await;
    }
}

/// An address, if a text is one.
fn uri(text: &str) -> Option<Uri> {
    Uri::try_from(text).ok()
}

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};

    use vertifleet_testkit::spoilt;

    use super::AnyRequest;

    /// The number of mutations of every valid request.
    const WAYS: u32 = 100;

    /// Bodies (`.json`), queries and other texts that are valid on the small day. Fuzzing begins
    /// with them.
    fn good() -> Vec<(PathBuf, Vec<u8>)> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/requests");
        let files = std::fs::read_dir(folder).expect("a folder of the project");
        let mut files: Vec<_> = files.map(|file| file.expect("a file").path()).collect();
        files.sort();
        let read = |file: PathBuf| (file.clone(), std::fs::read(file).expect("a file"));
        files.into_iter().map(read).collect()
    }

    #[test]
    fn every_request_is_answered_and_every_day_stays_sound() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut service = AnyRequest::open(folder.path());
        let mut carried_out = 0;
        for (file, good) in good() {
            let is_body = file.extension().is_some_and(|kind| kind == "json");
            assert_eq!(service.send(&good), is_body, "{} as a body", file.display());
            for way in 0..WAYS {
                carried_out += u32::from(service.send(&spoilt(&good, way)));
            }
        }
        assert!(carried_out > 20, "{carried_out} spoilt bodies were good enough");
    }
}
