//! The server of a database that other processes may use too. It may hang and keep its connections
//! open; only a time limit detects that.

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use super::Store;
use crate::clock::LastTime;
use crate::error::Error;

/// A server that does not answer within this time hangs.
pub(super) const TIMEOUT: Duration = Duration::from_secs(5);
/// How long the server is not queried after that, so that a request with several queries waits for
/// one of them only.
const PAUSE: Duration = Duration::from_secs(1);

#[derive(Clone)]
pub(super) struct Server {
    /// Its address, which may contain a password.
    pub(super) url: Arc<str>,
    /// When it last failed to answer in time.
    hung: Arc<LastTime>,
}

impl fmt::Debug for Server {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Server")
    }
}

impl Server {
    pub(super) fn at(url: &str) -> Self {
        Self { url: url.into(), hung: Arc::default() }
    }

    async fn in_time<T>(&self, outcome: impl Future<Output = T>) -> Result<T, Error> {
        let hangs = Error::StoreHangs { s: TIMEOUT.as_secs() };
        if self.hung.was_within(PAUSE) {
            return Err(hangs);
        }
        let outcome = tokio::time::timeout(TIMEOUT, outcome).await;
        outcome.map_err(|_| {
            self.hung.is_now();
            hangs
        })
    }
}

impl Store {
    /// The outcome of a query.
    ///
    /// # Errors
    /// Returns [`Error::StoreHangs`] if a server has not answered for [`TIMEOUT`]. It may still
    /// carry the query out.
    pub(super) async fn in_time<T, E>(
        &self,
        outcome: impl Future<Output = Result<T, E>>,
    ) -> Result<T, Error>
    where
        Error: From<E>,
    {
        match &self.server {
            None => Ok(outcome.await?),
            Some(server) => Ok(server.in_time(outcome).await??),
        }
    }
}
