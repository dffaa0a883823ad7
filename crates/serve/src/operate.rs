//! The simulated operator: plays a whole day through the public API, as the people and systems of an operator would. It
//! is the demonstration, the load, and the test from end to end.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use ureq::tls::{Certificate, PemItem, RootCerts, TlsConfig, parse_pem};
use vertifleet_core::{Scenario, Stop, Stopped, Time, VertiportIx};
use vertifleet_sim::live::Reporter;
use vertifleet_sim::{DayTotals, Decision};

use crate::error::Error;
use crate::event::{Event, What};

/// A write is tried again for this long when the service does not answer.
const PATIENCE: Duration = Duration::from_secs(30);

/// A day to be operated.
#[derive(Debug, Clone)]
pub struct Operation {
    /// Where the service listens, for example `http://127.0.0.1:8080`.
    pub url: String,
    /// The day, with everything that will happen on it.
    pub day: Arc<Scenario>,
    /// The policy that decides.
    pub policy: String,
    /// The token of the operator, if the service asks for one.
    pub token: Option<String>,
    /// A PEM file with certificates to trust, in place of those of the world.
    pub trusted: Option<PathBuf>,
    /// Seconds of the day that pass in a second; `None` to go as fast as it goes.
    pub speed: Option<f64>,
}

/// What came of a day.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OperationReport {
    /// The id of the day in the service.
    pub day: String,
    /// Its numbers, as the service has them.
    #[serde(flatten)]
    pub totals: DayTotals,
    /// Number of events, decisions among them.
    pub events: u64,
    /// Half of the decisions took at most this long from request to answer, milliseconds.
    pub decision_median_ms: f64,
    /// 99 % of the decisions took at most this long, milliseconds.
    pub decision_p99_ms: f64,
    /// Requests that had to be sent again because the service did not answer.
    pub sent_again: u64,
}

/// Operates a day to its end. `watch` is called with the time of each decision and how long it took.
///
/// # Errors
/// Returns [`Error::NoAnswer`] if the service does not answer or refuses a request.
pub fn operate(
    operation: &Operation,
    stop: &Stop,
    mut watch: impl FnMut(Time, Duration),
) -> Result<Option<OperationReport>, Error> {
    let mut client = Client::new(operation)?;
    let made: Made = client.post("/v1/days", &new_day(operation))?;
    let mut reporter = Reporter::new(&operation.day);
    let begun = Instant::now();
    let start = operation.day.operations.start;
    let mut took = Vec::new();
    while let Some(decision) = reporter.next_decision() {
        if let Err(Stopped) = wait(operation.speed, begun, decision.time.since(start), stop) {
            return Ok(None);
        }
        client.report(&made.id, &mut reporter, decision.time)?;
        let asked = Instant::now();
        let taken = client.decide(&made.id, &operation.day, &decision)?;
        let asked = asked.elapsed();
        took.push(asked.as_secs_f64() * 1e3);
        let all = VertiportIx::all(operation.day.vertiports.len()).zip(&operation.day.vertiports);
        let to = all.into_iter().find(|(_, vertiport)| vertiport.id == taken.to);
        let (to, _) = to.ok_or_else(|| client.wrong("an answer with an unknown vertiport"))?;
        reporter.apply(to).map_err(|refusal| client.wrong(&refusal.to_string()))?;
        watch(decision.time, asked);
    }
    client.report(&made.id, &mut reporter, Time::from_seconds(u32::MAX))?;
    let state: State = client.get(&format!("/v1/days/{}/state", made.id))?;
    took.sort_by(f64::total_cmp);
    let rank = |share: f64| {
        let at = (share * took.len() as f64).ceil();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a rank")]
        let at = (at as usize).saturating_sub(1);
        took.get(at).copied().unwrap_or(0.0)
    };
    Ok(Some(OperationReport {
        day: made.id,
        totals: state.totals,
        events: state.seq,
        decision_median_ms: rank(0.5),
        decision_p99_ms: rank(0.99),
        sent_again: client.sent_again,
    }))
}

/// The day as it is expected, which is all that the service is told of it beforehand.
fn new_day(operation: &Operation) -> Value {
    let scenario: Value = serde_json::from_str(&operation.day.expected().to_json())
        .expect("a scenario is written as JSON");
    json!({ "scenario": scenario, "policy": operation.policy })
}

/// Waits until a time of the day has come.
fn wait(speed: Option<f64>, begun: Instant, day_s: u32, stop: &Stop) -> Result<(), Stopped> {
    loop {
        stop.check()?;
        let Some(speed) = speed else { return Ok(()) };
        let due = Duration::from_secs_f64(f64::from(day_s) / speed);
        let Some(left) = due.checked_sub(begun.elapsed()) else { return Ok(()) };
        thread::sleep(left.min(Duration::from_millis(100)));
    }
}

#[derive(Deserialize)]
struct Made {
    id: String,
}

#[derive(Deserialize)]
struct TakenDecision {
    to: String,
}

#[derive(Deserialize)]
struct State {
    seq: u64,
    totals: DayTotals,
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
struct Client {
    url: String,
    agent: ureq::Agent,
    /// The beginning of every key, and how many have been used.
    run: String,
    sent: u64,
    sent_again: u64,
    /// The value of the header that carries the token.
    bearer: Option<String>,
}

impl Client {
    fn new(operation: &Operation) -> Result<Self, Error> {
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
            bearer: operation.token.as_ref().map(|token| format!("Bearer {token}")),
        })
    }

    /// Sends everything that becomes known up to a time.
    fn report(&mut self, day: &str, reporter: &mut Reporter, until: Time) -> Result<(), Error> {
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

    fn decide(
        &mut self,
        day: &str,
        scenario: &Scenario,
        decision: &Decision,
    ) -> Result<TakenDecision, Error> {
        let aircraft = &scenario.aircraft[decision.aircraft.at()].id;
        let asked = json!({ "aircraft": aircraft, "time": decision.time });
        self.post(&format!("/v1/days/{day}/decisions"), &asked)
    }

    fn post<T: DeserializeOwned>(&mut self, path: &str, body: &impl Serialize) -> Result<T, Error> {
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

    fn get<T: DeserializeOwned>(&self, path: &str) -> Result<T, Error> {
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

    fn wrong(&self, rule: &str) -> Error {
        Error::NoAnswer { url: self.url.clone(), rule: rule.chars().take(1_000).collect() }
    }
}
