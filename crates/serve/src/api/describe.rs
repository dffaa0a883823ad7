//! The description of the API (`OpenAPI` 3.1).

use std::collections::BTreeMap;

use utoipa::openapi::header::HeaderBuilder;
use utoipa::openapi::path::{Operation, ParameterBuilder, ParameterIn};
use utoipa::openapi::schema::{AdditionalProperties, Object, ObjectBuilder, OneOf, Type};
use utoipa::openapi::security::{HttpAuthScheme, HttpBuilder, SecurityRequirement, SecurityScheme};
use utoipa::openapi::{ContentBuilder, Ref, RefOr, ResponseBuilder, Schema};
use utoipa::{Modify, OpenApi, openapi as description};

use super::answer::Times;
use super::events::MOST_EVENTS;
use super::{
    day_state, days, decisions, demand, events, ledger, networks, outlooks, policies, service,
    stream, studies,
};
use crate::problem::Problem;

/// The description of the API.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "Vertifleet dispatch service",
        description = "Live days of fleets of electric air taxis: events, decisions with reasons, outlooks.",
        license(name = "MIT OR Apache-2.0")
    ),
    modifiers(&Everywhere),
    components(schemas(Problem, Times)),
    paths(
        service::info, service::healthz, service::readyz, service::metrics, service::described, days::list, days::create, days::read, days::archive, days::unarchive, days::delete, day_state::state,
        days::scenario, days::trace, demand::demand, ledger::ledger, events::list, events::append, decisions::propose, decisions::decide,
        outlooks::outlook, outlooks::what_if, stream::stream, networks::list, networks::read,
        networks::put, networks::delete, networks::validate, policies::list, policies::read,
        policies::put, policies::delete, policies::validate, studies::list, studies::create, studies::read, studies::report, studies::replay,
        studies::delete
    ),
    tags(
        (name = "service", description = "The service itself"),
        (name = "days", description = "Days and their state"),
        (name = "events", description = "Events of a day"),
        (name = "decisions", description = "Decisions and their reasons"),
        (name = "outlooks", description = "Outlooks and what-if comparisons"),
        (name = "networks", description = "Networks from which days are made"),
        (name = "policies", description = "Policies that decide"),
        (name = "studies", description = "Policies compared on many days")
    )
)]
struct Api;

/// The description of the API as indented JSON (`OpenAPI` 3.1).
pub fn openapi() -> String {
    Api::openapi().to_pretty_json().expect("plain data can be written") + "\n"
}

/// The common rules of all paths: errors are problem details, requests may need a token, writes may
/// have a key.
struct Everywhere;

/// The paths that need no token.
const OPEN: [&str; 2] = ["/healthz", "/readyz"];
/// The writes that are carried out once for each key, and those that accept `If-Match`.
const KEYED: [&str; 4] = ["make_day", "add_events", "take_decision", "make_study"];
const MATCHED: [&str; 5] =
    ["add_events", "take_decision", "archive_day", "unarchive_day", "delete_day"];
/// The answers about a day at an event.
const TAGGED: [&str; 9] = [
    "make_day",
    "read_day",
    "day_state",
    "day_demand",
    "day_ledger",
    "add_events",
    "take_decision",
    "propose_decision",
    "day_outlook",
];

impl Modify for Everywhere {
    fn modify(&self, api: &mut description::OpenApi) {
        let components = api.components.get_or_insert_default();
        close_events(&mut components.schemas);
        let bearer = HttpBuilder::new().scheme(HttpAuthScheme::Bearer);
        let bearer = bearer.description(Some("A token; not needed until one has been made."));
        components.add_security_scheme("token", SecurityScheme::Http(bearer.build()));
        for (path, item) in &mut api.paths.paths {
            let methods = [&mut item.get, &mut item.post, &mut item.put, &mut item.delete];
            for operation in methods.into_iter().flatten() {
                complete(operation);
                if !OPEN.contains(&path.as_str()) {
                    let none: [String; 0] = [];
                    operation.security = Some(vec![
                        SecurityRequirement::new("token", none),
                        SecurityRequirement::default(),
                    ]);
                }
            }
        }
    }
}

/// States that events and routes have no other members, and how long lists of events may be. The
/// derived schema of an event consists of two parts, and neither could forbid other members without
/// forbidding those of the other part.
fn close_events(schemas: &mut BTreeMap<String, RefOr<Schema>>) {
    let (Some(RefOr::T(Schema::AllOf(parts))), Some(RefOr::T(Schema::OneOf(mut kinds)))) =
        (schemas.get("Event").cloned(), schemas.remove("EventKind"))
    else {
        unreachable!("an event has a time and is one of several kinds")
    };
    let time = parts.items.into_iter().find_map(|part| match part {
        RefOr::T(Schema::Object(mut timed)) => timed.properties.remove("time"),
        _ => None,
    });
    let time = time.expect("an event may have a time");
    for kind in objects(&mut kinds) {
        kind.properties.insert("time".to_owned(), time.clone());
        kind.additional_properties = Some(Box::new(AdditionalProperties::FreeForm(false)));
    }
    kinds.description = parts.description;
    schemas.insert("Event".to_owned(), Schema::OneOf(kinds).into());
    if let Some(RefOr::T(Schema::OneOf(routes))) = schemas.get_mut("RouteNames") {
        for route in objects(routes) {
            route.additional_properties = Some(Box::new(AdditionalProperties::FreeForm(false)));
        }
    }
    if let Some(RefOr::T(Schema::OneOf(body))) = schemas.get_mut("OneOrMore") {
        for item in &mut body.items {
            if let RefOr::T(Schema::Array(events)) = item {
                (events.min_items, events.max_items) = (Some(1), Some(MOST_EVENTS));
            }
        }
    }
}

/// The object schemas of the alternatives of a schema.
fn objects(one_of: &mut OneOf) -> impl Iterator<Item = &mut Object> {
    one_of.items.iter_mut().filter_map(|item| match item {
        RefOr::T(Schema::Object(object)) => Some(object),
        _ => None,
    })
}

fn complete(operation: &mut Operation) {
    let problem = ContentBuilder::new().schema(Some(Ref::from_schema_name("Problem"))).build();
    let default = ResponseBuilder::new()
        .description("The error (RFC 9457)")
        .content("application/problem+json", problem)
        .build();
    operation.responses.responses.insert("default".to_owned(), RefOr::T(default));
    for response in operation.responses.responses.values_mut() {
        if let RefOr::T(response) = response
            && response.description.is_empty()
        {
            "The request was carried out".clone_into(&mut response.description);
        }
    }
    let id = operation.operation_id.clone().unwrap_or_default();
    let is = |list: &[&str]| list.contains(&id.as_str());
    let text = || ObjectBuilder::new().schema_type(Type::String);
    if is(&KEYED) {
        let about = "The request is carried out once for each key, however often it is sent.";
        add_header(
            operation,
            "Idempotency-Key",
            about,
            text().min_length(Some(1)).max_length(Some(128)),
        );
    }
    if is(&MATCHED) {
        let about = "The number of the event that the day must be at (an `ETag`); if it is at a later one, nothing changes (412).";
        add_header(operation, "If-Match", about, text().pattern(Some(TAG)));
    }
    if id == "stream_events" {
        let about = "The number of the event that the reader received last, or its `mark`; it takes precedence over `after`. If the \
             log has no event with this mark, the answer is 404 (V631).";
        add_header(operation, "Last-Event-ID", about, text().pattern(Some(MARK)));
    }
    if is(&TAGGED) {
        for (status, response) in &mut operation.responses.responses {
            if let (true, RefOr::T(response)) = (status.starts_with('2'), response) {
                let tag = HeaderBuilder::new()
                    .schema(Some(text().pattern(Some(TAG)).build()))
                    .description(Some("The number of the event that the day is at, in quotes"))
                    .build();
                response.headers.insert("ETag".to_owned(), tag.into());
            }
        }
    }
}

/// The pattern of an event's number in a header.
const TAG: &str = "^\"?[0-9]{1,19}\"?$";
/// The pattern of an event's number or mark.
const MARK: &str = "^[0-9]{1,19}(-[0-9a-f]{8})?$";

fn add_header(operation: &mut Operation, name: &str, about: &str, schema: ObjectBuilder) {
    let parameter = ParameterBuilder::new()
        .name(name)
        .parameter_in(ParameterIn::Header)
        .description(Some(about))
        .schema(Some(schema.build()))
        .build();
    operation.parameters.get_or_insert_default().push(parameter.into());
}
