//! Appends and lists the events of a day.

use std::sync::Arc;

use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use utoipa::{IntoParams, ToSchema};

use super::answer::{Times, at_event, json};
use super::extract::{EventNumber, Named, PageSize, Validated, parse, parse_any, without_mark};
use super::write::Idempotent;
use crate::access::Actor;
use crate::days::last_seq;
use crate::error::Error;
use crate::event::{Event, EventKind};
use crate::moment::by_calendar;
use crate::notice::EventNotice;
use crate::service::Service;
use crate::taken_event::TakenEvent;

/// Largest number of events in a request.
pub(super) const MOST_EVENTS: usize = 1_000;

/// Largest page of events that is read at once, without waiting for a turn.
const SHORT_PAGE: u32 = 250;

/// One event, or several that are applied together or not at all.
#[derive(Debug, Serialize, ToSchema)]
#[serde(untagged)]
enum OneOrMore {
    /// Several.
    More(Vec<Event>),
    /// One.
    One(Event),
}

impl OneOrMore {
    /// Parses a body. Its first character decides between the two, so that a message names the
    /// error inside.
    fn parse(body: &[u8]) -> Result<Self, Error> {
        let body = without_mark(body);
        match body.iter().find(|byte| !byte.is_ascii_whitespace()) {
            Some(b'[') => Self::several(body).map(Self::More),
            _ => parse(body).map(Self::One),
        }
    }

    fn several(body: &[u8]) -> Result<Vec<Event>, Error> {
        let raw: Vec<Box<RawValue>> = parse_any(body)?;
        let of = raw.len();
        if of > MOST_EVENTS {
            return Err(too_many());
        }
        let read = |(at, event): (usize, Box<RawValue>)| {
            let event = parse(event.get().as_bytes());
            event.map_err(|cause| Error::InList { number: at + 1, of, cause: Box::new(cause) })
        };
        raw.into_iter().enumerate().map(read).collect()
    }

    fn events(self) -> Vec<Event> {
        match self {
            Self::More(events) => events,
            Self::One(event) => vec![event],
        }
    }
}

/// Checks that a client does not claim that a policy has decided; only the service records that.
fn check_who_decided(events: &[Event]) -> Result<(), Error> {
    let claims = |event: &Event| match &event.what {
        EventKind::Decided { policy, instead_of, .. } => policy.is_some() || instead_of.is_some(),
        _ => false,
    };
    if events.iter().any(claims) {
        let rule = "only the service sets `policy` and `instead_of`: leave them out";
        return Err(Error::BadRequest { rule: rule.to_owned() });
    }
    Ok(())
}

fn too_many() -> Error {
    Error::BadRequest { rule: format!("1 to {MOST_EVENTS} events are taken at once") }
}

/// The result of appending events.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct Taken {
    /// The number of the latest event.
    seq: u64,
    /// Notices for people.
    #[schema(value_type = Vec<Vec<EventNotice>>)]
    notices: Vec<Box<RawValue>>,
}

impl Taken {
    fn of(events: &[TakenEvent]) -> Self {
        Self { seq: last_seq(events), notices: events.iter().map(notices_of).collect() }
    }
}

/// The notices of a new event.
pub(super) fn notices_of(event: &TakenEvent) -> Box<RawValue> {
    RawValue::from_string(event.notices.clone()).expect("it was written as JSON")
}

/// Events of a day.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct EventList {
    /// The events, in order.
    events: Vec<TakenEvent>,
    /// The number to read on after, if there may be more: a page ends at `limit`, or at about 4
    /// MiB.
    next: Option<u64>,
}

/// The query of a list of events.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(crate) struct Page {
    /// Events after this number. If the day has no event of this number, the answer is 404 (V602).
    #[serde(default)]
    #[param(inline)]
    after: EventNumber,
    /// Largest number of events, at most 10,000; without it, 1,000. A page has fewer if they are
    /// long.
    #[param(inline)]
    limit: Option<PageSize<10_000>>,
    /// How times are written in the answer.
    #[serde(default)]
    times: Times,
}

/// Applies an event, or several together or not at all. They are durable before the answer is sent.
#[utoipa::path(
    operation_id = "add_events", post, path = "/v1/days/{day}/events", tag = "events", params(("day" = String, Path)),
    request_body = OneOrMore,
    responses(
        (status = 201, body = Taken)
    )
)]
pub(super) async fn append(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    Idempotent { writer, body }: Idempotent,
) -> Result<Response, Error> {
    let day = service.days.get(&day).await?;
    let events = by_calendar(day.calendar(), || OneOrMore::parse(&body))?.events();
    check_who_decided(&events)?;
    if events.is_empty() {
        return Err(too_many());
    }
    let taken = service.days.append(&day, writer, events, Taken::of).await?;
    Ok(at_event(StatusCode::CREATED, taken.seq, &taken))
}

/// Lists events.
#[utoipa::path(operation_id = "list_events", get, path = "/v1/days/{day}/events", tag = "events", params(("day" = String, Path), Page), responses((status = 200, body = EventList)))]
pub(super) async fn list(
    State(service): State<Arc<Service>>,
    Named(day): Named<String>,
    actor: Actor,
    Validated(Page { after: EventNumber(after), limit, times }): Validated<Page>,
) -> Result<Response, Error> {
    let PageSize(limit) = limit.unwrap_or(PageSize(1_000));
    let day = service.days.get(&day).await?;
    day.check_begun(after)?;
    let store = service.days.store.clone();
    let page = async move {
        let page = store.events(day.id(), after, limit).await?;
        let next = page.events.last().filter(|_| !page.is_last).map(|event| event.seq);
        times.of(&day, || Ok(json(StatusCode::OK, &EventList { events: page.events, next })))
    };
    if limit <= SHORT_PAGE {
        return page.await;
    }
    service.turns.readings.run(&actor, page).await
}
