//! The keys of requests: those in progress, and those that may have been used.
//!
//! A request with an unused key must not wait for the store. So all used keys are kept in memory,
//! as hashes, up to a limit. Beyond it, and for a key that may have been used, the service queries
//! the store.

use std::collections::HashSet;
use std::hash::{BuildHasher as _, RandomState};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::Serialize;

use crate::error::Error;
use crate::store::StoredAnswer;

/// Largest number of hashes in memory; they take about 50 MB.
const MOST: usize = 4_000_000;

/// The keys of a service.
#[derive(Debug)]
pub(crate) struct Keys {
    hasher: RandomState,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    /// Keys of requests in progress.
    busy: HashSet<String>,
    /// Hashes of all keys that were ever used; `None` if they are unknown.
    used: Option<HashSet<u64>>,
}

/// Reserves a key while its request is carried out.
#[derive(Debug)]
pub(crate) struct Busy {
    keys: Arc<Keys>,
    key: String,
}

/// A request that is carried out once, even if it arrives repeatedly.
#[derive(Debug, Clone)]
pub(crate) struct Idempotency {
    /// The key.
    pub(crate) key: String,
    /// The checksum of the request.
    pub(crate) request: String,
}

impl Idempotency {
    /// The answer to store with the key.
    pub(crate) fn answered_with(self, answer: &impl Serialize) -> StoredAnswer {
        let answer = serde_json::to_string(answer).expect("plain data can be written");
        StoredAnswer { key: self.key, request: self.request, answer }
    }
}

impl Drop for Busy {
    fn drop(&mut self) {
        self.keys.state().busy.remove(&self.key);
    }
}

impl Keys {
    /// Keys of which these have been used; `None` if others may have been used too.
    pub(crate) fn new(used: Option<&[String]>) -> Arc<Self> {
        let hasher = RandomState::new();
        let used = used.map(|keys| keys.iter().map(|key| hasher.hash_one(key)).collect());
        Arc::new(Self { hasher, state: Mutex::new(State { busy: HashSet::new(), used }) })
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reserves a key for a request. Returns whether it may have been used before.
    ///
    /// # Errors
    /// Returns [`Error::KeyInUse`] if a request with this key is being carried out.
    pub(crate) fn take(self: &Arc<Self>, key: &str) -> Result<(Busy, bool), Error> {
        let mut state = self.state();
        if !state.busy.insert(key.to_owned()) {
            return Err(Error::KeyInUse { key: key.to_owned() });
        }
        let busy = Busy { keys: Arc::clone(self), key: key.to_owned() };
        let Some(used) = &mut state.used else { return Ok((busy, true)) };
        let is_new = used.insert(self.hasher.hash_one(key));
        if used.len() > MOST {
            state.used = None;
        }
        Ok((busy, !is_new))
    }
}

#[cfg(test)]
mod tests {
    use super::Keys;

    #[test]
    fn a_key_is_held_by_one_request_at_a_time_and_known_afterwards() {
        let keys = Keys::new(Some(&["old".to_owned()]));
        let (busy, may_be_known) = keys.take("new").expect("it is free");
        assert!(!may_be_known);
        assert!(keys.take("new").is_err(), "it is being carried out");
        drop(busy);
        assert!(keys.take("new").expect("it is free").1);
        assert!(keys.take("old").expect("it is free").1);
        assert!(Keys::new(None).take("any").expect("it is free").1, "nothing is known");
    }
}
