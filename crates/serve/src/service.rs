//! What all requests share: the days, the keys of requests that are being carried out, and the
//! settings.

use std::sync::Arc;

use axum::http::HeaderMap;
use serde::de::DeserializeOwned;
use tokio::sync::{Semaphore, watch};

use crate::access::Access;
use crate::api::Sender;
use crate::days::{Days, Idempotency, Writer};
use crate::error::Error;
use crate::keys::Keys;
use crate::limits::Limits;
use crate::policies::Policies;
use crate::renewals::Renewals;
use crate::spans::Spans;
use crate::store::Store;
use crate::studies::Studies;
use crate::turns::Turns;

/// The longest message about a body that cannot be read.
const LONGEST_RULE: usize = 400;
/// Large bodies that are read at once.
const UPLOADS: usize = 4;
/// The longest key of a request.
const LONGEST_KEY: usize = 128;

/// The running service.
#[derive(Debug)]
pub(crate) struct Service {
    /// Its days.
    pub(crate) days: Days,
    /// The policies that decide.
    pub(crate) policies: Policies,
    /// Who may do what.
    pub(crate) access: Access,
    /// Whether the service is about to stop, so that streams end.
    pub(crate) stopping: watch::Sender<bool>,
    /// What it takes at most.
    pub(crate) limits: Limits,
    /// Turns for large bodies, which take memory while they are read.
    pub(crate) uploads: Semaphore,
    /// Makes the spans of requests, if a collector wants them.
    pub(crate) spans: Option<Arc<Spans>>,
    keys: Arc<Keys>,
    /// What is played in the background.
    pub(crate) studies: Studies,
    /// Turns for computations.
    pub(crate) turns: AllTurns,
    /// Recomputes prices in the background.
    pub(crate) renewals: Arc<Renewals>,
}

/// Turns for computations, of each kind as many as there are cores: more at once would only make
/// all of them late.
#[derive(Debug)]
pub(crate) struct AllTurns {
    /// For outlooks and what-ifs, which take long.
    pub(crate) outlooks: Turns,
    /// For long lists, states of earlier events, and uploads.
    pub(crate) readings: Turns,
    /// For decisions.
    pub(crate) decisions: Turns,
    /// For the first decision of a policy on a day, which searches for prices, so that later ones
    /// do not wait for it.
    pub(crate) first_decisions: Turns,
    /// For the policy that answers when others are late, so that it never waits for them.
    pub(crate) quick_decisions: Turns,
}

/// A write as its headers describe it.
pub(crate) enum Write {
    /// It has been carried out before; this was the answer.
    Done(String),
    /// It is to be carried out.
    New(Writer),
}

impl Service {
    /// A service of the days in a store.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if the store cannot be read.
    pub(crate) async fn new(store: Store, limits: Limits) -> Result<Self, Error> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let turns = || Turns::new(cores);
        let turns = AllTurns {
            outlooks: turns(),
            readings: turns(),
            decisions: turns(),
            first_decisions: turns(),
            quick_decisions: turns(),
        };
        let days = Days::new(store, limits.events, turns.readings.clone());
        let stopping = watch::Sender::new(false);
        let access = Access::new(days.store().clone(), limits.requests_per_s);
        let policies = Policies::new(days.store().clone());
        let used = days.store().keys().await?;
        let keys = Keys::new(used.as_deref());
        let uploads = Semaphore::new(UPLOADS);
        let studies = Studies::default();
        let renewals = Arc::new(Renewals::start());
        Ok(Self {
            days,
            policies,
            access,
            stopping,
            limits,
            uploads,
            spans: None,
            keys,
            studies,
            turns,
            renewals,
        })
    }

    /// Reads the headers of a write: `If-Match`, and `Idempotency-Key` with what was asked for.
    pub(crate) async fn write(&self, sender: &Sender, body: &[u8]) -> Result<Write, Error> {
        let Sender { actor, headers, path } = sender;
        let mut writer = sender.writer()?;
        let Some(key) = text(headers, "idempotency-key")? else {
            return Ok(Write::New(writer));
        };
        if key.is_empty() || key.len() > LONGEST_KEY {
            let rule = format!("Idempotency-Key must have 1 to {LONGEST_KEY} characters");
            return Err(Error::BadRequest { rule });
        }
        // Keys are separate for each token. The length keeps a name from being read as a part of a
        // key.
        let own = format!("{}:{actor}:{key}", actor.len());
        let (busy, may_be_known) = self.keys.take(&own)?;
        let request = sum(path, body);
        if may_be_known && let Some(known) = self.days.store().answer(&own).await? {
            if known.request != request {
                return Err(Error::KeyReused { key: key.to_owned() });
            }
            return Ok(Write::Done(known.answer));
        }
        writer.idempotency = Some(Idempotency { key: own, request });
        writer.busy = Some(Arc::new(busy));
        Ok(Write::New(writer))
    }
}

impl Sender {
    /// The sender of a request as a writer, with `If-Match`.
    pub(crate) fn writer(&self) -> Result<Writer, Error> {
        let if_match = if_match(&self.headers)?;
        Ok(Writer { actor: self.actor.clone(), if_match, idempotency: None, busy: None })
    }
}

fn text<'a>(headers: &'a HeaderMap, name: &str) -> Result<Option<&'a str>, Error> {
    let wrong = |_| Error::BadRequest { rule: format!("the header {name} must be plain text") };
    headers.get(name).map(|value| value.to_str().map_err(wrong)).transpose()
}

/// The number in `If-Match`, with or without quotes.
fn if_match(headers: &HeaderMap) -> Result<Option<u64>, Error> {
    let wrong = |_| Error::BadRequest {
        rule: "If-Match must be the number of an event, as ETag has it".to_owned(),
    };
    text(headers, "if-match")?.map(|text| text.trim_matches('"').parse().map_err(wrong)).transpose()
}

/// A short sum of a request, to tell it from others.
fn sum(path: &str, body: &[u8]) -> String {
    use std::hash::Hasher as _;

    use siphasher::sip128::{Hasher128 as _, SipHasher24};
    let mut hasher = SipHasher24::new();
    hasher.write(path.as_bytes());
    hasher.write_u8(0);
    hasher.write(body);
    let hash = hasher.finish128();
    format!("{:016x}{:016x}", hash.h1, hash.h2)
}

/// What is wrong with JSON, without the words of the language that this is written in.
pub(crate) fn in_words_of_json(message: &str) -> String {
    let mut text = message.replace(" field ", " member ");
    for (name, most) in
        [("u16", u64::from(u16::MAX)), ("u32", u64::from(u32::MAX)), ("u64", u64::MAX)]
    {
        text = text.replace(
            &format!("expected {name}"),
            &format!("expected a whole number from 0 to {most}"),
        );
    }
    // The name of a type, and how many members it has.
    if let Some((before, after)) = text.split_once("expected struct ") {
        let rest = after.split_once(" at ").map_or("", |(_, place)| place);
        let place = if rest.is_empty() { String::new() } else { format!(" at {rest}") };
        text = format!("{before}expected an object{place}");
    }
    text
}

/// Reads the JSON of a request. No body at all is the empty object.
pub(crate) fn parse<T: DeserializeOwned>(body: &[u8]) -> Result<T, Error> {
    let body = if body.is_empty() { b"{}".as_slice() } else { body };
    serde_json::from_slice(body).map_err(|error| {
        // A message may quote what was sent, which may be long.
        let text = in_words_of_json(&error.to_string());
        let mut rule: String = text.chars().take(LONGEST_RULE).collect();
        if rule.len() < text.len() {
            rule.push_str("...");
        }
        Error::BadRequest { rule }
    })
}
