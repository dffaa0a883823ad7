//! Spans of requests for OpenTelemetry: path, outcome and duration, sent to a collector.
//!
//! A span contains the method, the path in the description, and the status. Of the client's data it
//! contains only the number of the trace that the request belongs to (`traceparent`, W3C): no ids,
//! no tokens, no bodies. A thread of the library sends spans in batches, so an unreachable
//! collector delays no request; spans that it does not accept are dropped.

use std::env;
use std::future::{Future, ready};
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use axum::http::{HeaderMap, Request, Response, StatusCode};
use bytes::Bytes;
use opentelemetry::propagation::{Extractor, TextMapPropagator as _};
use opentelemetry::trace::{Span as _, SpanBuilder, SpanKind, Status, Tracer as _};
use opentelemetry::trace::{TraceId, TracerProvider as _};
use opentelemetry::{Context, KeyValue};
use opentelemetry_http::{HttpClient, HttpError};
use opentelemetry_otlp::{Protocol, SpanExporter, WithExportConfig as _, WithHttpConfig as _};
use opentelemetry_sdk::Resource;
use opentelemetry_sdk::propagation::TraceContextPropagator;
use opentelemetry_sdk::resource::{EnvResourceDetector, TelemetryResourceDetector};
use opentelemetry_sdk::trace::{SdkTracer, SdkTracerProvider, Span};
use ureq::Agent;

use crate::error::Error;

/// The default name of the service in spans.
const NAME: &str = "vertifleet";
const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Time limit of the collector for a batch.
const EXPORT_TIMEOUT: Duration = Duration::from_secs(10);
/// Time limit of the collector for the last spans when the service stops.
const LAST_PATIENCE: Duration = Duration::from_secs(3);
/// Longest answer of a collector that is read.
const LONGEST_ANSWER: u64 = 64 << 10;

/// Creates spans and sends them.
#[derive(Debug)]
pub(crate) struct Spans {
    provider: SdkTracerProvider,
    tracer: SdkTracer,
    callers: TraceContextPropagator,
}

/// The span of a request in progress. It ends when it is dropped, at the latest.
#[derive(Debug)]
pub(crate) struct RequestSpan(Span);

impl Spans {
    /// Spans that are sent to the collector at an address such as `http://127.0.0.1:4318`. The
    /// variables of OpenTelemetry for headers, the name of the service and sampling apply
    /// (`OTEL_EXPORTER_OTLP_HEADERS` and so on).
    ///
    /// # Errors
    /// Returns [`Error::BadCollector`] if the address is not an HTTP address, or if a variable
    /// requires a feature that is not available.
    pub(crate) fn to(collector: &str) -> Result<Self, Error> {
        let bad = |rule: String| Error::BadCollector { address: collector.to_owned(), rule };
        let address = collector.trim_end_matches('/');
        if !["http://", "https://"].into_iter().any(|scheme| address.starts_with(scheme)) {
            return Err(bad("it must begin with http:// or https://".to_owned()));
        }
        let exporter = SpanExporter::builder()
            .with_http()
            .with_http_client(Collector::new())
            .with_protocol(Protocol::HttpBinary)
            .with_endpoint(format!("{address}/v1/traces"))
            .build()
            .map_err(|error| bad(error.to_string()))?;
        let provider = SdkTracerProvider::builder()
            .with_batch_exporter(exporter)
            .with_resource(described())
            .build();
        let tracer = provider.tracer(NAME);
        Ok(Self { provider, tracer, callers: TraceContextPropagator::new() })
    }

    /// Begins the span of a request, within the trace that its caller names. `path` is the path in
    /// the description, or `None` if it is not there.
    pub(crate) fn begin(
        &self,
        method: &str,
        path: Option<&str>,
        headers: &HeaderMap,
    ) -> RequestSpan {
        let caller = self.callers.extract_with_context(&Context::new(), &Caller(headers));
        let mut told = vec![KeyValue::new("http.request.method", method.to_owned())];
        told.extend(path.map(|path| KeyValue::new("http.route", path.to_owned())));
        let name = path.map_or_else(|| method.to_owned(), |path| format!("{method} {path}"));
        let span = SpanBuilder::from_name(name).with_kind(SpanKind::Server).with_attributes(told);
        RequestSpan(self.tracer.build_with_context(span, &caller))
    }

    /// Sends the spans that have not been sent. Spans that end later are lost.
    pub(crate) fn flush(&self) {
        // `send_bytes` has warned already if the collector does not answer.
        let _ = self.provider.shutdown_with_timeout(LAST_PATIENCE);
    }
}

impl RequestSpan {
    /// The number of the trace, for the log.
    pub(crate) fn trace(&self) -> TraceId {
        self.0.span_context().trace_id()
    }

    /// Ends the span with the status of the answer and the code of the error.
    pub(crate) fn end(mut self, status: StatusCode, code: Option<String>) {
        let number = i64::from(status.as_u16());
        self.0.set_attribute(KeyValue::new("http.response.status_code", number));
        if let Some(code) = code {
            self.0.set_attribute(KeyValue::new("error.type", code));
        }
        // An error of the client is no failure of the service.
        if status.is_server_error() {
            self.0.set_status(Status::error(""));
        }
    }
}

/// The sender of spans: the program and its version, and the attributes of the environment.
fn described() -> Resource {
    let ours = [KeyValue::new("service.name", NAME), KeyValue::new("service.version", VERSION)];
    let resource = Resource::builder_empty()
        .with_attributes(ours)
        .with_detector(Box::new(TelemetryResourceDetector))
        .with_detector(Box::new(EnvResourceDetector::new()));
    match env::var("OTEL_SERVICE_NAME") {
        Ok(name) if !name.is_empty() => resource.with_service_name(name).build(),
        _ => resource.build(),
    }
}

/// The trace that a request belongs to, from its headers. `tracestate`, which may be long, is not
/// sent on and is left out.
struct Caller<'a>(&'a HeaderMap);

impl Extractor for Caller<'_> {
    fn get(&self, name: &str) -> Option<&str> {
        let is_known = name == "traceparent";
        self.0.get(name).filter(|_| is_known).and_then(|value| value.to_str().ok())
    }

    fn keys(&self) -> Vec<&str> {
        vec!["traceparent"]
    }
}

/// Sends batches to the collector, on the library's thread. Logs once when they are refused, and
/// once when they are accepted again.
#[derive(Debug)]
struct Collector {
    agent: Agent,
    is_away: AtomicBool,
}

impl Collector {
    fn new() -> Self {
        let agent = Agent::config_builder()
            .http_status_as_error(false)
            .timeout_global(Some(EXPORT_TIMEOUT))
            .user_agent(format!("{NAME}/{VERSION}"))
            .build();
        Self { agent: agent.into(), is_away: AtomicBool::new(false) }
    }

    fn send(&self, batch: Request<Bytes>) -> Result<Response<Bytes>, ureq::Error> {
        let (head, body) = batch.into_parts();
        let answer = self.agent.run(Request::from_parts(head, body.to_vec()))?;
        let (head, mut body) = answer.into_parts();
        let body = body.with_config().limit(LONGEST_ANSWER).read_to_vec()?;
        Ok(Response::from_parts(head, body.into()))
    }

    fn watch(&self, outcome: &Result<Response<Bytes>, ureq::Error>) {
        let failure = match outcome {
            Ok(answer) if answer.status().is_success() => None,
            Ok(answer) => Some(format!("it answered {}", answer.status())),
            Err(error) => Some(error.to_string()),
        };
        let was_away = self.is_away.swap(failure.is_some(), Ordering::Relaxed);
        match failure {
            Some(error) if !was_away => {
                tracing::warn!(error, "the collector does not take spans; they are dropped");
            }
            None if was_away => tracing::warn!("the collector takes spans again"),
            _ => {}
        }
    }
}

impl HttpClient for Collector {
    fn send_bytes<'a, 'b>(
        &'a self,
        batch: Request<Bytes>,
    ) -> Pin<Box<dyn Future<Output = Result<Response<Bytes>, HttpError>> + Send + 'b>>
    where
        'a: 'b,
        Self: 'b,
    {
        let outcome = self.send(batch);
        self.watch(&outcome);
        Box::pin(ready(outcome.map_err(Into::into)))
    }
}
