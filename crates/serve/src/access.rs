//! Access control: bearer tokens with roles. Until the first token is made, every program on this
//! machine may do everything, and the service listens on this machine alone.

mod own_pages;

use std::num::NonZeroU32;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use axum::http::{HeaderMap, header};
use governor::clock::DefaultClock;
use governor::state::keyed::HashMapStateStore;
use governor::{Quota, RateLimiter};

use crate::error::Error;
use crate::store::Store;
use crate::tokens::{Role, StoredToken, matching};

/// Longest time after which a revoked token is refused, if the store answers.
const FRESH: Duration = Duration::from_secs(2);
/// How long known tokens stay valid while the store does not answer.
const STALE: Duration = Duration::from_mins(1);
const TWO: NonZeroU32 = NonZeroU32::new(2).unwrap();
/// The scheme before a token, in upper or lower case (RFC 9110).
const SCHEME: &str = "Bearer ";

/// The sender of a request.
#[derive(Debug, Clone)]
pub(crate) struct Actor {
    /// The name of the token; empty without tokens.
    pub(crate) name: String,
    /// The role of the token; without tokens, everything is permitted.
    pub(crate) role: Role,
}

impl Default for Actor {
    fn default() -> Self {
        Self { name: String::new(), role: Role::Admin }
    }
}

/// Tokens as they were last read.
#[derive(Debug, Clone)]
struct Known {
    tokens: Arc<[StoredToken]>,
    read: Instant,
    /// When they were last read from the store.
    asked: Instant,
}

/// Checks the tokens of requests.
#[derive(Debug)]
pub(crate) struct Access {
    store: Store,
    known: Mutex<Option<Known>>,
    /// The rate of requests of each token, by its id; requests without a token share one.
    rates: RateLimiter<String, HashMapStateStore<String>, DefaultClock>,
    most_per_s: u32,
}

impl Access {
    /// Access by the tokens of a store, each with at most `most_per_s` requests a second.
    pub(crate) fn new(store: Store, most_per_s: u32) -> Self {
        let rate = NonZeroU32::new(most_per_s).unwrap_or(NonZeroU32::MIN);
        let quota = Quota::per_second(rate).allow_burst(rate.saturating_mul(TWO));
        Self { store, known: Mutex::new(None), rates: RateLimiter::hashmap(quota), most_per_s }
    }

    /// The tokens, at most [`FRESH`] old; older ones while the store does not answer, but only for
    /// [`STALE`]. One request reads the store, and the others do not wait for it if they have
    /// tokens.
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

    /// Admits a request to a host, or refuses it. A request counts against its token even if it is
    /// refused; if the store is unavailable, the request is attributed to no token.
    pub(crate) async fn admit(
        &self,
        host: &str,
        headers: &HeaderMap,
        needed: Role,
    ) -> Result<Actor, Error> {
        let tokens = self.tokens().await?;
        // Revoking the last token does not make the service public again.
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
        Ok(Actor { name: token.name.clone(), role: token.role })
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

/// The valid token of a request.
fn sent<'a>(tokens: &'a [StoredToken], headers: &HeaderMap) -> Option<&'a StoredToken> {
    let given = headers.get(header::AUTHORIZATION)?.to_str().ok()?;
    let (scheme, token) = given.split_at_checked(SCHEME.len())?;
    scheme.eq_ignore_ascii_case(SCHEME).then(|| matching(tokens, token)).flatten()
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use axum::http::HeaderMap;

    use super::{Access, Known};
    use crate::error::Error;
    use crate::store::{Location, Store};
    use crate::tokens::{Role, StoredToken};

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
        let (token, _) = StoredToken::draw("console", Role::Dispatch, 1).expect("random numbers");
        let now = Instant::now();
        *access.known() = Some(Known { tokens: [token].into(), read: now, asked: now });
        let refused = ask().await;
        assert!(matches!(refused, Err(Error::NoToken)), "{refused:?}");
    }
}
