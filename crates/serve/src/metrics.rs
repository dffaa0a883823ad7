//! What the service measures about itself, for Prometheus.

use std::sync::Arc;
use std::time::Instant;

use axum::extract::{MatchedPath, Request, State};
use axum::http::Method;
use axum::middleware::Next;
use axum::response::Response;
use prometheus_client::encoding::EncodeLabelSet;
use prometheus_client::encoding::text::encode;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::metrics::histogram::{Histogram, exponential_buckets};
use prometheus_client::metrics::info::Info;
use prometheus_client::registry::Registry;
use vertifleet_core::Code;

use crate::clock::now_ms;
use crate::service::Service;

/// A path with a method, as it stands in the description of the API.
#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Path {
    method: String,
    path: String,
}

/// A path with what was answered.
#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Answered {
    method: String,
    path: String,
    status: u16,
}

/// A policy.
#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct ByPolicy {
    policy: String,
}

/// The numbers.
#[derive(Debug)]
pub(crate) struct Metrics {
    registry: Registry,
    requests: Family<Answered, Counter>,
    request_seconds: Family<Path, Histogram>,
    decision_seconds: Family<ByPolicy, Histogram>,
    /// Events that were stored.
    pub(crate) events: Counter,
    /// Writes to the disk, each for all events that waited.
    pub(crate) commits: Counter,
    /// Days in memory.
    pub(crate) days: Gauge,
    /// Readers of streams.
    pub(crate) streams: Gauge,
}

/// From a tenth of a millisecond to about half a minute.
fn times() -> Histogram {
    Histogram::new(exponential_buckets(1e-4, 2.0, 19))
}

impl Default for Metrics {
    fn default() -> Self {
        let metrics = Self {
            registry: Registry::with_prefix("vertifleet"),
            requests: Family::default(),
            request_seconds: Family::new_with_constructor(times),
            decision_seconds: Family::new_with_constructor(times),
            events: Counter::default(),
            commits: Counter::default(),
            days: Gauge::default(),
            streams: Gauge::default(),
        };
        metrics.registered()
    }
}

impl Metrics {
    fn registered(mut self) -> Self {
        let registry = &mut self.registry;
        let version = ("version", env!("CARGO_PKG_VERSION"));
        registry.register("build", "The program", Info::new(vec![version]));
        let started: Gauge = Gauge::default();
        started.set(now_ms() / 1_000);
        let help = "When the service started, seconds of the Unix clock";
        registry.register("start_time_seconds", help, started);
        registry.register("requests", "Requests that were answered", self.requests.clone());
        let help = "Time from a request to its answer";
        registry.register("request_seconds", help, self.request_seconds.clone());
        let help = "Time that a policy took to propose a decision with its reasons";
        registry.register("decision_seconds", help, self.decision_seconds.clone());
        registry.register("events", "Events that were stored", self.events.clone());
        registry.register("commits", "Writes of events to the disk", self.commits.clone());
        registry.register("days_in_memory", "Days in memory", self.days.clone());
        registry.register("streams", "Readers of streams of events", self.streams.clone());
        self
    }

    /// Counts a decision.
    pub(crate) fn decided(&self, policy: &str, seconds: f64) {
        let policy = ByPolicy { policy: policy.to_owned() };
        self.decision_seconds.get_or_create(&policy).observe(seconds);
    }

    /// Everything in Prometheus's text format.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        encode(&mut text, &self.registry).expect("memory takes everything");
        text
    }
}

/// Measures a request. This is the one place where requests are counted, logged, and told to a
/// collector.
pub(crate) async fn measure(
    State(service): State<Arc<Service>>,
    request: Request,
    next: Next,
) -> Response {
    let known = [Method::GET, Method::POST, Method::PUT, Method::DELETE, Method::HEAD];
    // A client that invents methods must not create series.
    let method = request.method();
    let is_known = known.contains(method);
    let method = if is_known { method.as_str() } else { "other" }.to_owned();
    // Paths as they are described, since each id would be a series of its own.
    let path = request.extensions().get::<MatchedPath>().cloned();
    let path = path.as_ref().map(MatchedPath::as_str);
    let span = service.spans.as_ref().map(|spans| {
        let method = if is_known { &method } else { "_OTHER" };
        spans.begin(method, path, request.headers())
    });
    let path = path.unwrap_or("unknown").to_owned();
    let begun = Instant::now();
    let answer = next.run(request).await;
    let took = begun.elapsed();
    let metrics = service.days.metrics();
    let of_path = Path { method: method.clone(), path: path.clone() };
    metrics.request_seconds.get_or_create(&of_path).observe(took.as_secs_f64());
    let answered = Answered { method, path, status: answer.status().as_u16() };
    metrics.requests.get_or_create(&answered).inc();
    let Answered { method, path, status } = answered;
    let code = answer.extensions().get::<Code>().map(Code::to_string);
    let trace = span.as_ref().map(|span| span.trace().to_string());
    tracing::info!(method, path, status, code, trace, took_us = took.as_micros(), "a request");
    if let Some(span) = span {
        span.end(answer.status(), code);
    }
    answer
}
