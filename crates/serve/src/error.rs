//! The errors of the service, with stable codes (V6xx) and what they mean in HTTP.

use std::path::PathBuf;

use axum::http::StatusCode;
use vertifleet_core::{Code, Coded, Exit};
use vertifleet_policy::PolicyError;
use vertifleet_sim::live::ReportError;

/// An expected error of the service. Messages are fragments for people; [`Coded::code`] is for programs and for the error
/// index.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A network, a scenario or a file (V1xx); the error is one of `vertifleet-core`.
    #[error(transparent)]
    Core(#[from] vertifleet_core::Error),

    /// A policy (V3xx, V4xx); the error is one of `vertifleet-study`.
    #[error(transparent)]
    Study(#[from] vertifleet_study::Error),

    /// V601. A request that is not understood. Cause: JSON that is not well-formed, a member that is missing, unknown or
    /// of the wrong type, or a value out of bounds. Fix: send what the API's description says.
    #[error("the request is not understood: {rule}")]
    BadRequest {
        /// What is wrong.
        rule: String,
    },

    /// V602. There is no such day, network, policy or path. Cause: a wrong id, or a day that was deleted. Fix: list what
    /// there is.
    #[error("there is no {what} {id:?}")]
    NotFound {
        /// What was asked for.
        what: &'static str,
        /// Its id.
        id: String,
    },

    /// V602. There is no such event yet. Cause: a wrong number, or the day was put back from a copy that is older than what
    /// the client has seen. Fix: read the state of the day again.
    #[error("there is no event {asked}: the day is at event {last}")]
    NoSuchEvent {
        /// The number that was asked for.
        asked: u64,
        /// The number of the latest event.
        last: u64,
    },

    /// V631. The log of the day is another one than the client has read. Cause: the day was put back from a copy, and may have
    /// gone on since. Fix: read the day again from its first event.
    #[error("event {mark} is not in the log of the day")]
    OtherLog {
        /// The mark of the event that the client has read.
        mark: String,
    },

    /// V603. The day has no such aircraft or vertiport. Cause: a wrong id. Fix: use the ids of the day's scenario.
    #[error("the day has no {what} {id:?}")]
    UnknownId {
        /// Aircraft or vertiport.
        what: &'static str,
        /// The id.
        id: String,
    },

    /// V604. An event or a decision that the day cannot take. Cause: it breaks a rule, or it contradicts what has been
    /// reported. Fix: the message names the rule.
    #[error("{0}")]
    ReportError(#[from] ReportError),

    /// An event of several, which has the code of what is wrong with it.
    #[error("event {number} of {of}: {cause}")]
    InList {
        /// Its number in the list, from 1.
        number: usize,
        /// The number of events in the list.
        of: usize,
        /// What is wrong with it.
        cause: Box<Error>,
    },

    /// V605. The day has gone on. Cause: another client added an event after the state that the request was made for
    /// (`If-Match`). Fix: read the day again and decide anew.
    #[error("the day is at event {found}, and the request was made for event {expected}")]
    Moved {
        /// The sequence number in the request.
        expected: u64,
        /// The day's sequence number.
        found: u64,
    },

    /// V606. The store cannot be used. Cause: a full or broken disk, missing permissions, or a database that does not
    /// answer. Fix: the message of the store says what failed; nothing that was acknowledged is lost.
    #[error("the store failed: {cause}")]
    Store {
        /// What the store says.
        cause: String,
    },

    /// V606. The database hangs: it holds its connections and does not answer. What it was asked to store may be stored later.
    /// Fix: send the request again with its `Idempotency-Key` once the database answers.
    #[error(
        "the store failed: the database has not answered for {s} s; what it was sent may still be stored"
    )]
    StoreHangs {
        /// For how long, seconds.
        s: u64,
    },

    /// V607. The data belongs to another version of the program, or is damaged. Cause: a newer program wrote it, or bytes
    /// on the disk changed. Fix: use the newer program, or restore a copy; `vertifleet serve verify` names the events.
    #[error("the data of the service cannot be read: {rule}")]
    BadData {
        /// What is wrong.
        rule: String,
    },

    /// V607. The data is that of another program, or of a newer version. Fix: use the program that wrote it, or name the
    /// right folder or file.
    #[error("the data of the service cannot be read: {rule}")]
    ForeignData {
        /// What is wrong.
        rule: String,
    },

    /// V608. The day is closed to writes. Cause: it was archived. Fix: open it again, or make a new day.
    #[error("day {id:?} is archived")]
    Archived {
        /// The day.
        id: String,
    },

    /// V609. The same `Idempotency-Key` came with another request. Cause: a client uses one key twice. Fix: a new key for
    /// each request.
    #[error("the idempotency key {key:?} was used for another request")]
    KeyReused {
        /// The key.
        key: String,
    },

    /// V610. A request without a token that is in force. Cause: no `Authorization: Bearer` header, a wrong token, or one
    /// that was revoked. Fix: make a token with `vertifleet serve token make`, and send it.
    #[error("the request needs a token that is in force")]
    NoToken,

    /// V611. The service cannot listen. Cause: the address is in use, or not of this machine. Fix: name another one.
    #[error("cannot listen on {address}: {cause}")]
    CannotListen {
        /// The address.
        address: String,
        /// What the operating system says.
        cause: std::io::Error,
    },

    /// V612. The service has reached a limit. Cause: more days, events, streams or bytes than it takes. Fix: archive or
    /// delete days, or send less.
    #[error("the service takes at most {most} {what}")]
    TooMuch {
        /// Of what.
        what: &'static str,
        /// The limit.
        most: u64,
    },

    /// V613. The operator cannot go on. Cause: the service at the address does not answer, or answers with an error.
    /// Fix: the message has the service's answer.
    #[error("{url}: {rule}")]
    NoAnswer {
        /// The address.
        url: String,
        /// What went wrong.
        rule: String,
    },

    /// V614. A request with this key is being carried out. Cause: it was sent again before the first was answered. Fix:
    /// wait, and send it again.
    #[error("a request with the idempotency key {key:?} is being carried out")]
    KeyInUse {
        /// The key.
        key: String,
    },

    /// V615. Something that should not happen. Cause: a defect of the program. Fix: report it, with what the log says.
    #[error("something went wrong inside: {cause}")]
    Internal {
        /// What went wrong.
        cause: String,
    },

    /// V616. The path cannot be asked in this way. Cause: a wrong method of HTTP. Fix: use one that the API's description
    /// has for the path.
    #[error("the path does not take {method}")]
    NotAllowed {
        /// The method.
        method: String,
    },

    /// V617. What has happened could not have happened on a day that had begun like this. Cause: a what-if with fewer
    /// stands than the day has used. Fix: ask for a day on which every event so far was possible.
    #[error("the day could not have gone as it did: {rule}")]
    Contradiction {
        /// The event, and why it was not possible.
        rule: String,
    },

    /// V618. A token that does not permit this. Cause: its role. Fix: use a token with the role that the message names.
    #[error("a token with the role {role:?} does not permit this; {needed:?} does")]
    NotPermitted {
        /// The token's role.
        role: &'static str,
        /// The role that is needed.
        needed: &'static str,
    },

    /// V619. An address that others can reach, without protection. Cause: `--listen` names an address beyond this
    /// machine. Fix: name a certificate (`--certificate`, `--key`) or let a proxy that speaks TLS stand before the service
    /// (`--behind-proxy`), and make a token.
    #[error("{address} can be reached by others: {missing}")]
    Unprotected {
        /// The address.
        address: String,
        /// What is missing.
        missing: &'static str,
    },

    /// V620. Another service uses the folder. Cause: a second `vertifleet serve` with the same `--data`. Fix: stop the
    /// other one, name another folder, or let both use a `PostgreSQL` database.
    #[error("{}: another service uses this folder", folder.display())]
    InUse {
        /// The folder.
        folder: PathBuf,
    },

    /// V623. A token sends more requests than it may. Cause: a client that asks again and again, or a token that many
    /// clients use. Fix: wait a second, ask less often, and give each client a token of its own.
    #[error("{who} sent more than {most} requests in a second")]
    TooOften {
        /// The token's name.
        who: String,
        /// The limit.
        most: u32,
    },

    /// V624. A certificate or its key cannot be used. Cause: no such file, no PEM file, or a key of another certificate.
    /// Fix: name the certificate with its chain and its own key, both as PEM files.
    #[error("{}: {rule}", file.display())]
    BadCertificate {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        rule: String,
    },

    /// V625. Spans cannot be sent to the collector that is named. Cause: `--otlp` or `OTEL_EXPORTER_OTLP_ENDPOINT` is no
    /// address of HTTP, or the environment asks for what this program does not have. Fix: name the collector as
    /// `http://127.0.0.1:4318`.
    #[error("spans cannot be sent to {address:?}: {rule}")]
    BadCollector {
        /// The address.
        address: String,
        /// What is wrong.
        rule: String,
    },

    /// V626. The console cannot show this base map. Cause: `--basemap` is no address of HTTP. Fix: name a style or a PMTiles
    /// file as `https://tiles.example.com/style.json`.
    #[error("the console cannot show the base map {address:?}: {rule}")]
    BadBasemap {
        /// The address.
        address: String,
        /// What is wrong.
        rule: String,
    },

    /// V627. A request without a token that a page of another machine may have sent. Cause: the service has no tokens, so it
    /// trusts this machine alone, and the request names another host or comes from a page of one. Fix: ask for
    /// `http://127.0.0.1:8080`, or make a token, after which nothing else counts.
    #[error("the service has no tokens, and the request {what} {named:?}")]
    ForeignPage {
        /// What the request does.
        what: &'static str,
        /// The host or the origin.
        named: String,
    },

    /// V628. Invalid database address. Cause: `--database` is no address of `PostgreSQL`. Fix: name it as
    /// `postgres://user@host/database`.
    #[error("the address of the database must begin with postgres:// or postgresql://")]
    BadDatabase,

    /// V629. A token with this name is in force. Cause: two tokens with one name could not be told apart in the record of
    /// who did what. Fix: name it otherwise, or revoke the other one.
    #[error("a token with the name {name:?} is in force")]
    NameTaken {
        /// The name.
        name: String,
    },

    /// V630. A policy that days need cannot be deleted. Cause: days that are not archived are decided by it. Fix: archive
    /// them, or leave the policy.
    #[error("policy {name:?} decides on {days} days that are not archived")]
    PolicyInUse {
        /// The policy.
        name: String,
        /// The number of days.
        days: i64,
    },

    /// V621. Another process wrote to the same day at the same time, again and again. Cause: several services share a
    /// database, and many clients write to one day through all of them. Fix: send the request again.
    #[error("another service wrote to the day at the same time")]
    Conflict,

    /// V622. A request that took too long. Cause: its body came too slowly, or the service has too much to do. Fix: send it
    /// again, with the same `Idempotency-Key`.
    #[error("the request took longer than {limit_s} s")]
    TooSlow {
        /// The limit.
        limit_s: u64,
    },
}

impl Error {
    /// A policy that failed, which none of ours does.
    pub(crate) fn of_policy(policy: &str, error: &PolicyError) -> Self {
        Self::Internal { cause: format!("policy {policy:?}: {error}") }
    }

    /// The same error with the day that it is about.
    pub(crate) fn of_day(self, id: &str) -> Self {
        match self {
            Self::BadData { rule } => Self::BadData { rule: format!("day {id}: {rule}") },
            other => other,
        }
    }

    /// An event that could not have happened on a day that begins otherwise.
    pub(crate) fn of_what_if(self) -> Self {
        match self {
            Self::BadData { rule } => Self::Contradiction { rule },
            other => other,
        }
    }

    /// An id that a day does not have.
    pub(crate) fn unknown(what: &'static str, id: &str) -> Self {
        Self::UnknownId { what, id: id.chars().take(64).collect() }
    }

    /// Something that does not exist.
    pub(crate) fn not_found(what: &'static str, id: &str) -> Self {
        Self::NotFound { what, id: id.chars().take(64).collect() }
    }

    /// The status of the answer.
    pub fn status(&self) -> StatusCode {
        match self {
            Self::Core(_) | Self::Study(_) | Self::BadRequest { .. } => StatusCode::BAD_REQUEST,
            Self::InList { cause, .. } => cause.status(),
            Self::NotFound { .. } | Self::NoSuchEvent { .. } | Self::OtherLog { .. } => {
                StatusCode::NOT_FOUND
            }
            Self::UnknownId { .. }
            | Self::ReportError(_)
            | Self::Contradiction { .. }
            | Self::KeyReused { .. } => StatusCode::UNPROCESSABLE_ENTITY,
            Self::Moved { .. } => StatusCode::PRECONDITION_FAILED,
            Self::TooMuch { what, .. } if what.starts_with("bytes") => {
                StatusCode::PAYLOAD_TOO_LARGE
            }
            Self::Store { .. } | Self::StoreHangs { .. } => StatusCode::SERVICE_UNAVAILABLE,
            Self::TooOften { .. } | Self::TooMuch { what: "streams", .. } => {
                StatusCode::TOO_MANY_REQUESTS
            }
            Self::Archived { .. }
            | Self::KeyInUse { .. }
            | Self::Conflict
            | Self::PolicyInUse { .. }
            | Self::NameTaken { .. }
            | Self::TooMuch { .. } => StatusCode::CONFLICT,
            Self::TooSlow { .. } => StatusCode::REQUEST_TIMEOUT,
            Self::NoToken => StatusCode::UNAUTHORIZED,
            Self::NotPermitted { .. } | Self::ForeignPage { .. } => StatusCode::FORBIDDEN,
            Self::NotAllowed { .. } => StatusCode::METHOD_NOT_ALLOWED,
            Self::BadData { .. }
            | Self::ForeignData { .. }
            | Self::Internal { .. }
            | Self::Unprotected { .. }
            | Self::InUse { .. }
            | Self::BadCertificate { .. }
            | Self::BadCollector { .. }
            | Self::BadBasemap { .. }
            | Self::BadDatabase
            | Self::CannotListen { .. }
            | Self::NoAnswer { .. } => StatusCode::INTERNAL_SERVER_ERROR,
        }
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

impl Coded for Error {
    fn code(&self) -> Code {
        Code(match self {
            Self::Core(error) => return error.code(),
            Self::Study(error) => return error.code(),
            Self::InList { cause, .. } => return cause.code(),
            Self::BadRequest { .. } => 601,
            Self::NotFound { .. } | Self::NoSuchEvent { .. } => 602,
            Self::UnknownId { .. } => 603,
            Self::ReportError(_) => 604,
            Self::Moved { .. } => 605,
            Self::Store { .. } | Self::StoreHangs { .. } => 606,
            Self::BadData { .. } | Self::ForeignData { .. } => 607,
            Self::Archived { .. } => 608,
            Self::KeyReused { .. } => 609,
            Self::NoToken => 610,
            Self::CannotListen { .. } => 611,
            Self::TooMuch { .. } => 612,
            Self::NoAnswer { .. } => 613,
            Self::KeyInUse { .. } => 614,
            Self::Internal { .. } => 615,
            Self::NotAllowed { .. } => 616,
            Self::Contradiction { .. } => 617,
            Self::NotPermitted { .. } => 618,
            Self::Unprotected { .. } => 619,
            Self::InUse { .. } => 620,
            Self::Conflict => 621,
            Self::TooSlow { .. } => 622,
            Self::TooOften { .. } => 623,
            Self::BadCertificate { .. } => 624,
            Self::BadCollector { .. } => 625,
            Self::BadBasemap { .. } => 626,
            Self::ForeignPage { .. } => 627,
            Self::BadDatabase => 628,
            Self::NameTaken { .. } => 629,
            Self::PolicyInUse { .. } => 630,
            Self::OtherLog { .. } => 631,
        })
    }

    fn hint(&self) -> Option<&str> {
        match self {
            Self::Core(error) => error.hint(),
            Self::Study(error) => error.hint(),
            Self::InList { cause, .. } => cause.hint(),
            Self::Moved { .. } => Some("read the day again, and decide anew"),
            Self::ReportError(_) => Some("if it is so in reality, report first what led there"),
            Self::NoSuchEvent { .. } | Self::OtherLog { .. } => {
                Some("the day may have been put back from a copy: read its state again")
            }
            Self::NotFound { what: "policy", .. } => Some(
                "GET /v1/policies lists them; PUT /v1/policies/NAME keeps weights under a name",
            ),
            Self::NotFound { what: "network", .. } => {
                Some("GET /v1/networks lists them; PUT /v1/networks/NAME keeps a network file")
            }
            Self::Archived { .. } => Some("POST /v1/days/DAY/unarchive opens it again"),
            Self::KeyReused { .. } => Some("use a new Idempotency-Key for each request"),
            Self::BadData { .. } => Some("`vertifleet serve verify` names what is damaged"),
            Self::ForeignData { .. } => Some(
                "use the program that wrote it or a newer one, or name the right folder or file",
            ),
            Self::NoToken => Some("send it as `Authorization: Bearer vf_...`"),
            Self::ForeignPage { .. } => Some(
                "ask for 127.0.0.1 or localhost, or make a token: `vertifleet serve token make`",
            ),
            Self::Unprotected { .. } => Some(
                "listen on 127.0.0.1, or name a certificate (--certificate, --key) or stand behind a proxy that speaks TLS (--behind-proxy), and make a token",
            ),
            _ => None,
        }
    }

    fn exit(&self) -> Exit {
        match self {
            Self::Core(error) => error.exit(),
            Self::Study(error) => error.exit(),
            Self::Store { .. }
            | Self::StoreHangs { .. }
            | Self::Internal { .. }
            | Self::CannotListen { .. }
            | Self::NoAnswer { .. } => Exit::Failed,
            _ => Exit::Input,
        }
    }
}
