//! The operator's way to the service: every write has a key and is sent again until it is answered.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Serialize};
use serde_json::json;
use ureq::tls::{Certificate, PemItem, RootCerts, TlsConfig, parse_pem};
use vertifleet_core::Time;
use vertifleet_sim::live::Reporter;

use super::Operation;
use crate::error::Error;
use crate::event::{Event, What};

/// A write is tried again for this long when the service does not answer.
const PATIENCE: Duration = Duration::from_secs(30);

#[derive(Deserialize)]
struct TakenDecision {
    to: String,
}

#[derive(Deserialize)]
struct EventPage {
    events: Vec<TakenEvent>,
}

#[derive(Deserialize)]
struct TakenEvent {
    seq: u64,
    event: Event,
}

/// The certificates in a PEM file.
fn trusted(file: &Path) -> Result<Vec<Certificate<'static>>, Error> {
    let bad = |rule: String| Error::BadCertificate { file: file.to_owned(), rule };
    let bytes = std::fs::read(file).map_err(|error| bad(error.to_string()))?;
    let items: Result<Vec<PemItem<'static>>, _> = parse_pem(&bytes).collect();
    let items = items.map_err(|error| bad(error.to_string()))?;
    let certificate = |item| match item {
        PemItem::Certificate(certificate) => Some(certificate),
        _ => None,
    };
    let certificates: Vec<_> = items.into_iter().filter_map(certificate).collect();
    if certificates.is_empty() {
        return Err(bad("there is no certificate in it".to_owned()));
    }
    Ok(certificates)
}

/// Sends requests, each write with a key of its own, so that it can be sent again.
pub(super) struct Client {
    url: String,
    agent: ureq::Agent,
    /// The beginning of every key, and how many have been used.
    run: String,
    sent: u64,
    pub(super) sent_again: u64,
    /// The number of the latest event that was heard of, and the decisions of others that have not been asked for.
    heard: u64,
    decided: HashMap<String, String>,
    /// The value of the header that carries the token.
    bearer: Option<String>,
}

impl Client {
    pub(super) fn new(operation: &Operation) -> Result<Self, Error> {
        let mut tls = TlsConfig::builder();
        if let Some(file) = &operation.trusted {
            tls = tls.root_certs(RootCerts::new_with_certs(&trusted(file)?));
        }
        let config = ureq::Agent::config_builder()
            .tls_config(tls.build())
            .http_status_as_error(false)
            // Not for the whole request: that would take a thread for looking the address up each time.
            .timeout_connect(Some(PATIENCE))
            .timeout_send_body(Some(PATIENCE))
            .timeout_recv_response(Some(Duration::from_mins(1)))
            .timeout_recv_body(Some(PATIENCE))
            .build();
        let run = std::hash::BuildHasher::hash_one(&std::hash::RandomState::new(), 0_u8);
        Ok(Self {
            url: operation.url.trim_end_matches('/').to_owned(),
            agent: config.into(),
            run: format!("operate-{run:016x}"),
            sent: 0,
            sent_again: 0,
            heard: 0,
            decided: HashMap::new(),
            bearer: operation.token.as_ref().map(|token| format!("Bearer {token}")),
        })
    }

    /// Sends everything that becomes known up to a time.
    pub(super) fn report(
        &mut self,
        day: &str,
        reporter: &mut Reporter,
        until: Time,
    ) -> Result<(), Error> {
        let scenario = Arc::clone(reporter.day().scenario());
        let mut events = Vec::new();
        while let Some((time, report)) = reporter.next_report(until) {
            events.push(Event { time: Some(time.into()), what: What::of(&report, &scenario) });
        }
        for events in events.chunks(1_000) {
            let IgnoredAny = self.post(&format!("/v1/days/{day}/events"), &events)?;
        }
        Ok(())
    }

    /// Has the service decide, and returns where the aircraft flies.
    pub(super) fn decide(
        &mut self,
        day: &str,
        aircraft: &str,
        time: Time,
    ) -> Result<String, Error> {
        let asked = json!({ "aircraft": aircraft, "time": time });
        let taken: TakenDecision = self.post(&format!("/v1/days/{day}/decisions"), &asked)?;
        Ok(taken.to)
    }

    /// Moves the clock of the day on.
    pub(super) fn tell_time(&mut self, day: &str, time: Time) -> Result<(), Error> {
        let event = Event { time: Some(time.into()), what: What::Clock };
        let IgnoredAny = self.post(&format!("/v1/days/{day}/events"), &event)?;
        Ok(())
    }

    /// Where others have decided that an aircraft flies, if they have.
    pub(super) fn decided(&mut self, day: &str, aircraft: &str) -> Result<Option<String>, Error> {
        let page = format!("/v1/days/{day}/events?after={}&limit=1000", self.heard);
        let page: EventPage = self.get(&page)?;
        for TakenEvent { seq, event } in page.events {
            self.heard = seq;
            match event.what {
                What::Decided { aircraft, to, .. } => {
                    self.decided.insert(aircraft, to);
                }
                What::Undone { aircraft, .. } => {
                    self.decided.remove(&aircraft);
                }
                _ => {}
            }
        }
        Ok(self.decided.remove(aircraft))
    }

    pub(super) fn post<T: DeserializeOwned>(
        &mut self,
        path: &str,
        body: &impl Serialize,
    ) -> Result<T, Error> {
        self.sent += 1;
        let key = format!("{}-{}", self.run, self.sent);
        let url = format!("{}{path}", self.url);
        let body = serde_json::to_vec(body).expect("plain data can be written");
        let begun = Instant::now();
        loop {
            let request = self.agent.post(&url).header("idempotency-key", &key);
            let request = match &self.bearer {
                Some(bearer) => request.header("authorization", bearer),
                None => request,
            };
            let sent = request.header("content-type", "application/json").send(&body);
            match sent.and_then(|mut answer| {
                Ok((answer.status().as_u16(), answer.body_mut().read_to_vec()?))
            }) {
                Ok((status, answer)) if status < 300 => return self.read(&answer),
                // The service is starting, stopping or busy with this very request.
                Ok((409 | 503, _)) | Err(_) if begun.elapsed() < PATIENCE => {
                    self.sent_again += 1;
                    thread::sleep(Duration::from_millis(50));
                }
                Ok((status, answer)) => {
                    let text = String::from_utf8_lossy(&answer);
                    return Err(self.wrong(&format!("{path}: {status} {text}")));
                }
                Err(error) => return Err(self.wrong(&error.to_string())),
            }
        }
    }

    pub(super) fn get<T: DeserializeOwned>(&self, path: &str) -> Result<T, Error> {
        let request = self.agent.get(format!("{}{path}", self.url));
        let request = match &self.bearer {
            Some(bearer) => request.header("authorization", bearer),
            None => request,
        };
        let answer = request.call();
        let answer = answer.and_then(|mut answer| answer.body_mut().read_to_vec());
        self.read(&answer.map_err(|error| self.wrong(&error.to_string()))?)
    }

    fn read<T: DeserializeOwned>(&self, answer: &[u8]) -> Result<T, Error> {
        serde_json::from_slice(answer)
            .map_err(|error| self.wrong(&format!("{error} in {}", String::from_utf8_lossy(answer))))
    }

    pub(super) fn wrong(&self, rule: &str) -> Error {
        Error::NoAnswer { url: self.url.clone(), rule: rule.chars().take(1_000).collect() }
    }
}
