//! The metrics of the service, for Prometheus.

use prometheus_client::encoding::text::encode;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::metrics::histogram::{Histogram, exponential_buckets};
use prometheus_client::metrics::info::Info;
use prometheus_client::registry::Registry;

use crate::clock::now_ms;

/// Names with values, which identify a series of a metric.
type Labels<const N: usize> = [(&'static str, String); N];

/// The metrics.
#[derive(Debug)]
pub(crate) struct Metrics {
    registry: Registry,
    requests: Family<Labels<3>, Counter>,
    request_seconds: Family<Labels<2>, Histogram>,
    decision_seconds: Family<Labels<1>, Histogram>,
    /// Events that were stored.
    pub(crate) events: Counter,
    /// Writes to the disk, each with all waiting events.
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

    /// Counts a request that was answered. `path` is the one in the description.
    pub(crate) fn answered(&self, method: &str, path: &str, status: u16, seconds: f64) {
        let (method, path) = (("method", method.to_owned()), ("path", path.to_owned()));
        let of_path = [method.clone(), path.clone()];
        self.request_seconds.get_or_create(&of_path).observe(seconds);
        self.requests.get_or_create(&[method, path, ("status", status.to_string())]).inc();
    }

    /// Counts a decision.
    pub(crate) fn decided(&self, policy: &str, seconds: f64) {
        self.decision_seconds.get_or_create(&[("policy", policy.to_owned())]).observe(seconds);
    }

    /// All metrics in Prometheus's text format.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        encode(&mut text, &self.registry).expect("memory takes everything");
        text
    }
}
