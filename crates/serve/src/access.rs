//! Who may do what: bearer tokens with roles. As long as no token has been made, every program on
//! this machine may do everything, and the service listens on this machine alone.

mod own_pages;

use std::num::NonZeroU32;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use axum::extract::{Request, State};
use axum::http::{HeaderMap, Method, header};
use axum::middleware::Next;
use axum::response::Response;
use governor::clock::DefaultClock;
use governor::state::keyed::HashMapStateStore;
use governor::{Quota, RateLimiter};
use serde::Serialize;
use sha2::{Digest as _, Sha256};
use subtle::ConstantTimeEq as _;
use utoipa::ToSchema;

use crate::clock::now_ms;
use crate::console;
use crate::error::Error;
use crate::service::Service;
use crate::store::{Location, Store};

/// A token that is revoked is refused after this time at the latest, if the store answers.
const FRESH: Duration = Duration::from_secs(2);
/// While the store does not answer, tokens that are known hold for so long.
const STALE: Duration = Duration::from_mins(1);
const TWO: NonZeroU32 = NonZeroU32::new(2).unwrap();
/// Every token begins like this, so that secret scanners recognise it.
const PREFIX: &str = "vf_";
/// What stands before a token, in large or small letters (RFC 9110).
const SCHEME: &str = "Bearer ";

/// What a token permits. Each role permits what those before it do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// To read days, and to ask for proposals, outlooks and what-if.
    Read,
    /// To report events and to take decisions, and to make days and studies.
    Dispatch,
    /// To archive days, open them again and delete them, and to upload networks and policies.
    Admin,
}

impl Role {
    /// All roles.
    pub const ALL: [Self; 3] = [Self::Read, Self::Dispatch, Self::Admin];

    /// The role's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Dispatch => "dispatch",
            Self::Admin => "admin",
        }
    }

    /// The role with a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|role| role.name() == name)
    }

    /// The role that a request needs.
    fn needed(method: &Method, path: &str) -> Self {
        match *method {
            Method::GET | Method::HEAD | Method::OPTIONS => Self::Read,
            Method::POST if path.ends_with("/what-if") || path.ends_with("/validate") => Self::Read,
            Method::POST if !["/archive", "/unarchive"].iter().any(|end| path.ends_with(end)) => {
                Self::Dispatch
            }
            // A role that may begin a study may end it.
            Method::DELETE if path.starts_with("/v1/studies/") => Self::Dispatch,
            _ => Self::Admin,
        }
    }
}

/// A token as it is stored. Its secret is not.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct StoredToken {
    /// Its id, which is the first part of the token.
    pub id: String,
    /// What it is called in the record of who did what.
    pub name: String,
    /// What it permits.
    pub role: Role,
    /// SHA-256 of its secret, in hexadecimal digits.
    #[serde(skip)]
    pub hash: String,
    /// When it was made, milliseconds of the Unix clock.
    pub created_ms: i64,
    /// When it was revoked; 0 if it is in force.
    pub revoked_ms: i64,
}

/// The sender of a request, by the name of the token; empty without tokens.
#[derive(Debug, Clone, Default)]
pub(crate) struct Actor(pub(crate) String);

/// Tokens as they were read.
#[derive(Debug, Clone)]
struct Known {
    tokens: Arc<[StoredToken]>,
    read: Instant,
    /// When the store was last asked for them.
    asked: Instant,
}

/// Knows the tokens.
#[derive(Debug)]
pub(crate) struct Access {
    store: Store,
    known: Mutex<Option<Known>>,
    /// How often each token may ask, by its id; requests without a token share one count.
    rates: RateLimiter<String, HashMapStateStore<String>, DefaultClock>,
    most_per_s: u32,
}

impl Access {
    /// Access by the tokens of a store, each of which may ask so often in a second.
    pub(crate) fn new(store: Store, most_per_s: u32) -> Self {
        let rate = NonZeroU32::new(most_per_s).unwrap_or(NonZeroU32::MIN);
        let quota = Quota::per_second(rate).allow_burst(rate.saturating_mul(TWO));
        Self { store, known: Mutex::new(None), rates: RateLimiter::hashmap(quota), most_per_s }
    }

    /// The tokens, at most [`FRESH`] old; older ones while the store does not answer, but not much older. One request asks
    /// the store, and the others do not wait for it if they know any.
    async fn tokens(&self) -> Result<Arc<[StoredToken]>, Error> {
        let known = self.known().clone();
        let age = known.as_ref().map(|known| known.read.elapsed());
        let is_turn = known.as_ref().is_none_or(|known| known.asked.elapsed() >= FRESH);
        if let (Some(known), false) = (&known, is_turn)
            && age.is_some_and(|age| age < STALE)
        {
            return Ok(Arc::clone(&known.tokens));
        }
        if let Some(known) = &mut *self.known() {
            known.asked = Instant::now();
        }
        let now = Instant::now();
        match (self.store.tokens().await, known) {
            (Ok(tokens), _) => {
                let tokens: Arc<[StoredToken]> = tokens.into();
                *self.known() = Some(Known { tokens: Arc::clone(&tokens), read: now, asked: now });
                Ok(tokens)
            }
            (Err(_), Some(known)) if known.read.elapsed() < STALE => Ok(known.tokens),
            (Err(error), _) => Err(error),
        }
    }

    fn known(&self) -> MutexGuard<'_, Option<Known>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether requests need a token.
    pub(crate) async fn is_guarded(&self) -> Result<bool, Error> {
        Ok(self.tokens().await?.iter().any(|token| token.revoked_ms == 0))
    }

    /// Lets a request to a host in, or refuses it. A request counts against its token, also if it is refused; if the store is
    /// unavailable, it is attributed to no token.
    async fn admit(&self, host: &str, headers: &HeaderMap, needed: Role) -> Result<Actor, Error> {
        let tokens = self.tokens().await?;
        // Once there has been a token, revoking the last one does not open the service to all.
        if tokens.is_empty() {
            own_pages::check(host, headers)?;
            return Ok(Actor::default());
        }
        let token = sent(&tokens, headers);
        let no_token = ("", "those who have no token");
        let (id, who) = token.map_or(no_token, |token| (&token.id, &token.name));
        if self.rates.check_key(&id.to_owned()).is_err() {
            return Err(Error::TooOften { who: who.to_owned(), most: self.most_per_s });
        }
        let token = token.ok_or(Error::NoToken)?;
        token.check(needed)?;
        Ok(Actor(token.name.clone()))
    }

    /// The token of a request that permits it; `None` if no token has ever been made.
    ///
    /// # Errors
    /// Returns [`Error::NoToken`] or [`Error::NotPermitted`].
    pub(crate) async fn may(
        &self,
        headers: &HeaderMap,
        needed: Role,
    ) -> Result<Option<StoredToken>, Error> {
        let tokens = self.tokens().await?;
        if tokens.is_empty() {
            return Ok(None);
        }
        let token = sent(&tokens, headers).ok_or(Error::NoToken)?;
        token.check(needed)?;
        Ok(Some(token.clone()))
    }
}

impl StoredToken {
    /// Checks that it permits what needs a role.
    fn check(&self, needed: Role) -> Result<(), Error> {
        if self.role < needed {
            return Err(Error::NotPermitted { role: self.role.name(), needed: needed.name() });
        }
        Ok(())
    }
}

/// The token in force that a request came with.
fn sent<'a>(tokens: &'a [StoredToken], headers: &HeaderMap) -> Option<&'a StoredToken> {
    let given = headers.get(header::AUTHORIZATION)?.to_str().ok()?;
    matching(
        tokens,
        given
            .split_at_checked(SCHEME.len())
            .filter(|(scheme, _)| scheme.eq_ignore_ascii_case(SCHEME))?
            .1,
    )
}

/// The token in force that a text is.
fn matching<'a>(tokens: &'a [StoredToken], given: &str) -> Option<&'a StoredToken> {
    let (id, secret) = given.strip_prefix(PREFIX)?.split_once('_')?;
    let token = tokens.iter().find(|token| token.id == id && token.revoked_ms == 0)?;
    let is_it: bool = hash(secret).as_bytes().ct_eq(token.hash.as_bytes()).into();
    is_it.then_some(token)
}

/// Lets requests in that may be carried out. Signs of life need no token.
pub(crate) async fn admit(
    State(service): State<Arc<Service>>,
    mut request: Request,
    next: Next,
) -> Result<Response, Error> {
    if request.headers().get_all(header::HOST).iter().nth(1).is_some() {
        return Err(Error::BadRequest { rule: "it has more than one Host header".to_owned() });
    }
    let path = request.uri().path();
    if !matches!(path, "/healthz" | "/readyz") && !console::is_open(path) {
        let needed = Role::needed(request.method(), path);
        // HTTP/2 has the host in the address of the request.
        let named = request.uri().host().map(str::to_owned);
        let told = || request.headers().get(header::HOST)?.to_str().ok().map(str::to_owned);
        let host = named.or_else(told).unwrap_or_default();
        let actor = service.access.admit(&host, request.headers(), needed).await?;
        request.extensions_mut().insert(actor);
    }
    Ok(next.run(request).await)
}

fn hash(secret: &str) -> String {
    hexadecimal(&Sha256::digest(secret.as_bytes()))
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

fn random_digits(bytes: usize) -> Result<String, Error> {
    let mut random = vec![0; bytes];
    let failed = |error: getrandom::Error| Error::Internal { cause: error.to_string() };
    getrandom::fill(&mut random).map_err(failed)?;
    Ok(hexadecimal(&random))
}

/// Makes, lists and revokes tokens, beside a running service or without one.
#[derive(Debug)]
pub struct Tokens {
    runtime: tokio::runtime::Runtime,
    store: Store,
}

impl Drop for Tokens {
    fn drop(&mut self) {
        self.runtime.block_on(self.store.close());
    }
}

impl Tokens {
    /// Opens the store of a service, and makes one if there is none.
    ///
    /// # Errors
    /// Returns [`Error::Store`] or [`Error::BadData`] if it cannot be opened.
    pub fn open(location: &Location) -> Result<Self, Error> {
        Self::of(async || Store::open(location).await)
    }

    /// Opens the store of a service, which must be there.
    ///
    /// # Errors
    /// Returns [`Error::Store`] or [`Error::BadData`] if it is not there or cannot be opened.
    pub fn open_existing(location: &Location) -> Result<Self, Error> {
        Self::of(async || Store::open_existing(location).await)
    }

    fn of(open: impl AsyncFnOnce() -> Result<Store, Error>) -> Result<Self, Error> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        let runtime = runtime.map_err(|cause| Error::Internal { cause: cause.to_string() })?;
        let store = runtime.block_on(open())?;
        Ok(Self { runtime, store })
    }

    /// Makes a token and returns its text, which cannot be had again.
    ///
    /// # Errors
    /// Returns [`Error::NameTaken`] if another one with this name is in force, and [`Error::Store`] if it cannot be stored.
    pub fn make(&self, name: &str, role: Role) -> Result<String, Error> {
        let (id, secret) = (random_digits(4)?, random_digits(32)?);
        let token = StoredToken {
            id: id.clone(),
            name: name.to_owned(),
            role,
            hash: hash(&secret),
            created_ms: now_ms(),
            revoked_ms: 0,
        };
        let refused = |error| match error {
            Error::Conflict => Error::NameTaken { name: name.to_owned() },
            other => other,
        };
        self.runtime.block_on(async {
            self.store.add_token(&token).await.map_err(refused)?;
            self.store.record("", "token made", &token.id, token.created_ms).await
        })?;
        Ok(format!("{PREFIX}{id}_{secret}"))
    }

    /// All tokens.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if they cannot be read.
    pub fn list(&self) -> Result<Vec<StoredToken>, Error> {
        self.runtime.block_on(self.store.tokens())
    }

    /// Revokes a token.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`] if there is no such token in force, and [`Error::Store`].
    pub fn revoke(&self, id: &str) -> Result<(), Error> {
        self.runtime.block_on(async {
            if !self.store.revoke_token(id, now_ms()).await? {
                return Err(Error::not_found("token in force with the id", id));
            }
            self.store.record("", "token revoked", id, now_ms()).await
        })
    }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use axum::http::HeaderMap;

    use super::{Access, Known, Role, StoredToken, hash, matching};
    use crate::error::Error;
    use crate::store::{Location, Store};

    fn token(revoked_ms: i64) -> StoredToken {
        StoredToken {
            id: "1f".to_owned(),
            name: "console".to_owned(),
            role: Role::Dispatch,
            hash: hash("secret"),
            created_ms: 1,
            revoked_ms,
        }
    }

    #[tokio::test]
    async fn requests_that_cannot_be_checked_are_not_counted() {
        let folder = tempfile::tempdir().expect("a folder");
        let location = Location::Folder(folder.path().to_owned());
        let store = Store::open(&location).await.expect("a store");
        store.close().await;
        let access = Access::new(store, 1);
        let ask =
            async || access.admit("localhost", &HeaderMap::new(), Role::Read).await.map(|_| ());
        for _ in 0..20 {
            let refused = ask().await;
            assert!(matches!(refused, Err(Error::Store { .. })), "{refused:?}");
        }
        let now = Instant::now();
        *access.known() = Some(Known { tokens: [token(0)].into(), read: now, asked: now });
        let refused = ask().await;
        assert!(matches!(refused, Err(Error::NoToken)), "{refused:?}");
    }

    #[test]
    fn a_token_matches_by_its_whole_secret_and_only_while_it_is_in_force() {
        let (good, revoked) = ([token(0)], [token(5)]);
        assert_eq!(matching(&good, "vf_1f_secret"), Some(&good[0]));
        for wrong in ["vf_1f_secre", "vf_1f_secret2", "vf_1e_secret", "1f_secret", "vf_1f", ""] {
            assert_eq!(matching(&good, wrong), None, "{wrong:?}");
        }
        assert_eq!(matching(&revoked, "vf_1f_secret"), None);
    }
}
