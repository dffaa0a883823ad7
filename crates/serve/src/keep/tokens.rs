//! Makes, lists and revokes tokens on the machine of a service.

use crate::clock::now_ms;
use crate::error::Error;
use crate::names::is_printed;
use crate::store::{Location, Store};
use crate::tokens::{Role, StoredToken};

/// Makes, lists and revokes tokens, while a service runs or not.
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
    /// Opens the store of a service, and creates it if it does not exist.
    ///
    /// # Errors
    /// Returns [`Error::Store`] or [`Error::BadData`] if it cannot be opened.
    pub fn open(location: &Location) -> Result<Self, Error> {
        Self::of(async || Store::open(location).await)
    }

    /// Opens the store of a service, which must exist.
    ///
    /// # Errors
    /// Returns [`Error::Store`] or [`Error::BadData`] if it does not exist or cannot be opened.
    pub fn open_existing(location: &Location) -> Result<Self, Error> {
        Self::of(async || Store::open_existing(location).await)
    }

    fn of(open: impl AsyncFnOnce() -> Result<Store, Error>) -> Result<Self, Error> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        let runtime = runtime.map_err(|cause| Error::Internal { cause: cause.to_string() })?;
        let store = runtime.block_on(open())?;
        Ok(Self { runtime, store })
    }

    /// Makes a token and returns its text, which cannot be shown again.
    ///
    /// # Errors
    /// Returns [`Error::NameTaken`] if another one has or had this name, [`Error::BadRequest`] if
    /// the name has characters that are not printed, and [`Error::Store`] if it cannot be stored.
    pub fn make(&self, name: &str, role: Role) -> Result<String, Error> {
        if name.trim().is_empty() || !is_printed(name) {
            return Err(Error::BadRequest {
                rule: format!("the name of a token has only printed characters, not {name:?}"),
            });
        }
        let (token, text) = StoredToken::draw(name, role, now_ms())?;
        let refused = |error| match error {
            Error::Conflict => Error::NameTaken { name: name.to_owned() },
            other => other,
        };
        self.runtime.block_on(async {
            self.store.add_token(&token).await.map_err(refused)?;
            self.store.record("", "token made", &token.id, token.created_ms).await
        })?;
        Ok(text)
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
