//! The operator's client: every write has a key and is repeated until it is answered.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Serialize};
use serde_json::json;
use ureq::http::Response;
use ureq::tls::{Certificate, PemItem, RootCerts, TlsConfig, parse_pem};
use ureq::{Body, RequestBuilder};
use vertifleet_core::{AircraftIx, Time, VertiportIx};
use vertifleet_sim::live::Reporter;

use super::Operation;
use crate::error::Error;
use crate::event::{Event, EventKind};
use crate::ids::Ids;

/// How long a write is repeated when the service does not answer.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(30);
/// Events in one request.
const MOST_EVENTS: usize = 1_000;

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

#[derive(Deserialize)]
struct Taken {
    seq: u64,
}

/// Actions of others on the day.
pub(super) enum Heard {
    /// They decided where an aircraft flies.
    Decided {
        /// The aircraft.
        aircraft: String,
        /// The vertiport.
        to: String,
    },
    /// They took the latest decision of an aircraft back.
    Undone {
        /// The aircraft.
        aircraft: String,
    },
    /// They reported another event.
    Other,
}

/// Everything that becomes known up to a time.
fn events_until(reporter: &mut Reporter, until: Time) -> Vec<Event> {
    let scenario = Arc::clone(reporter.day().scenario());
    std::iter::from_fn(|| reporter.next_report(until))
        .map(|(time, report)| Event {
            time: Some(time.into()),
            what: EventKind::of(&report, &scenario),
        })
        .collect()
}

fn with_token<B>(request: RequestBuilder<B>, bearer: Option<&str>) -> RequestBuilder<B> {
    match bearer {
        Some(bearer) => request.header("authorization", bearer),
        None => request,
    }
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

/// Sends requests; each write has its own key, so that it can be repeated.
pub(super) struct Client {
    url: String,
    agent: ureq::Agent,
    /// The prefix of all keys, and the number of keys used.
    run: String,
    sent: u64,
    pub(super) sent_again: u64,
    /// The number of the latest event that was received, and the later ones that the operator sent.
    heard: u64,
    own: BTreeSet<u64>,
    /// The aircraft of the decisions that were received, by the numbers of their events.
    decided: HashMap<u64, String>,
    /// The value of the header with the token.
    bearer: Option<String>,
    ids: Ids,
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
            // Not a limit for the whole request: that would start a thread for each lookup of the
            // address.
            .timeout_connect(Some(REQUEST_TIMEOUT))
            .timeout_send_body(Some(REQUEST_TIMEOUT))
            .timeout_recv_response(Some(Duration::from_mins(1)))
            .timeout_recv_body(Some(REQUEST_TIMEOUT))
            .build();
        let run = std::hash::BuildHasher::hash_one(&std::hash::RandomState::new(), 0_u8);
        Ok(Self {
            url: operation.url.trim_end_matches('/').to_owned(),
            agent: config.into(),
            run: format!("operate-{run:016x}"),
            sent: 0,
            sent_again: 0,
            heard: 0,
            own: BTreeSet::new(),
            decided: HashMap::new(),
            bearer: operation.token.as_ref().map(|token| format!("Bearer {token}")),
            ids: Ids::of(&operation.day),
        })
    }

    /// Reports everything that becomes known up to a time.
    pub(super) fn report(
        &mut self,
        day: &str,
        reporter: &mut Reporter,
        until: Time,
    ) -> Result<(), Error> {
        for events in events_until(reporter, until).chunks(MOST_EVENTS) {
            let IgnoredAny = self.post(&format!("/v1/days/{day}/events"), &events)?;
        }
        Ok(())
    }

    /// Reports everything that becomes known up to a time, and the time, unless others have added
    /// events that were not received. Returns whether it was sent.
    pub(super) fn report_as_heard(
        &mut self,
        day: &str,
        reporter: &mut Reporter,
        until: Time,
    ) -> Result<bool, Error> {
        let mut events = events_until(reporter, until);
        // An event at that time moves the clock too.
        if events.iter().all(|event| event.time != Some(until.into())) {
            events.push(Event { time: Some(until.into()), what: EventKind::Clock });
        }
        let path = format!("/v1/days/{day}/events");
        let mut heard = Some(self.heard);
        for events in events.chunks(MOST_EVENTS) {
            let taken: Option<Taken> = self.post_if(&path, &events, heard)?;
            let Some(Taken { seq }) = taken else { return Ok(false) };
            self.own.extend(seq + 1 - events.len() as u64..=seq);
            // The first of these events cannot be taken back.
            heard = None;
        }
        Ok(true)
    }

    /// Requests a decision, and returns the destination of the aircraft.
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

    /// The actions of others since the last call, in order.
    pub(super) fn heard(&mut self, day: &str) -> Result<Vec<Heard>, Error> {
        let page = format!("/v1/days/{day}/events?after={}&limit=1000", self.heard);
        let page: EventPage = self.get(&page)?;
        let mut heard = Vec::new();
        for TakenEvent { seq, event } in page.events {
            self.heard = seq;
            if self.own.remove(&seq) {
                continue;
            }
            heard.push(match event.what {
                EventKind::Decided { aircraft, to, .. } => {
                    self.decided.insert(seq, aircraft.clone());
                    Heard::Decided { aircraft, to }
                }
                EventKind::Undone { aircraft, .. } => Heard::Undone { aircraft },
                // A corrected decision is undone too; it cannot have departed.
                EventKind::Corrected { event, .. } => match self.decided.remove(&event) {
                    Some(aircraft) => Heard::Undone { aircraft },
                    None => Heard::Other,
                },
                _ => Heard::Other,
            });
        }
        Ok(heard)
    }

    pub(super) fn post<T: DeserializeOwned>(
        &mut self,
        path: &str,
        body: &impl Serialize,
    ) -> Result<T, Error> {
        let answer = self.post_if(path, body, None)?;
        answer.ok_or_else(|| self.wrong("an answer to a condition that was not made"))
    }

    /// Posts if the day is still at the given event, if any. Returns `None` if it is not.
    fn post_if<T: DeserializeOwned>(
        &mut self,
        path: &str,
        body: &impl Serialize,
        expected: Option<u64>,
    ) -> Result<Option<T>, Error> {
        self.sent += 1;
        let key = format!("{}-{}", self.run, self.sent);
        let url = format!("{}{path}", self.url);
        let body = serde_json::to_vec(body).expect("plain data can be written");
        let (status, answer) = self.answer(|agent, bearer| {
            let request = with_token(agent.post(&url), bearer).header("idempotency-key", &key);
            let request = match expected {
                Some(seq) => request.header("if-match", seq.to_string()),
                None => request,
            };
            request.header("content-type", "application/json").send(&body)
        })?;
        if status == 412 && expected.is_some() {
            return Ok(None);
        }
        self.read(path, status, &answer).map(Some)
    }

    pub(super) fn get<T: DeserializeOwned>(&mut self, path: &str) -> Result<T, Error> {
        let url = format!("{}{path}", self.url);
        let (status, answer) =
            self.answer(|agent, bearer| with_token(agent.get(&url), bearer).call())?;
        self.read(path, status, &answer)
    }

    /// Repeats a request while the service is starting, stopping or busy with the same request.
    fn answer(
        &mut self,
        ask: impl Fn(&ureq::Agent, Option<&str>) -> Result<Response<Body>, ureq::Error>,
    ) -> Result<(u16, Vec<u8>), Error> {
        let begun = Instant::now();
        loop {
            let sent = ask(&self.agent, self.bearer.as_deref());
            match sent.and_then(|mut answer| {
                Ok((answer.status().as_u16(), answer.body_mut().read_to_vec()?))
            }) {
                Ok((409 | 503, _)) | Err(_) if begun.elapsed() < REQUEST_TIMEOUT => {
                    self.sent_again += 1;
                    thread::sleep(Duration::from_millis(50));
                }
                Ok(answer) => return Ok(answer),
                Err(error) => return Err(self.wrong(&error.to_string())),
            }
        }
    }

    fn read<T: DeserializeOwned>(
        &self,
        path: &str,
        status: u16,
        answer: &[u8],
    ) -> Result<T, Error> {
        let text = || String::from_utf8_lossy(answer);
        if status >= 300 {
            return Err(self.wrong(&format!("{path}: {status} {}", text())));
        }
        serde_json::from_slice(answer)
            .map_err(|error| self.wrong(&format!("{error} in {}", text())))
    }

    /// The vertiport with an id from an answer.
    pub(super) fn vertiport(&self, id: &str) -> Result<VertiportIx, Error> {
        self.ids.vertiport(id).map_err(|_| self.wrong("an answer with an unknown vertiport"))
    }

    /// The aircraft with an id from an answer.
    pub(super) fn aircraft(&self, id: &str) -> Result<AircraftIx, Error> {
        self.ids.aircraft(id).map_err(|_| self.wrong("an answer with an unknown aircraft"))
    }

    pub(super) fn wrong(&self, rule: &str) -> Error {
        Error::NoAnswer { url: self.url.clone(), rule: rule.chars().take(1_000).collect() }
    }
}
