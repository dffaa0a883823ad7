//! A service that runs in this process, on a separate port.

use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;
use std::sync::mpsc;
use std::thread::JoinHandle;

use serde_json::{Value, json};
use tempfile::TempDir;
use vertifleet_core::Stop;
use vertifleet_serve::{Error, Limits, Location, Protection, Role, Settings, Tokens, serve};

/// A running service. It stops when it is dropped.
pub(crate) struct Running {
    pub(crate) url: String,
    stop: Stop,
    thread: Option<JoinHandle<Result<(), Error>>>,
}

impl Running {
    /// Starts a service with its data in a folder.
    pub(crate) fn start(folder: &Path) -> Self {
        Self::start_at(Location::Folder(folder.to_owned()))
    }

    /// Starts a service with its data at a location.
    pub(crate) fn start_at(location: Location) -> Self {
        Self::start_with(location, Limits::default())
    }

    /// Starts a service with its data at a location and with the given limits.
    pub(crate) fn start_with(location: Location, limits: Limits) -> Self {
        Self::start_as(Settings { limits, ..settings_for(location) })
    }

    /// Starts a service.
    pub(crate) fn start_as(settings: Settings) -> Self {
        let stop = Stop::default();
        let heard = stop.clone();
        let (listens, address) = mpsc::channel();
        let run = move || {
            let ready = move |address| listens.send(address).expect("the test waits for it");
            serve(&settings, ready, &heard)
        };
        let thread = std::thread::spawn(run);
        let address: SocketAddr = address.recv().expect("it starts");
        Self { url: format!("http://{address}"), stop, thread: Some(thread) }
    }
}

/// Settings of a service for tests, with its data at a location.
pub(crate) fn settings_for(location: Location) -> Settings {
    Settings {
        listen: SocketAddr::from((Ipv4Addr::LOCALHOST, 0)),
        location,
        protection: Protection::None,
        limits: Limits::default(),
        collector: None,
        basemap: None,
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.stop.request();
        let outcome = self.thread.take().expect("it has not been stopped before").join();
        if !std::thread::panicking() {
            outcome.expect("no panic").expect("no error");
        }
    }
}

/// An answer: its status, its `ETag` and its JSON.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) status: u16,
    pub(crate) tag: String,
    pub(crate) json: Value,
}

impl Answer {
    /// Its status and the code of the error, if there is one.
    pub(crate) fn problem(&self) -> (u16, &str) {
        (self.status, self.json["code"].as_str().unwrap_or_default())
    }

    /// The path of the created object.
    pub(crate) fn made(&self, list: &str) -> String {
        assert_eq!(self.status, 201, "{self:?}");
        format!("{list}/{}", self.json["id"].as_str().expect("an id"))
    }
}

impl Running {
    /// Sends a request with some headers, and posts a body if there is one.
    pub(crate) fn send(
        &self,
        method: &str,
        path: &str,
        headers: &[(&str, &str)],
        body: &[u8],
    ) -> Answer {
        let config = ureq::Agent::config_builder()
            .http_status_as_error(false)
            .allow_non_standard_methods(true)
            .timeout_global(Some(std::time::Duration::from_mins(1)))
            .build();
        let agent: ureq::Agent = config.into();
        let mut request =
            ureq::http::Request::builder().method(method).uri(format!("{}{path}", self.url));
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        let request = request.body(body.to_vec()).expect("a request");
        let mut answer = agent.run(request).expect("the service answers");
        let tag = answer.headers().get("etag").and_then(|tag| tag.to_str().ok());
        let tag = tag.unwrap_or_default().to_owned();
        let text = answer.body_mut().read_to_vec().expect("a body");
        let json = serde_json::from_slice(&text)
            .unwrap_or_else(|_| String::from_utf8_lossy(&text).into_owned().into());
        Answer { status: answer.status().as_u16(), tag, json }
    }

    pub(crate) fn get(&self, path: &str) -> Answer {
        self.send("GET", path, &[], b"")
    }

    pub(crate) fn post(&self, path: &str, body: &Value) -> Answer {
        self.send("POST", path, &[], body.to_string().as_bytes())
    }

    /// Makes a day of `paper`, and returns its path.
    pub(crate) fn new_day(&self, policy: &str) -> String {
        let body = json!({"network": "paper", "seed": 3, "policy": policy});
        self.post("/v1/days", &body).made("/v1/days")
    }

    /// Sends an event to a day, or several.
    pub(crate) fn event(&self, day: &str, event: &Value) -> Answer {
        self.post(&format!("{day}/events"), event)
    }

    /// Posts a decision on a day.
    pub(crate) fn decide(&self, day: &str, asked: &Value) -> Answer {
        self.post(&format!("{day}/decisions"), asked)
    }

    /// The state of a day.
    pub(crate) fn state(&self, day: &str) -> Value {
        self.get(&format!("{day}/state")).json
    }
}

/// A folder for data.
pub(crate) fn folder() -> (TempDir, Location) {
    let folder = tempfile::tempdir().expect("a folder");
    let location = Location::Folder(folder.path().to_owned());
    (folder, location)
}

/// A factory of tokens for the service of a folder: it returns the header value of a token with a
/// name and a role.
pub(crate) fn bearers(location: &Location) -> impl Fn(&str, Role) -> String + use<> {
    let tokens = Tokens::open(location).expect("a store");
    move |name, role| format!("Bearer {}", tokens.make(name, role).expect("a token"))
}
