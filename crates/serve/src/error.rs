//! The errors of the service, with stable codes (V6xx) and their HTTP status.

mod codes;
mod status;

use std::path::PathBuf;

use vertifleet_policy::PolicyError;
use vertifleet_sim::live::ReportError;

use crate::latest_events::Happened;

/// An expected error of the service. Messages are fragments for people;
/// [`code`](vertifleet_core::Coded::code) is for programs and for the error index.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A network, a scenario or a file (V1xx); the error is one of `vertifleet-core`.
    #[error(transparent)]
    Core(#[from] vertifleet_core::Error),

    /// A policy (V3xx, V4xx); the error is one of `vertifleet-study`.
    #[error(transparent)]
    Study(#[from] vertifleet_study::Error),

    /// V601 request not understood. The service received JSON that is not well-formed, a member
    /// that is missing, unknown or of the wrong type, or a value out of bounds. The message names
    /// it.
    ///
    /// Fix: send a request that matches [the description of the API](api.md).
    #[error("the request is not understood: {rule}")]
    BadRequest {
        /// The cause.
        rule: String,
    },

    /// V602 no such thing. There is no day, network, policy, event, token or path of this name.
    ///
    /// Fix: list the existing ones, for example with `GET /v1/days`. If it is an event that the
    /// client has read before, the day was restored from an older copy: read its state again.
    #[error("there is no {what} {id:?}")]
    NotFound {
        /// The kind of thing.
        what: &'static str,
        /// Its id.
        id: String,
    },

    /// There is no such event yet. Cause: a wrong number, or the day was restored from a copy that
    /// is older than the client's state. Fix: read the state of the day again.
    #[error("there is no event {asked}: the day is at event {last}")]
    NoSuchEvent {
        /// The requested number.
        asked: u64,
        /// The number of the latest event.
        last: u64,
    },

    /// V631 another log. A stream is to continue after an event that is not in the log of the day.
    /// The day was restored from a copy, and may have continued since, so that other events have
    /// the numbers that the client has read.
    ///
    /// Fix: read the day again from its first event. The console does so automatically.
    #[error("event {mark} is not in the log of the day")]
    OtherLog {
        /// The mark of the event that the client has read.
        mark: String,
    },

    /// V603 no such aircraft or vertiport. An event, a decision or a question names an aircraft, a
    /// vertiport or a demand period that the day does not have.
    ///
    /// Fix: use the ids of the day's scenario; `GET /v1/days/{day}/state` lists them.
    #[error("the day has no {what} {id:?}")]
    UnknownId {
        /// Aircraft or vertiport.
        what: &'static str,
        /// The id.
        id: String,
    },

    /// V604 the event is not possible on this day. A decision breaks a rule, or an event
    /// contradicts earlier ones: an aircraft that stands cannot land.
    ///
    /// Fix: the message names the rule. If the event did happen, report first the events that led
    /// to it.
    #[error("{0}")]
    ReportError(#[from] ReportError),

    /// An event of several, with the code of its error.
    #[error("event {number} of {of}: {cause}")]
    InList {
        /// Its number in the list, from 1.
        number: usize,
        /// The number of events in the list.
        of: usize,
        /// Its error.
        cause: Box<Error>,
    },

    /// An event or a decision that another event made impossible, with the code of its error.
    #[error("{cause}; {happened}")]
    Overtaken {
        /// Its error.
        cause: Box<Error>,
        /// The event that came first.
        happened: Box<Happened>,
    },

    /// V632 the event cannot be corrected. There is no such earlier event, it was corrected before,
    /// it is itself a correction, or a later event is not possible without it.
    ///
    /// Fix: the message names the reason. Correct later events that depend on it first, the latest
    /// one first.
    #[error("{0}")]
    CannotCorrect(ReportError),

    /// V605 the day has changed. The request was made for an earlier state (`If-Match`), and
    /// another client has added an event since.
    ///
    /// Fix: read the day again, and decide again.
    #[error("the day is at event {found}, and the request was made for event {expected}")]
    Moved {
        /// The sequence number in the request.
        expected: u64,
        /// The day's sequence number.
        found: u64,
    },

    /// V606 the store failed. The disk is full or broken, permissions are missing, or the database
    /// does not answer within 5 seconds. No acknowledged event is lost; a write that was sent to a
    /// hanging database may still be stored.
    ///
    /// Fix: the message contains the error of the store. Send the request again with the same
    /// `Idempotency-Key` once the store works.
    #[error("the store failed: {cause}")]
    Store {
        /// The error of the store.
        cause: String,
    },

    /// The database hangs: it holds its connections and does not answer. It may still store the
    /// write later. Fix: send the request again with its `Idempotency-Key` once the database
    /// answers.
    #[error(
        "the store failed: the database has not answered for {s} s; the write may still be stored"
    )]
    StoreHangs {
        /// For how long, seconds.
        s: u64,
    },

    /// V607 data cannot be read. A newer program wrote the data, another program wrote it, or bytes
    /// in it were changed. The beginning of a day has a checksum, and each event has one over
    /// itself and those before.
    ///
    /// Fix: use the newer program, name the right folder or file, or restore a copy of the data.
    /// `vertifleet serve verify` names the damaged part.
    #[error("the data of the service cannot be read: {rule}")]
    BadData {
        /// The cause.
        rule: String,
    },

    /// Another program or a newer version wrote the data. Fix: use the program that wrote it, or
    /// name the right folder or file.
    #[error("the data of the service cannot be read: {rule}")]
    ForeignData {
        /// The cause.
        rule: String,
    },

    /// V608 day archived. The day was archived, and accepts no more events.
    ///
    /// Fix: reopen it with `POST /v1/days/{day}/unarchive`, which needs the role `admin`, or make a
    /// new day.
    #[error("day {id:?} is archived")]
    Archived {
        /// The day.
        id: String,
    },

    /// V609 idempotency key used twice. An earlier request with the same `Idempotency-Key` was
    /// different.
    ///
    /// Fix: use a new key for each request, and the same one only to send the same request again.
    #[error("the idempotency key {key:?} was used for another request")]
    KeyReused {
        /// The key.
        key: String,
    },

    /// V610 token missing. The service has tokens, and the request came without a valid one.
    ///
    /// Fix: make one with `vertifleet serve token make`, and send it as `Authorization: Bearer
    /// vf_...`.
    #[error("the request needs a valid token")]
    NoToken,

    /// V611 cannot listen. The address of `--listen` is in use, or does not belong to this machine.
    ///
    /// Fix: name another address or port.
    #[error("cannot listen on {address}: {cause}")]
    CannotListen {
        /// The address.
        address: String,
        /// The error of the operating system.
        cause: std::io::Error,
    },

    /// V612 too much. A limit of the service was reached; the message names it.
    ///
    /// Fix: send less, or delete days that are over.
    #[error("the service takes at most {most} {what}")]
    TooMuch {
        /// The kind of thing.
        what: &'static str,
        /// The limit.
        most: u64,
    },

    /// V613 the service does not answer. `vertifleet operate` got no answer from the service for
    /// half a minute, or an error.
    ///
    /// Fix: the message contains the service's answer. Check the address, and that `vertifleet
    /// serve` runs there.
    #[error("{url}: {rule}")]
    NoAnswer {
        /// The address.
        url: String,
        /// The cause.
        rule: String,
    },

    /// V614 idempotency key in use. A request with this key is in progress: it was sent again
    /// before the first was answered.
    ///
    /// Fix: wait a moment, and send it again.
    #[error("a request with the idempotency key {key:?} is being carried out")]
    KeyInUse {
        /// The key.
        key: String,
    },

    /// V615 internal error. There is a defect in the program. The log of the service has the
    /// details.
    ///
    /// Fix: report it with the lines of the log.
    #[error("internal error: {cause}")]
    Internal {
        /// The cause.
        cause: String,
    },

    /// V616 wrong method. The path does not support this HTTP method.
    ///
    /// Fix: use one that [the description of the API](api.md) lists for the path.
    #[error("the path does not take {method}")]
    NotAllowed {
        /// The method.
        method: String,
    },

    /// V617 what-if contradicts the past. A what-if has fewer stands than the day has already used,
    /// so an earlier event would have been impossible.
    ///
    /// Fix: request a change under which every event so far was possible.
    #[error("the change contradicts an earlier event: {rule}")]
    Contradiction {
        /// The event, and why it was not possible.
        rule: String,
    },

    /// V618 role does not permit this. The token's role does not permit the request.
    ///
    /// Fix: use a token with the role that the message names.
    #[error("a token with the role {role:?} does not permit this; {needed:?} does")]
    NotPermitted {
        /// The token's role.
        role: &'static str,
        /// The role that is needed.
        needed: &'static str,
    },

    /// V619 address not protected. `--listen` names an address that other machines can reach, and
    /// connections are not encrypted, or there is no token.
    ///
    /// Fix: listen on 127.0.0.1. Or put a proxy with TLS in front of the service, give
    /// `--behind-proxy`, and make a token.
    #[error("other machines can reach {address}: {missing}")]
    Unprotected {
        /// The address.
        address: String,
        /// What is missing.
        missing: &'static str,
    },

    /// V620 folder in use. Another `vertifleet serve` uses the folder of `--data`.
    ///
    /// Fix: stop the other one, name another folder, or let both use a PostgreSQL database.
    #[error("{}: another service uses this folder", folder.display())]
    InUse {
        /// The folder.
        folder: PathBuf,
    },

    /// V623 too many requests. A token sent more requests in a second than the limit: one client
    /// polls too often, or many clients share one token. Requests without a valid token are counted
    /// together.
    ///
    /// Fix: wait a second, poll less often, and give each client a separate token. A client that
    /// follows a day reads its stream instead of polling its state.
    #[error("{who} sent more than {most} requests in a second")]
    TooOften {
        /// The token's name.
        who: String,
        /// The limit.
        most: u32,
    },

    /// V624 unusable certificate. A file of `--certificate`, `--key` or `--trust` cannot be read,
    /// is no PEM file, or the key belongs to another certificate.
    ///
    /// Fix: name the certificate with its chain, and its own key, both as PEM files.
    #[error("{}: {rule}", file.display())]
    BadCertificate {
        /// The file.
        file: PathBuf,
        /// The cause.
        rule: String,
    },

    /// V625 unusable collector. `--otlp` or `OTEL_EXPORTER_OTLP_ENDPOINT` is not an HTTP address,
    /// or a variable of OpenTelemetry requests a feature that this program does not have, such as
    /// `OTEL_EXPORTER_OTLP_COMPRESSION`.
    ///
    /// Fix: name the collector as `http://127.0.0.1:4318`, by the port that takes OTLP over HTTP.
    #[error("spans cannot be sent to {address:?}: {rule}")]
    BadCollector {
        /// The address.
        address: String,
        /// The cause.
        rule: String,
    },

    /// V626 unusable base map. `--basemap` is not an HTTP address, or its host is not a plain name
    /// or number.
    ///
    /// Fix: name a style or a PMTiles file as `https://tiles.example.com/style.json`. The program
    /// does not check that it exists; the console keeps the bundled base map if another one cannot
    /// be loaded.
    #[error("the console cannot show the base map {address:?}: {rule}")]
    BadBasemap {
        /// The address.
        address: String,
        /// The cause.
        rule: String,
    },

    /// V627 request of a foreign page. The service has no tokens, so it trusts this machine alone,
    /// and a browser may show a foreign page on it. The request names a host that is not this
    /// machine, or comes from a page of another one.
    ///
    /// Fix: use `http://127.0.0.1:8080` or `http://localhost:8080`. For other addresses make a
    /// token with `vertifleet serve token make`; then only tokens count.
    #[error("the service has no tokens, and the request {what} {named:?}")]
    ForeignPage {
        /// The action of the request.
        what: &'static str,
        /// The host or the origin.
        named: String,
    },

    /// V628 unusable address of a database. `--database` is not an address of PostgreSQL.
    ///
    /// Fix: name it as `postgres://user@host/database`.
    #[error("the address of the database must begin with postgres:// or postgresql://")]
    BadDatabase,

    /// V629 token name in use. A token has or had this name, and the audit could not distinguish
    /// two with one name. That includes revoked tokens.
    ///
    /// Fix: choose another name.
    #[error("the name {name:?} was given to another token")]
    NameTaken {
        /// The name.
        name: String,
    },

    /// V630 policy in use. The policy to delete decides on days that are not archived.
    ///
    /// Fix: archive these days, or keep the policy.
    #[error("policy {name:?} decides on {days} days that are not archived")]
    PolicyInUse {
        /// The policy.
        name: String,
        /// The number of days.
        days: i64,
    },

    /// V621 conflict between services. Several services share a database, and another one wrote to
    /// the same day at the same time, repeatedly.
    ///
    /// Fix: send the request again, with the same `Idempotency-Key`.
    #[error("another service wrote to the day at the same time")]
    Conflict,

    /// V622 request too slow. The body of the request arrived too slowly, or the service is
    /// overloaded.
    ///
    /// Fix: send the request again, with the same `Idempotency-Key`.
    #[error("the request took longer than {limit_s} s")]
    TooSlow {
        /// The limit.
        limit_s: u64,
    },
}

impl Error {
    /// A policy that failed, which no policy of the program does.
    pub(crate) fn of_policy(policy: &str, error: &PolicyError) -> Self {
        Self::Internal { cause: format!("policy {policy:?}: {error}") }
    }

    /// The same error with the id of its day.
    pub(crate) fn of_day(self, id: &str) -> Self {
        match self {
            Self::BadData { rule } => Self::BadData { rule: format!("day {id}: {rule}") },
            other => other,
        }
    }

    /// An event that is not possible on a day that begins differently.
    pub(crate) fn of_what_if(self) -> Self {
        match self {
            Self::BadData { rule } => Self::Contradiction { rule },
            other => other,
        }
    }

    /// An unknown id of a day.
    pub(crate) fn unknown(what: &'static str, id: &str) -> Self {
        Self::UnknownId { what, id: id.chars().take(64).collect() }
    }

    /// Something that does not exist.
    pub(crate) fn not_found(what: &'static str, id: &str) -> Self {
        Self::NotFound { what, id: id.chars().take(64).collect() }
    }
}

impl From<sqlx::Error> for Error {
    fn from(error: sqlx::Error) -> Self {
        match &error {
            sqlx::Error::Database(cause) if cause.is_unique_violation() => Self::Conflict,
            _ => Self::Store { cause: error.to_string() },
        }
    }
}
