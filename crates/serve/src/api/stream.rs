//! The stream of a day's events (server-sent events).

mod position;

use std::convert::Infallible;
use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::body::Bytes;
use axum::extract::State;
use axum::http::{HeaderMap, HeaderName, HeaderValue, header};
use axum::response::{IntoResponse, Response};
use bytes::BytesMut;
use serde::Deserialize;
use tokio::sync::broadcast::Receiver;
use tokio::sync::broadcast::error::RecvError;
use tokio::sync::watch;
use utoipa::IntoParams;

use self::position::Position;
use super::answer::Times;
use super::extract::{EventNumber, Named, Validated};
use crate::day_cell::{DayCell, Published};
use crate::error::Error;
use crate::mark::EventMark;
use crate::service::Service;
use crate::store::Store;
use crate::taken_event::TakenEvent;
use crate::tokens::Role;

/// Events that are read from the store at once. They are written between other requests, so they
/// are few.
const PAGE: u32 = 250;

/// Interval at which a stream checks that its token is still valid and its day is still in memory.
const POLL_INTERVAL: Duration = Duration::from_millis(250);

/// Time without an event after which the service sends an empty line. It shows the reader that the
/// service is alive, and stops proxies from closing the stream.
const KEEP_ALIVE: Duration = Duration::from_secs(2);

/// The query of a stream.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(crate) struct From {
    /// Events after this number; `Last-Event-ID` takes precedence over it. If the day has no event
    /// of this number, the answer is 404 (V602).
    #[param(inline)]
    after: Option<EventNumber>,
    /// How times are written in the events.
    #[serde(default)]
    times: Times,
}

/// A reader of a day's events. It reads older events, and those that it missed because it was slow,
/// from the store; it receives the rest when they are stored.
struct Reader {
    day: Arc<DayCell>,
    store: Store,
    fresh: Receiver<Arc<Published>>,
    position: Position,
    stopping: watch::Receiver<bool>,
    service: Arc<Service>,
    /// The sender's token, to check whether it is still valid.
    headers: HeaderMap,
    looked: Instant,
    /// When something was last sent.
    said: Instant,
    times: Times,
}

/// The event that a reader received last.
fn last_event(headers: &HeaderMap) -> Result<Option<EventMark>, Error> {
    let Some(id) = headers.get("last-event-id") else { return Ok(None) };
    let wrong = || Error::BadRequest {
        rule: "Last-Event-ID must be the number of an event, or its mark".to_owned(),
    };
    id.to_str().ok().and_then(EventMark::parse).map(Some).ok_or_else(wrong)
}

impl Drop for Reader {
    fn drop(&mut self) {
        self.service.days.metrics.streams.dec();
    }
}

/// Streams the events of a day after `Last-Event-ID`, each with its number as `id`. A message of
/// the type `behind` reports that the reader was too slow; the events that it missed follow.
#[utoipa::path(
    operation_id = "stream_events", get, path = "/v1/days/{day}/stream", tag = "events", params(("day" = String, Path), From),
    responses((status = 200, content_type = "text/event-stream", body = TakenEvent))
)]
pub(super) async fn stream(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    Validated(From { after, times }): Validated<From>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let most = service.limits.streams;
    if service.days.metrics.streams.get() >= i64::try_from(most).unwrap_or(i64::MAX) {
        return Err(Error::TooMuch { what: "streams", most: most as u64 });
    }
    let day = service.days.get(&day).await?;
    let fresh = day.subscribe();
    let EventNumber(seq) = after.unwrap_or_default();
    let after = last_event(&headers)?.unwrap_or(EventMark { seq, chain: None });
    service.days.check_mark(&day, after).await?;
    times.check(&day)?;
    let store = service.days.store.clone();
    let stopping = service.stopping.subscribe();
    service.days.metrics.streams.inc();
    let looked = Instant::now();
    let reader = Reader {
        day,
        store,
        fresh,
        position: Position::after(after),
        stopping,
        service,
        headers,
        looked,
        said: looked,
        times,
    };
    let text = futures_util::stream::unfold(reader, |mut reader| async {
        let text = reader.next().await?;
        Some((Ok::<_, Infallible>(text), reader))
    });
    let headers = [
        (header::CONTENT_TYPE, HeaderValue::from_static("text/event-stream")),
        // Proxies such as nginx would otherwise collect events before they pass them on.
        (HeaderName::from_static("x-accel-buffering"), HeaderValue::from_static("no")),
    ];
    Ok((headers, axum::body::Body::from_stream(text)).into_response())
}

impl Reader {
    /// All available next events as text; `None` if the day can no longer be read.
    async fn next(&mut self) -> Option<Bytes> {
        loop {
            if self.looked.elapsed() >= POLL_INTERVAL {
                self.renew().await?;
            }
            let mut text = BytesMut::new();
            if self.position.is_behind() {
                let seq = self.position.mark().seq;
                let page = self.store.events(self.day.id(), seq, PAGE).await.ok()?;
                self.position.read(&page);
                for event in &page.events {
                    text.extend_from_slice(&self.message(event));
                }
            } else {
                let fresh = tokio::select! {
                    fresh = self.fresh.recv() => Some(fresh),
                    () = tokio::time::sleep(POLL_INTERVAL) => None,
                    _ = self.stopping.wait_for(|&stops| stops) => return None,
                };
                if let Some(fresh) = fresh {
                    self.take(fresh, &mut text)?;
                }
                // Events that arrived in the meantime are sent together: with many readers, a write
                // for each event would be the largest cost.
                while !self.position.is_behind()
                    && let Ok(event) = self.fresh.try_recv()
                {
                    self.take(Ok(event), &mut text)?;
                }
            }
            if text.is_empty() && self.said.elapsed() >= KEEP_ALIVE {
                text.extend_from_slice(b":\n\n");
            }
            if !text.is_empty() {
                self.said = Instant::now();
                return Some(text.freeze());
            }
        }
    }

    /// Takes a message of the day to its readers; `None` if there will be no more.
    fn take(
        &mut self,
        fresh: Result<Arc<Published>, RecvError>,
        text: &mut BytesMut,
    ) -> Option<()> {
        match fresh {
            Ok(told) if self.position.take(&told.event) => match self.times {
                Times::Clock => {
                    let shown = told.shown.get_or_init(|| self.message(&told.event));
                    text.extend_from_slice(shown);
                }
                Times::Iso => text.extend_from_slice(&self.message(&told.event)),
            },
            Ok(_) => {}
            Err(RecvError::Lagged(missed)) => {
                self.position.has_missed_events();
                let said = format!(
                    "event: behind\ndata: {missed} events came faster than they were read; they follow\n\n"
                );
                text.extend_from_slice(said.as_bytes());
            }
            Err(RecvError::Closed) => return None,
        }
        Some(())
    }

    /// Checks whether the reader may still read. If the day in memory was discarded, continues with
    /// its replacement; `None` if there is none, or if its log is another one.
    async fn renew(&mut self) -> Option<()> {
        self.looked = Instant::now();
        self.service.access.may(&self.headers, Role::Read).await.ok()?;
        if self.day.is_spoilt() {
            self.day = self.service.days.get(self.day.id()).await.ok()?;
            let mark = self.position.mark();
            self.service.days.check_mark(&self.day, mark).await.ok()?;
            self.fresh = self.day.subscribe();
            self.position = Position::after(mark);
        }
        Some(())
    }

    /// An event as a message of the stream.
    fn message(&self, event: &TakenEvent) -> Bytes {
        let write = || Ok(serde_json::to_string(event).expect("plain data can be written"));
        let data = self.times.of(&self.day, write).expect("times were checked");
        format!("id: {}\ndata: {data}\n\n", event.seq).into()
    }
}
